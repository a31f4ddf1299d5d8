"""What the command line of `carom compare` asks for."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from experiments.compare import values
from experiments.compare.benchmarks import call_of, common_cases, quick
from experiments.compare.commands import NEXT, Compared, commands_of, reference_of, split_off
from experiments.compare.sweeps import LIST, RANGE, fill, named_in, require_filled
from experiments.plan.series import SECONDS_OF_UNIT, require_one_group
from experiments.run.progress import warn
from support.command_line import Once, Parser
from support.errors import InputError

EXPORTS = ("json", "csv", "markdown", "html")
"""The formats of files."""

LEAST_TIMEOUT = 60.0
"""Seconds that a run may take, whatever time there is for all of them."""


@dataclass(frozen=True)
class Asked:
    """Everything that is asked for. Times are in seconds, the margin and the error are fractions."""

    commands: tuple[Compared, ...]
    reference: str
    margin: float = 0.02
    error: float = 0.05
    seconds: float = 60.0
    most_seconds: float = 300.0
    """For one run of a command; what takes longer is stopped, and has failed."""
    warm_up: int = 0
    exit_codes: tuple[int, ...] = (0,)
    unit: str | None = None
    """Of printed times that have none."""
    turns: bool | None = None
    slice_seconds: float | None = None
    """How long one runs before the next does; the program's own rule without it."""
    rounds: tuple[int, ...] = ()
    """How often each command runs in a block, by itself, where one of them is short; else once, in turns."""
    threads: int | None = None
    fixed_layout: bool = False
    cases: tuple[str, ...] = ()
    """Of Google Benchmarks: what all of them have; empty where whole commands are run."""
    one_sided: bool = False
    """Whether all that is asked is that nothing is slower by more than the margin."""
    many: int = 1
    """Of so many calls together a slower one may be called slower wrongly in no more than the error."""
    is_whole: bool = False
    """Whether somebody says that whole programs are meant, whatever is in them."""
    setup: tuple[str, ...] = ()
    cleanup: tuple[str, ...] = ()
    exports: dict[str, Path] = field(default_factory=dict)
    """The files to write, by format."""
    earlier: Path | None = None
    """A file of what earlier calls measured, which is gone on with."""
    quiet: bool = False

    @property
    def has_printed_times(self) -> bool:
        """Whether the time of a command is one that it prints."""
        return any(one.time_from for one in self.commands)


def parse(arguments: Sequence[str]) -> Asked:
    """Read the words behind `carom compare`. Raises InputError, or leaves like any parser."""
    own, words = split_off(arguments)
    options = read(_parser(), own)
    commands = commands_of(options, words)
    asked = asked_of(options, commands, reference_of(options.reference, [one.name for one in commands]))
    return replace(with_cases(asked, options), earlier=options.append)


def read(parser: argparse.ArgumentParser, words: Sequence[str]) -> argparse.Namespace:
    """What the words say. What is none of them is told by itself, and leaves like any parser."""
    options, others = parser.parse_known_intermixed_args(words)
    for one in sorted(others, key=lambda one: not one.startswith("-")):
        is_word = one == NEXT or not one.startswith("-")
        parser.error(f"found {one}, expected `--` before it" if is_word else f"unrecognized arguments: {one}")
    return options


def with_cases(asked: Asked, options: argparse.Namespace) -> Asked:
    """With the cases to compare, if the commands are Google Benchmarks and nobody says that they are none.
    Raises InputError.
    """
    is_asked = options.gb is True or options.filter is not None
    if options.gb is False or (options.time_from and not is_asked):
        return replace(asked, is_whole=True)
    if not is_asked and any(call_of(one) is None for one in asked.commands):
        return asked
    if not is_asked:
        warn("carom: these are Google Benchmarks: their cases are compared (`--no-gb`: whole programs)")
    cases = common_cases(asked.commands, options.filter)
    return replace(asked, commands=quick(asked, len(cases)), cases=cases)


def asked_of(options: argparse.Namespace, commands: tuple[Compared, ...], reference: str) -> Asked:
    """What the options of `add_measuring` ask for, of these commands. Raises InputError for two that exclude
    each other.
    """
    turns, slice_seconds = options.turns
    if options.time_from and turns:
        told = "of commands that time themselves, which would count their pauses"
        raise InputError(f"--turns: found turns, {told}; expected off or auto")
    if options.unit and not options.time_from:
        raise InputError("--unit: found without a time that is printed, expected --time-from beside it")
    for one in commands:
        if one.time_from is not None:
            require_one_group("--time-from", one.time_from)
    exports = {kind: places[0] for kind in EXPORTS if (places := _places(options, kind))}
    has_lists = getattr(options, "list", []) or getattr(options, "range", [])
    for option, file in {**exports, "append": getattr(options, "append", None)}.items():
        if has_lists and file is not None and named_in([str(file)]):
            raise InputError(f"{_option(option)}: found {file}, expected one file for all commands")
    setup, cleanup = (_once(getattr(options, what), commands, f"--{what}") for what in ("setup", "cleanup"))
    same: dict[str, Any] = {
        one.name: getattr(options, one.name) for one in fields(Asked) if hasattr(options, one.name)
    }
    same.update(commands=commands, reference=reference, setup=setup, cleanup=cleanup)
    same.update(turns=turns, slice_seconds=slice_seconds)
    return Asked(
        **same,
        most_seconds=options.timeout or max(LEAST_TIMEOUT, 5 * options.seconds),
        exit_codes=tuple(sorted({0, *options.ignore_exit})),
        exports=exports,
    )


