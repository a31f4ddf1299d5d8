"""The verbs that the Python packages do, as their parsers tell of them."""

import argparse
import contextlib
import re
from collections.abc import Iterator
from pathlib import Path

from analysis import cli
from docs.generate.markdown import code
from docs.generate.program_help import Row, Verb
from experiments import __main__ as study
from experiments.compare import gate, options
from support.home import ROOT

DEFAULT_IN_HELP = re.compile(r"(?:\s*\(|^)default: (.*?)\)?$")


def verbs() -> dict[str, Verb]:
    """Those that `carom` hands over, by name, without the verbs of `study`."""
    of_analysis = _below(cli._parser())
    called = ("movie", "report", "claims", "figures", "export")
    found = {name: parser for name, parser in of_analysis.items() if name in called}
    parsers = {"compare": options._parser(), "gate": gate._parser(), **found}
    return {name: _verb(name, parser) for name, parser in parsers.items()}


def study_verbs() -> dict[str, Verb]:
    """Those of `carom study`, those too that only batch scripts and `make` call."""
    return {f"study {name}": _verb(f"study {name}", one) for name, one in _below(study._parser()).items()}


def listed_study_verbs() -> list[str]:
    """Those that its help lists."""
    return [f"study {one.dest}" for one in _subparsers(study._parser())._choices_actions]


def _below(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    return dict(_subparsers(parser).choices)


def _subparsers(parser: argparse.ArgumentParser) -> "argparse._SubParsersAction[argparse.ArgumentParser]":
    return next(one for one in parser._actions if isinstance(one, argparse._SubParsersAction))


def _verb(name: str, parser: argparse.ArgumentParser) -> Verb:
    actions = [one for one in parser._actions if one.help != argparse.SUPPRESS and one.dest != "help"]
    words = [_argument(one) for one in actions if not one.option_strings]
    required = [
        f"{one.option_strings[0]} {_value(one)}" for one in actions if one.option_strings and one.required
    ]
    usages = parser.usage or " ".join(["carom", name, *required, "[OPTIONS]", *words])
    ordered = sorted(actions, key=lambda one: bool(one.option_strings))
    rows = tuple(row for one in ordered for row in _rows(one, parser.prog))
    lines = tuple(line.strip() for line in usages.splitlines())
    return Verb(name, parser.description or "", lines, rows, parser.epilog or "")


def _argument(action: argparse.Action) -> str:
    shown = _value(action)
    return {"?": f"[{shown}]", "*": f"[{shown} ...]", "+": f"{shown} ..."}.get(str(action.nargs), shown)


def _value(action: argparse.Action) -> str:
    if action.metavar is not None:
        return " ".join(action.metavar) if isinstance(action.metavar, tuple) else action.metavar
    if action.choices is not None:
        return "|".join(map(str, action.choices))
    return "" if action.nargs == 0 else action.dest.upper()


def _rows(action: argparse.Action, program: str) -> Iterator[Row]:
    shown = action.default if isinstance(action.default, (int, float)) else _plain(action.default)
    told = (action.help or "") % {**vars(action), "prog": program, "default": shown}
    default = code(_default(action))
    if said := DEFAULT_IN_HELP.search(told):
        default = code(said[1]) if said[1] == str(shown) else said[1]
    names = ", ".join(action.option_strings)
    typed = f"{names} {_value(action)}".strip() if names else _value(action)
    yield Row(typed, default, DEFAULT_IN_HELP.sub("", told))


def _default(action: argparse.Action) -> str:
    """What the help does not say itself: as it would be typed, where the option shows its default so."""
    if not isinstance(action.default, (str, int, float, Path)) or isinstance(action.default, bool):
        return ""
    shown = _value(action)
    if callable(action.type):
        with contextlib.suppress(ValueError, argparse.ArgumentTypeError):
            if action.type(shown) == action.default:
                return shown
    return _plain(action.default)


def _plain(value: object) -> str:
    """A default as a page shows it: a path of the checkout below it, a number without a needless end."""
    if isinstance(value, Path) and value.is_absolute():
        return str(value.relative_to(ROOT))
    return f"{value:g}" if isinstance(value, float) else "" if value is None else str(value)
