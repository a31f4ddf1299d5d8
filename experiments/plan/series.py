"""The curves of a question: variants of the kernel, programs of anybody's, Google Benchmarks."""

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from typing import Any

from experiments.plan.pattern import PatternError, groups_of
from experiments.support import process
from experiments.support.errors import InputError, quoted

SECONDS_OF_UNIT = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}

_LIST_SECONDS = 60.0


@dataclass(frozen=True)
class PrintedTime:
    """Where a program's standard output says how long it took: a regular expression with one group."""

    stdout: str
    unit: str = "s"


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
    time: PrintedTime | None = None
    benchmark: Benchmark | None = None
    label: str | None = None
    find_chunk: int | None = None
    resolve_chunk: int | None = None
    optional: bool = False
    apart: bool = False
    """In a process of its own, also where the others of the question take turns."""
    replicated: tuple[float, ...] = ()
    """The values that all others of the question are compared with; a block measures them several times."""
    is_one_of_many: bool = False
    """Found by a pattern: if it cannot be run, that is its own failure and not one of the question."""
    values: tuple[float, ...] = ()
    quick_values: tuple[float, ...] = ()

    @property
    def is_foreign(self) -> bool:
        """Whether it is somebody else's program."""
        return self.variant is None

    @property
    def times_itself(self) -> bool:
        """Whether the time that counts is one that the program says."""
        return self.time is not None or self.benchmark is not None


def read_series(
    path: Path, tables: Sequence[Mapping[str, Any]], of_sweep: Mapping[str, tuple[float, ...]]
) -> tuple[Series, ...]:
    """The series of a question's file, those of patterns included. Raises InputError with one line."""
    found = [
        series
        for number, table in enumerate(tables, start=1)
        for series in _of_table(path, f"series[{number}]", _with_values(table, of_sweep))
    ]
    _require_kinds(path, tables)
    return tuple(found)


def require_both_ways(path: Path, series: Sequence[Series]) -> None:
    """Each of a figure of the kind ways is measured by turns and apart. Raises InputError with one line."""
    for number, one in enumerate(series, start=1):
        if not any(other.name == one.name and other.apart != one.apart for other in series):
            missing = "without" if one.apart else "with"
            raise InputError(
                f'{path}: series[{number}]: found "{one.name}" once, expected another one {missing} '
                "apart = true for figure ways"
            )


def require_replicated(path: Path, key: str, series: Series, figure: str, unit: str | None) -> None:
    """What has replicates is measured at either scale, and only one figure draws those of a block as one
    sample. Raises InputError with one line.
    """
    if series.replicated and figure != "schedule":
        raise InputError(f"{path}: {key}.replicated: found for figure {figure}, expected for schedule only")
    if series.replicated and unit is not None:
        raise InputError(f"{path}: {key}.replicated: found beside sweep.unit, expected either")
    for name, values in (("values", series.values), ("quick_values", series.quick_values)):
        for value in series.replicated:
            if value not in values:
                raise InputError(f"{path}: {key}.replicated: found {value:g}, expected one of its {name}")


def _with_values(table: Mapping[str, Any], of_sweep: Mapping[str, tuple[float, ...]]) -> dict[str, Any]:
    """A series has the sweep's values unless it has its own; quick values default to the values."""
    replicated = {"replicated": tuple(table.get("replicated", ()))}
    if "values" not in table:
        quick = of_sweep["quick_values"] or of_sweep["values"]
        return {**of_sweep, "quick_values": quick, **table, **replicated}
    own = {key: tuple(table.get(key, table["values"])) for key in ("values", "quick_values")}
    return {**table, **own, **replicated}


def _require_kinds(path: Path, tables: Sequence[Mapping[str, Any]]) -> None:
    """Each series is of one kind, and has nothing that only another kind can have."""
    only_for = {
        "variant": ("program", "find_chunk", "resolve_chunk", "optional"),
        "command": ("trajectory", "time", "commands"),
        "benchmark": (),
    }
    for number, table in enumerate(tables, start=1):
        key = f"{path}: series[{number}]"
        kinds = [kind for kind in only_for if kind in table]
        if len(kinds) != 1:
            found = " and ".join(kinds) or "none of them"
            raise InputError(f"{key}: found {found}, expected one of {', '.join(only_for)}")
        for kind, names in only_for.items():
            wrong = next((name for name in names if name in table and kind not in kinds), None)
            if wrong is not None:
                raise InputError(f"{key}.{wrong}: found for a {kinds[0]}, expected for a {kind} only")
        if "name" not in table and "commands" not in table and "filter" not in table.get("benchmark", {}):
            raise InputError(f"{key}.name: missing; expected a text that is not empty")


