"""What takes turns: contenders of one work, but for a known amount more, of three kinds."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from experiments.plan.benchmark_cases import filter_of
from experiments.plan.program import Program, generate
from experiments.plan.scenes import Scene
from experiments.plan.site import clean_environment
from experiments.results.record import runs_of
from experiments.side_by_side.contest import Contender, Contest
from experiments.side_by_side.sampler import Sampler
from experiments.support import process
from support.errors import InputError
from support.files import read_json

PERCENT_MORE = (0, 0, 1, 2, 3, 5, 10)
"""Of the work of the first contender: how much more each one does."""

_SCENE = Scene(500, 707, 12, 100, 1, 3, placement="random", isotropic=True)
"""A hundred steps of discs that begin apart and stay alike: a step more is a hundredth more work."""

_RUNS = 3
"""Whole runs of each variant in a process, which are a block."""

_LOOPS, _SECONDS, _SLICE_SECONDS = 12_000_000, 0.02, 0.01
"""Of a whole process; about how long it takes, and how long a slice of it is."""

_LIMIT_SECONDS = 120.0
"""Of one call."""


Rounds = list[list[float]]
"""The seconds of every contender in every round of one call."""


@dataclass(frozen=True)
class Kind:
    """Contenders of one kind, measured beside each other."""

    name: str
    call: Callable[[int], tuple[Rounds, Any]]
    """Of a seed, which is another one in each call, its rounds, and the provenance of whoever measured them.
    Raises InputError where it fails.
    """
    rounds_of_block: int
    """Successive rounds of a call that are one block. Calls with fewer rounds are a block each."""


def variants(program: Program, openmp: Mapping[str, str], folder: Path) -> Kind:
    """One variant on one thread, with so many steps more."""
    contenders, record = [], folder / "record.json"
    for percent in PERCENT_MORE:
        scene = replace(_SCENE, steps=_SCENE.steps * (100 + percent) // 100)
        path = folder / f"{scene.steps}.in"
        if not path.exists():
            generate(program, scene, path)
        contenders.append([str(path), "--threads", "1"])
    file = folder / "variants.json"
    file.write_text(json.dumps(contenders), encoding="utf-8")
    # A turn is a whole run, however long that is.
    words = ("turns", str(file), "--record", str(record), "--turn", "1000000", "--runs", str(_RUNS))

    def call(seed: int) -> tuple[Rounds, Any]:
        command = (str(program.path), *words, "--seed", str(seed))
        done = process.run(command, clean_environment(openmp), _LIMIT_SECONDS)
        if done.exit_code != 0:
            raise InputError(done.reason)
        found = read_json(record)
        record.unlink()  # so that nothing is taken for what the next call left
        return _rounds([runs_of(found, one) for one in found["contenders"]]), found["provenance"]

    return Kind("variants", call, _RUNS)


def processes(program: Program, openmp: Mapping[str, str], folder: Path) -> Kind:
    """A whole process, in slices of time, that repeats a loop so many times more."""
    worker = _built(program, "calibration_process")

    def contender(loops: int, **more: Any) -> Contender:  # noqa: ANN401 - any field
        return Contender((str(worker), str(loops)), environment=openmp, **more)

    def call(seed: int, contenders: Sequence[Contender]) -> tuple[Rounds, Any]:
        return _contest(program, contenders, seed, folder)

    apart = [contender(loops, turns=False) for loops in (1, _LOOPS)]
    least = [min(times) for times in zip(*(call(seed, apart)[0][0] for seed in range(9)), strict=True)]
    # A start takes its time as well: as many loops as that is are that much more.
    start = _LOOPS * least[0] / max(least[1] - least[0], 1e-9)
    loops = [_LOOPS + round((_LOOPS + start) * percent / 100) for percent in PERCENT_MORE]
    all_of_them = [
        contender(one, turns=True, expected_seconds=_SECONDS * (one + start) / _LOOPS) for one in loops
    ]
    return Kind("processes", partial(call, contenders=all_of_them), 1)


def benchmarks(program: Program, openmp: Mapping[str, str], folder: Path) -> Kind:
    """A case of a Google Benchmark that repeats a loop so many times more."""
    worker, contenders = _built(program, "calibration_benchmark"), []
    for number, percent in enumerate(PERCENT_MORE):
        case, output = f"loop/{100 + percent}", (folder / f"{number}.out").absolute()
        words = (str(worker), filter_of(case), f"--benchmark_out={output}", "--benchmark_out_format=json")
        contenders.append(Contender(words, environment=openmp, benchmark=case, output=output))
    return Kind("benchmarks", lambda seed: _contest(program, contenders, seed, folder), 1)


KINDS: tuple[Callable[[Program, Mapping[str, str], Path], Kind], ...] = (variants, processes, benchmarks)


def _contest(
    program: Program, contenders: Sequence[Contender], seed: int, folder: Path
) -> tuple[Rounds, Any]:
    with Sampler(program.path) as sampler:
        ended = Contest(sampler, contenders, _SLICE_SECONDS, seed, folder).measure()
        if failed := [one.failure for one in ended if one.failure]:
            raise InputError(failed[0])
        provenance, _ = sampler.surroundings(1, None)
    return _rounds([one.told_seconds for one in ended]), provenance


def _rounds(times: Sequence[Sequence[float]]) -> Rounds:
    return [list(one) for one in zip(*times, strict=True)]


def _built(program: Program, name: str) -> Path:
    """A program of known work beside `carom`. Raises InputError if it is not built."""
    path = program.path.parent / "harness" / "tests" / name
    if not path.is_file():
        raise InputError(f"{path}: is not built; `make calibrate` builds it")
    return path