def _places(options: argparse.Namespace, kind: str) -> list[Path]:
    """The file that is to hold the result as that kind, if one is. Raises InputError for a second one."""
    files: list[Path] = getattr(options, f"export_{kind}")
    if len(files) > 1:
        raise InputError(f"{_option(kind)}: found {files[0]} and {files[1]}, expected one file")
    return files


def _option(kind: str) -> str:
    """How a file is asked for: as the parser's own messages name options of two names."""
    return {"append": "--append", "html": "--export-html/--html"}.get(kind, f"--export-{kind}")


def _once(line: str | None, commands: Sequence[Compared], what: str) -> tuple[str, ...]:
    """The lines that a line is with the values of all commands."""
    if line is None:
        return ()
    lines = tuple(dict.fromkeys(fill(line, dict(one.levels)) for one in commands))
    for one in lines:
        require_filled(what, one)
    return lines


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="carom compare",
        usage="carom compare [OPTIONS] 'COMMAND' 'COMMAND' ...\n"
        "       carom compare [OPTIONS] -- WORDS --vs WORDS ...",
        description="Run commands in turns until it is settled which is faster, and say so with an interval.",
        epilog="Exit codes: 0 measured, whatever came out; 1 wrong usage; 2 a command failed; 5 the first "
        "command differs from itself, so that nothing is certain.",
    )
    parser.register("action", None, Once)
    add = parser.add_argument
    told = "a command line; a shell runs it only if it has more than plain words"
    add("lines", nargs="*", metavar="COMMAND", help=told)
    told = "name of a command; given once for each, in their order"
    add("-n", "--name", action="append", default=[], metavar="NAME", help=told)
    add("--reference", metavar="NAME", help="what the others are compared with (default: the first)")
    told = "a command line that runs before each run, untimed; given once for all commands, or once for each"
    add("--prepare", action="append", default=[], metavar="COMMAND", help=told)
    add("--conclude", action="append", default=[], metavar="COMMAND", help="the same after each run")
    add("--input", type=Path, metavar="FILE", help="standard input of each run (default: nothing)")
    told = "a variable for all commands, or for the one that is called NAME"
    add("--env", action="append", default=[], metavar="[NAME:]VARIABLE=VALUE", help=told)
    told = (
        "values for {NAME} wherever it stands: a command for each, or for each combination; `\\,` is a comma"
    )
    add(*LIST, action="append", default=[], metavar="NAME A,B", help=told)
    told = "the same for numbers from FIRST to LAST, a STEP apart (default: 1)"
    add(*RANGE, action="append", default=[], metavar="NAME FIRST LAST [STEP]", help=told)
    told = "go on with what earlier calls measured, and keep all in this file"
    add("--append", type=values.file, metavar="FILE", help=told)
    add_measuring(parser)
    return parser


def add_measuring(parser: argparse.ArgumentParser) -> None:
    """The options of how to measure, whatever is compared."""
    add = parser.add_argument
    add(
        "--margin", type=values.fraction, default=0.02, metavar="2%", help="the least difference that matters"
    )
    add(
        "--error", type=values.fraction, default=0.05, metavar="5%", help="how often any verdict may be wrong"
    )
    add(
        "--time",
        type=values.duration,
        dest="seconds",
        default=60.0,
        metavar="60s",
        help="the longest time to measure; each command runs once, and the reference twice, in any case",
    )
    told = "stop a run that takes longer (default: five times --time, a minute at least)"
    add("--timeout", type=values.duration, metavar="300s", help=told)
    add(
        "--warmup",
        type=values.count,
        dest="warm_up",
        default=0,
        metavar="N",
        help="untimed runs before each timed one",
    )
    add("--setup", metavar="COMMAND", help="a command line for a shell that runs once, before everything")
    add("--cleanup", metavar="COMMAND", help="the same after everything, whatever happened")
    told = "exit codes that are fine beside 0"
    add("--ignore-exit", type=values.codes, default=(), metavar="1,2", help=told)
    told = "a regular expression with one group: the time that a command prints, in the unit that it prints"
    add("--time-from", metavar="REGEX", help=told)
    told = "of printed times that have no unit: ns, us, ms, s, min or h"
    add("--unit", type=values.unit, choices=tuple(SECONDS_OF_UNIT), metavar="UNIT", help=told)
    told = "the commands are Google Benchmarks, whose cases are paired by name (default: it is found out)"
    add("--gb", action=argparse.BooleanOptionalAction, help=told)
    add("--filter", metavar="REGEX", help="the cases whose names match (default: all)")
    told = (
        "length of a turn: one command runs, the others are stopped; off: nothing is stopped; auto: nothing "
        "that a stop makes slower or ends in another way"
    )
    add("--turns", type=values.turns, default=(None, None), metavar="auto|50ms|off", help=told)
    told = "OMP_NUM_THREADS and the binding of a study (default: your own environment)"
    add("--threads", type=values.positive, metavar="N", help=told)
    told = "leave addresses and the size of the environment as they are; else each block varies them"
    add("--fixed-layout", action="store_true", help=told)
    for kind in EXPORTS:
        words, told = [f"--export-{kind}"], f"also write the result as {kind}"
        words += ["--html"] if kind == "html" else []
        add(*words, type=values.file, action="append", default=[], metavar="FILE", help=told)
    add("-q", "--quiet", action="store_true", help="print the result alone")
