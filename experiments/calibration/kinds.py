"""What takes turns: contenders of one work, but for a known amount more, of three kinds."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from experiments.plan.benchmark_cases import filter_of
from experiments.plan.program import Program, generate
from experiments.plan.scenes import Scene
from experiments.support import process
from support.errors import InputError
from support.files import read_json

PERCENT_MORE = (0, 0, 1, 2, 3, 5, 10)
"""Of the work of the first contender: how much more each one does."""

_SCENE = Scene(500, 707, 12, 100, 1, 3, placement="random", isotropic=True)
"""A hundred steps of discs that begin apart and stay alike: a step more is a hundredth more work."""

_RUNS = 3
"""Whole runs of each variant in a process, which are a block."""

_LOOPS, _SECONDS = 12_000_000, 0.02
"""Of a whole process; about how long it takes, which decides how many slices there are."""

_LIMIT_SECONDS = 60.0
"""Of one contender's process."""


@dataclass(frozen=True)
class Kind:
    """Contenders of one kind, as one call of `carom` measures them."""

    name: str
    command: tuple[str, ...]
    """Without `--seed`, which is another one in each call."""
    records: tuple[Path, ...]
    """What a call leaves, one file a contender."""
    openmp: Mapping[str, str]
    rounds_of_block: int
    """Successive rounds of a call that are one block. Calls with fewer rounds are a block each."""


def variants(program: Program, openmp: Mapping[str, str], folder: Path) -> Kind:
    """One variant on one thread, with so many steps more."""
    contenders, records = [], _records(folder)
    for record, percent in zip(records, PERCENT_MORE, strict=True):
        scene = replace(_SCENE, steps=_SCENE.steps * (100 + percent) // 100)
        path = folder / f"{scene.steps}.in"
        if not path.exists():
            generate(program, scene, path)
        contenders.append([str(path), "--threads", "1", "--record", str(record)])
    file = _written(folder / "variants.json", contenders)
    # A turn is a whole run, however long that is.
    command = (str(program.path), "turns", str(file), "--turn", "1000000")
    return Kind("variants", (*command, "--runs", str(_RUNS)), records, openmp, _RUNS)


def processes(program: Program, openmp: Mapping[str, str], folder: Path) -> Kind:
    """A whole process, in slices of time, that repeats a loop so many times more."""
    worker = _built(program, "calibration_process")
    records = _records(folder)

    def described(loops: int, record: Path) -> dict[str, Any]:
        return {"command": [str(worker), str(loops)], "turns": True, "record": str(record)}

    start = _start_in_loops(program, folder, described)
    # A start takes its time as well: that much more of it is to be made of loops.
    loops = [_LOOPS + round((_LOOPS + start) * percent / 100) for percent in PERCENT_MORE]
    content = [
        {**described(one, record), "expected_seconds": _SECONDS * (one + start) / _LOOPS}
        for one, record in zip(loops, records, strict=True)
    ]
    file = _written(folder / "processes.json", content)
    command = (str(program.path), "processes", str(file))
    return Kind("processes", command, records, openmp, 1)


def benchmarks(program: Program, openmp: Mapping[str, str], folder: Path) -> Kind:
    """A case of a Google Benchmark that repeats a loop so many times more."""
    worker = _built(program, "calibration_benchmark")
    records, content = _records(folder), []
    for record, percent in zip(records, PERCENT_MORE, strict=True):
        case, output = f"loop/{100 + percent}", record.with_suffix(".out").absolute()
        words = [filter_of(case), f"--benchmark_out={output}", "--benchmark_out_format=json"]
        one = {"command": [str(worker), *words], "benchmark": case, "output": str(output)}
        content.append({**one, "record": str(record)})
    file = _written(folder / "benchmarks.json", content)
    return Kind("benchmarks", (str(program.path), "processes", str(file)), records, openmp, 1)


KINDS: tuple[Callable[[Program, Mapping[str, str], Path], Kind], ...] = (variants, processes, benchmarks)


def rounds(kind: Kind) -> list[list[float]]:
    """The seconds of every contender in every round of the call that just ended.

    Raises InputError where the records do not have them.
    """
    times = []
    for path in kind.records:
        match read_json(path):
            case {"repetitions": [*repetitions]}:
                times.append([float(one["steps_seconds"]) for one in repetitions])
            case {"kind": "failure", "reason": str(reason)}:
                raise InputError(f"calibrate: {kind.name}: {reason}")
            case _:
                raise InputError(f"{path}: found no record, expected one of {kind.name}")
        # So that nothing is taken for what the next call left.
        path.unlink()
    return [list(one) for one in zip(*times, strict=True)]


def _records(folder: Path) -> tuple[Path, ...]:
    return tuple(folder / f"record-{number}.json" for number in range(len(PERCENT_MORE)))


def _written(path: Path, content: Sequence[Any]) -> Path:
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def _built(program: Program, name: str) -> Path:
    """A program of known work beside `carom`. Raises InputError if it is not built."""
    path = program.path.parent / "harness" / "tests" / name
    if not path.is_file():
        raise InputError(f"{path}: is not built; `make calibrate` builds it")
    return path


def _start_in_loops(
    program: Program, folder: Path, described: Callable[[int, Path], dict[str, Any]]
) -> float:
    """As how many loops the start and the end of a process take."""
    sizes, least = (1, _LOOPS), [float("inf"), float("inf")]
    records = [folder / f"start-{size}.json" for size in sizes]
    content = [{**described(*one), "turns": False} for one in zip(sizes, records, strict=True)]
    file = _written(folder / "start.json", content)
    for seed in range(9):
        command = [str(program.path), "processes", str(file), "--seed", str(seed)]
        done = process.run(command, time_limit=_LIMIT_SECONDS)
        kind = Kind("processes", (), tuple(records), {}, 1)
        if done.exit_code != 0:
            raise InputError(f"calibrate: processes: {done.reason}")
        least = [min(pair) for pair in zip(least, rounds(kind)[0], strict=True)]
    return _LOOPS * least[0] / max(least[1] - least[0], 1e-9)