def _of_table(path: Path, key: str, table: dict[str, Any]) -> Iterator[Series]:
    pattern = table.pop("commands", None)
    words = {name: tuple(table.pop(name, ())) for name in ("command", "trajectory")}
    time = PrintedTime(**table.pop("time")) if "time" in table else None
    benchmark = Benchmark(**table.pop("benchmark")) if "benchmark" in table else None
    series = Series(
        **{"name": "", **table}, command=words["command"], trajectory=words["trajectory"], time=time,
        benchmark=benchmark,
    )  # fmt: skip
    if time is not None:
        _require_one_group(f"{path}: {key}.time.stdout", time.stdout)
    if pattern is not None:
        yield from _of_pattern(path, key, series, pattern)
    elif benchmark is not None:
        yield from _of_benchmark(path, key, series, benchmark)
    else:
        yield series


def _require_one_group(key: str, pattern: str) -> None:
    try:
        groups = groups_of(pattern)
    except PatternError as error:
        raise InputError(
            f"{key}: found {quoted(pattern)}, expected a regular expression that is allowed: found {error}"
        ) from error
    if groups != 1:
        raise InputError(f"{key}: found {quoted(pattern)} with {groups} groups, expected one around the number")


def _of_pattern(path: Path, key: str, series: Series, pattern: str) -> Iterator[Series]:
    """One for each file, named by what differs in the paths; {program} and {folder} stand for it."""
    root = Path(pattern).is_absolute()
    base = Path("/") if root else path.parent
    files = sorted(file for file in base.glob(pattern.lstrip("/")) if file.is_file())
    if not files:
        raise InputError(f'{path}: {key}.commands: found "{pattern}", which no file matches')
    names = _differing([file.relative_to(base).parts for file in files])
    for file, name in zip(files, names, strict=True):
        there = {"program": os.fspath(file), "folder": os.fspath(file.parent)}
        command, trajectory = (
            tuple(_placed(word, there) for word in words) for words in (series.command, series.trajectory)
        )
        prefix = f"{series.name} " if series.name else ""
        yield replace(series, name=prefix + name, command=command, trajectory=trajectory, is_one_of_many=True)


def _placed(word: str, values: Mapping[str, str]) -> str:
    """The word with these placeholders filled in, braces in the values kept from being others."""
    for name, value in values.items():
        word = word.replace(f"{{{name}}}", value.replace("{", "{{").replace("}", "}}"))
    return word


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
        raise InputError(f"{path}: {key}.benchmark: expected either name or filter")
    names = [benchmark.name] if benchmark.name is not None else _cases(path, key, benchmark)
    for name in names:
        own = series.name or name.replace("{", "{{").replace("}", "}}")
        words = (benchmark.program, f"--benchmark_filter=^{_escaped(name)}(/|$)")
        yield replace(series, name=own, command=words, benchmark=replace(benchmark, name=name))


def _escaped(name: str) -> str:
    """Of a regular expression the plain text; placeholders stay."""
    return re.sub(r"([\\.+*?()|\[\]^$])", r"\\\1", name)


def _cases(path: Path, key: str, benchmark: Benchmark) -> list[str]:
    program = path.parent / benchmark.program
    words = [os.fspath(program), "--benchmark_list_tests=true", f"--benchmark_filter={benchmark.filter}"]
    done = process.run(words, time_limit=_LIST_SECONDS)
    if done.exit_code != 0:
        raise InputError(f"{path}: {key}.benchmark: {done.reason}")
    names = [line.strip() for line in done.output.splitlines() if line.strip()]
    if not names:
        raise InputError(f'{path}: {key}.benchmark.filter: found "{benchmark.filter}", which no case matches')
    return names
