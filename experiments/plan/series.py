"""The curves of a question: variants of the kernel, programs of anybody's, Google Benchmarks."""

import glob
import os
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import takewhile
from pathlib import Path
from typing import Any

from experiments.plan.benchmark_cases import cases
from support.errors import InputError, quoted

SECONDS_OF_UNIT = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}

WORDS = ("command", "trajectory", "prepare", "conclude", "writes")
"""The keys of a series whose words have placeholders."""


@dataclass(frozen=True, kw_only=True)
class Manner:
    """How a program is run, and how its time is known."""

    pattern: str | None = None
    """Where it prints its time."""
    unit_seconds: float | None = 1.0
    """Of a time that it prints without a unit."""
    benchmark: str | None = None
    """The case of a Google Benchmark."""
    prepare: tuple[str, ...] = ()
    """Words of a command that is run before each of its runs, untimed."""
    conclude: tuple[str, ...] = ()
    """And of one that is run after each."""
    fresh_folder: bool = False
    """Each run has a new and empty folder, which is removed afterwards."""
    exit_codes: tuple[int, ...] = ()
    """Those that are fine; 0 alone where none is said."""
    turns: bool | None = None
    """Whether it is sliced; found out if nobody says so."""
    rounds: int | None = None
    """How often it runs in a block, each time by itself; without a number once, or in turns."""

    @property
    def times_itself(self) -> bool:
        """Whether the time that counts is one that the program says: it must not stand still meanwhile."""
        return self.pattern is not None or self.benchmark is not None

    @property
    def manner(self) -> dict[str, Any]:
        """All this by name, for another one that is run alike."""
        return {one.name: getattr(self, one.name) for one in fields(Manner)}


@dataclass(frozen=True)
class Series(Manner):
    """One curve: what runs, fixed chunks of a variant, and the swept values at both scales.

    It is a `variant` of a build of the program, or else a `command`, words with placeholders, as `prepare`,
    `conclude` and the name of the case of a `benchmark` have them too. `trajectory` is a command as well,
    whose output is checked.
    """

    name: str
    variant: str | None = None
    program: str = "gcc"
    command: tuple[str, ...] = ()
    trajectory: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    """The files among its words that it writes."""
    label: str | None = None
    find_chunk: int | None = None
    resolve_chunk: int | None = None
    optional: bool = False
    paper_only: bool = False
    """Left out at quick scale."""
    apart: bool = False
    """In a process of its own, also where the others of the question take turns."""
    replicated: tuple[float, ...] = ()
    """The values that all others of the question are compared with; a block measures them several times."""
    is_one_of_many: bool = False
    """Found by a pattern: if it cannot be run, that is its own failure and not one of the question."""
    refused: str = ""
    """Why what a pattern found is not run."""
    values: tuple[float, ...] = ()
    quick_values: tuple[float, ...] = ()

    @property
    def is_foreign(self) -> bool:
        """Whether it is somebody else's program."""
        return self.variant is None


def read_series(
    path: Path, tables: Sequence[Mapping[str, Any]], of_sweep: Mapping[str, tuple[float, ...]]
) -> tuple[Series, ...]:
    """The series of a question's file, those of patterns included. Raises InputError with one line."""
    found: list[Series] = []
    for number, table in enumerate(tables, start=1):
        key = f"{path}: series[{number}]"
        _require_kind(key, table)
        found += _of_table(path, key, _with_values(table, of_sweep))
    return tuple(found)


def _with_values(table: Mapping[str, Any], of_sweep: Mapping[str, tuple[float, ...]]) -> dict[str, Any]:
    """A series has the sweep's values unless it has its own; quick values default to the values."""
    values = table if "values" in table else {**of_sweep, **table}
    quick = values.get("quick_values") or values["values"]
    return {
        **table,
        "values": tuple(values["values"]),
        "quick_values": tuple(quick),
        "replicated": tuple(table.get("replicated", ())),
    }


def _require_kind(key: str, table: Mapping[str, Any]) -> None:
    """It is of one kind, and has nothing that only another kind can have."""
    kinds = [kind for kind in _ONLY_FOR if kind in table]
    if len(kinds) != 1:
        found = " and ".join(kinds) or "none of them"
        raise InputError(f"{key}: found {found}, expected one of {', '.join(_ONLY_FOR)}")
    for kind, names in _ONLY_FOR.items():
        wrong = next((name for name in names if name in table and kind not in kinds), None)
        if wrong is not None:
            raise InputError(f"{key}.{wrong}: found for a {kinds[0]}, expected for a {kind} only")
    if "name" not in table and "commands" not in table and "filter" not in table.get("benchmark", {}):
        raise InputError(f"{key}.name: missing; expected a text that is not empty")


_ONLY_FOR = {
    "variant": ("program", "find_chunk", "resolve_chunk", "optional"),
    "command": (
        "trajectory", "time", "commands", "prepare", "conclude", "writes", "fresh_folder", "exit_codes",
        "turns",
    ),
    "benchmark": (),
}  # fmt: skip


