"""The curves of a question: variants of the kernel, programs of anybody's, Google Benchmarks."""

import glob
import os
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from typing import Any

from experiments.plan.benchmark_cases import cases
from support.errors import InputError, quoted

SECONDS_OF_UNIT = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}

WORDS = ("command", "trajectory", "prepare", "conclude", "writes")
"""The keys of a series whose words have placeholders."""


@dataclass(frozen=True)
class PrintedTime:
    """Where a program's standard output says how long it took: a regular expression with one group."""

    stdout: str
    unit: str | None = "s"
    """Of a number that has none behind it; without one that is an error."""


@dataclass(frozen=True)
class Benchmark:
    """A case of a Google Benchmark; with a `filter` instead of a `name` each case that matches it."""

    program: str
    name: str | None = None
    filter: str | None = None


@dataclass(frozen=True)
class Series:
    """One curve: what runs, fixed chunks of a variant, and the swept values at both scales.

    It is a `variant` of a build of the program, or else a `command`, words with placeholders. `trajectory` is
    a command, too, whose output is checked; `time` says where the program prints its own time.
    """

    name: str
    variant: str | None = None
    program: str = "gcc"
    command: tuple[str, ...] = ()
    trajectory: tuple[str, ...] = ()
    prepare: tuple[str, ...] = ()
    conclude: tuple[str, ...] = ()
    """Commands that are run, untimed, before and after each run."""
    writes: tuple[str, ...] = ()
    """The files among its words that it writes."""
    fresh_folder: bool = False
    """Each run has a new folder to itself."""
    exit_codes: tuple[int, ...] = ()
    """Those that are fine; without any it is 0."""
    turns: bool | None = None
    """Whether it is stopped while others run; without a word it is found out."""
    time: PrintedTime | None = None
    benchmark: Benchmark | None = None
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
    time = PrintedTime(**table.pop("time")) if "time" in table else None
    benchmark = Benchmark(**table.pop("benchmark")) if "benchmark" in table else None
    codes = tuple(sorted(table.pop("exit_codes", [0])))
    fine = () if codes == (0,) else codes
    series = Series(**{"name": "", **table, **words}, time=time, benchmark=benchmark, exit_codes=fine)
    if time is not None:
        require_one_group(f"{key}.time.stdout", time.stdout)
        if series.turns:
            told = "found true for a program that times itself, which would count its pauses; expected false"
            raise InputError(f"{key}.turns: {told}")
    if pattern is not None:
        yield from _of_pattern(path, key, series, pattern)
    elif benchmark is not None:
        yield from _of_benchmark(path, key, series, benchmark)
    else:
        yield series


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


def _of_benchmark(path: Path, key: str, series: Series, benchmark: Benchmark) -> Iterator[Series]:
    """The one that is named, or one for each that the program lists."""
    if (benchmark.name is None) == (benchmark.filter is None):
        raise InputError(f"{key}.benchmark: expected either name or filter")
    series = replace(series, command=(benchmark.program,))
    if benchmark.filter is None:
        yield series
        return
    for name in cases([os.fspath(path.parent / benchmark.program)], benchmark.filter, f"{key}.benchmark"):
        # What is listed has no placeholders.
        own = replace(benchmark, name=literal(name))
        yield replace(series, name=series.name or _shown(name), benchmark=own)