def _of_table(path: Path, key: str, table: dict[str, Any]) -> Iterator[Series]:
    _require_no_zero_byte(key, table)
    pattern = table.pop("commands", None)
    words = {name: tuple(table.pop(name, ())) for name in WORDS}
    time, benchmark = table.pop("time", {}), table.pop("benchmark", {})
    manner: dict[str, Any] = {"pattern": time.get("stdout"), "benchmark": benchmark.get("name")}
    if "unit" in time:
        manner["unit_seconds"] = SECONDS_OF_UNIT[time["unit"]]
    if benchmark:
        words["command"] = (benchmark["program"],)
    codes = tuple(sorted(table.pop("exit_codes", ())))
    manner["exit_codes"] = () if codes == (0,) else codes
    series = Series(**{"name": "", **table, **words, **manner})
    _require_possible(key, series, benchmark)
    if pattern is not None:
        yield from _of_pattern(path, key, series, pattern)
    elif "filter" in benchmark:
        program = os.fspath(path.parent / benchmark["program"])
        for name in cases([program], benchmark["filter"], f"{key}.benchmark"):
            # What is listed has no placeholders.
            yield replace(series, name=series.name or _shown(name), benchmark=literal(name))
    else:
        yield series


def _require_possible(key: str, series: Series, benchmark: Mapping[str, Any]) -> None:
    """What its tables of a time and of a benchmark ask of each other and of the rest."""
    if series.pattern is not None:
        require_one_group(f"{key}.time.stdout", series.pattern)
        if series.turns:
            told = "found true for a program that times itself, which would count its pauses; expected false"
            raise InputError(f"{key}.turns: {told}")
    if benchmark and ("name" in benchmark) == ("filter" in benchmark):
        raise InputError(f"{key}.benchmark: expected either name or filter")


def _require_no_zero_byte(key: str, value: object) -> None:
    """No word of a command can have one."""
    match value:
        case str() if "\0" in value:
            raise InputError(f"{key}: found {quoted(value)}, expected a text without a zero byte")
        case dict():
            for name, one in value.items():
                _require_no_zero_byte(f"{key}.{name}", one)
        case list():
            for one in value:
                _require_no_zero_byte(key, one)


def require_one_group(key: str, pattern: str) -> None:
    """Raises InputError, which begins with `key`, for what is no regular expression with one group."""
    try:
        with warnings.catch_warnings(action="error"):
            groups = re.compile(pattern, re.ASCII).groups
    except (re.error, RecursionError, OverflowError, FutureWarning) as error:
        raise InputError(f"{key}: found {quoted(pattern)}, expected a regular expression: {error}") from error
    if groups != 1:
        told = f"with {groups} groups, expected one around the number"
        raise InputError(f"{key}: found {quoted(pattern)} {told}")


def _of_pattern(path: Path, key: str, series: Series, pattern: str) -> Iterator[Series]:
    """One for each file, named by what differs in the paths; {program} and {folder} stand for it. What is no
    file, but no folder either, has its place as well: somebody meant it to be one.
    """
    base = Path("/") if Path(pattern).is_absolute() else path.parent
    # That of a Path leaves links to nothing out.
    found = glob.glob(pattern.lstrip("/"), root_dir=base, recursive=True, include_hidden=True)  # noqa: PTH207
    files = sorted(file for file in (base / one for one in found) if not file.is_dir())
    if not files:
        raise InputError(f'{key}.commands: found "{pattern}", which no file matches')
    names = _differing([file.relative_to(base).parts for file in files])
    for file, name_of in zip(files, names, strict=True):
        there = {"program": os.fspath(file), "folder": os.fspath(file.parent)}
        words = {name: tuple(_placed(word, there) for word in getattr(series, name)) for name in WORDS}
        name = f"{series.name} {_shown(name_of)}" if series.name else _shown(name_of)
        changed: dict[str, Any] = {**words, "name": name, "is_one_of_many": True, "refused": _unfit(file)}
        yield replace(series, **changed)


def _unfit(file: Path) -> str:
    """Why a file that a pattern found is not run; empty if it is."""
    if _shown(os.fspath(file)) != os.fspath(file):
        return "its path is no text in UTF-8 on one line; another name can be measured"
    if not file.exists():
        return "is a link to nothing"
    return "" if file.is_file() else "is no file"


def _shown(name: str) -> str:
    """The name with what is no text in it written out."""
    shown = (one if one.isprintable() else one.encode("unicode_escape").decode("ascii") for one in name)
    return "".join(shown)


def _placed(word: str, values: Mapping[str, str]) -> str:
    """The word with these placeholders filled in, braces in the values kept from being others."""
    for name, value in values.items():
        word = word.replace(f"{{{name}}}", literal(value))
    return word


def literal(text: str) -> str:
    """The text as words of a command have it, where a brace alone begins a placeholder."""
    return text.replace("{", "{{").replace("}", "}}")


def _differing(paths: Sequence[tuple[str, ...]]) -> list[str]:
    """What tells paths apart: each without the parts that all have in common, before and after."""
    if len(paths) == 1:
        return [paths[0][-1]]
    before, after = _common(paths), _common([path[::-1] for path in paths])
    return ["/".join(path[before : len(path) - after]) for path in paths]


def _common(paths: Sequence[tuple[str, ...]]) -> int:
    """How many of their first parts are the same in all."""
    columns = zip(*paths, strict=False)
    return sum(1 for _ in takewhile(lambda parts: len(set(parts)) == 1, columns))
