"""What whole processes leave that were measured beside each other, as harness/record.schema.json has it."""

import json
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from experiments.plan.point import PROCESS, Tags
from experiments.plan.site import OPENMP_VARIABLES
from experiments.results.record import Record, new_record
from experiments.run.sources import Sources
from experiments.side_by_side.contest import Entrant
from experiments.side_by_side.run_result import RunResult
from experiments.side_by_side.stated_time import StatedTime
from experiments.support.digest import digest_of_hashes


@dataclass(frozen=True)
class Described:
    """What a record says of a process beside what was measured."""

    tags: Tags
    axes: Mapping[str, object]
    sources: Sources
    checked: str = ""
    """How its result was checked beforehand; empty if it was not."""
    build: Mapping[str, Any] | None = None
    """Of the provenance, what is not as that of the program which measures."""
    surroundings: tuple[Record, Any] = ({}, None)
    """Its machine's provenance and its scene, as the sampler tells them."""


def process_record(contest: Sequence[tuple[Entrant, Described]], seed: int) -> Record:
    """The record of processes that were measured beside each other, in an order drawn by the seed; of those
    of which no run counts with the reason.
    """
    origins = [_provenance(its, one) for one, its in contest if not one.failure]
    whole = origins[0] if origins else {}
    contenders = [
        _failed(one, its) if one.failure else _measured(one, its, whole, len(contest)) for one, its in contest
    ]
    is_shared = any(one.get("slices") for one in contenders)
    turns = {"seed": seed} if is_shared else None
    return new_record(PROCESS, contenders, turns=turns, provenance=whole)


def _failed(one: Entrant, its: Described) -> Record:
    return {
        **_head(its),
        "command": [*one.contender.words],
        "exit_code": one.exit_code,
        "reason": one.failure,
    }


def _measured(one: Entrant, its: Described, whole: Record, contenders: int) -> Record:
    process, own = _process(one, its.sources), _provenance(its, one)
    return {
        **_head(its),
        "scene": its.surroundings[1],
        "warm_ups": one.contender.warm_ups,
        "repetitions": _repetitions(one),
        "process_seconds": process["wall_seconds"],
        "process": process,
        "slices": _slices(one, contenders),
        "check": {
            "verdict": "passed" if its.checked else "unchecked",
            "scope": its.checked or "nothing",
            "reason": None,
        },
        "provenance": {key: value for key, value in own.items() if value != whole[key]},
    }


def _head(its: Described) -> Record:
    return {"tags": {key: _number_or_text(value) for key, value in its.tags.items()}, "axes": dict(its.axes)}


def _number_or_text(value: str | float) -> str | int | float:
    """A text that is a number of JSON as one, as the program takes tags."""
    try:
        number = json.loads(str(value), parse_constant=str)
    except ValueError:
        return value
    return number if isinstance(number, int | float) and not isinstance(number, bool) else value


def _provenance(its: Described, one: Entrant) -> Record:
    """That of the program which measured it, but for build, environment and the hash of the program."""
    told, build, sources = its.surroundings[0], its.build or {}, its.sources
    environment = one.contender.environment
    openmp = {key: value for key, value in environment.items() if key.startswith(OPENMP_VARIABLES)}
    return {
        **told,
        **build,
        "openmp": {**told["openmp"], **build.get("openmp", {}), "environment": openmp},
        "binary_sha256": digest_of_hashes([sources.hashes[file] for file in sources.files]),
    }


def _slices(one: Entrant, contenders: int) -> Record | None:
    """None if no other took turns with it."""
    if contenders == 1 or (not one.is_sliced and len(one.runs) == 1):
        return None
    return {
        "seconds": [seconds for run in one.runs for seconds in run.seconds],
        "seconds_alone": sum(run.seconds_alone for run in one.runs) if one.is_sliced else 0.0,
    }


def _repetitions(one: Entrant) -> list[Record]:
    """A time for each run: the one that the program says, or the one from outside."""
    told: Sequence[StatedTime | RunResult] = one.stated or one.runs
    return [
        {"steps_seconds": seconds, "cpu_seconds": its.cpu_seconds, "waited_seconds": its.waited_seconds}
        for seconds, its in zip(one.told_seconds, told, strict=True)
    ]


def _process(one: Entrant, sources: Sources) -> Record:
    """Of the last run; what adds up is that of all runs, and memory that of the largest."""
    runs, last = one.runs, one.runs[-1]
    largest = max(runs, key=lambda run: run.peak_memory_bytes or -1)
    return {
        "command": [*one.contender.words],
        "folder": one.contender.folder,
        "sources": [{"path": str(file), "sha256": sources.hashes[file]} for file in sources.files],
        "changed": [*map(str, sources.changed())],
        "time_from": "the program" if one.stated else "outside",
        "counters": _means([said.counters for said in one.stated]),
        "library_version": one.stated[-1].library_version if one.stated else None,
        "exit_code": last.exit_code,
        "exit_codes": [run.exit_code for run in runs],
        **{
            name: sum(getattr(run, name) for run in runs)
            for name in ("wall_seconds", "user_seconds", "system_seconds", "seconds_left_behind")
        },
        "runs": len(runs),
        "peak_memory_bytes": largest.peak_memory_bytes,
        "peak_memory_reason": largest.memory_of,
        "output_bytes": last.output_bytes + last.error_bytes,
        "output_end": last.output_end,
        "error_end": last.error_end,
        "tree": last.tree,
        "ran_on": last.ran_on,
        "counted": _means([run.counted for run in runs]),
        "undisturbed": one.undisturbed or None,
    }


def _means(all_of_them: Sequence[Mapping[str, float | None]]) -> dict[str, float | None]:
    """The mean of each over the runs that have it; None where one of them has no finite number."""
    names = dict.fromkeys(name for one in all_of_them for name in one)
    return {name: _mean(one[name] for one in all_of_them if name in one) for name in names}


def _mean(values: Iterable[float | None]) -> float | None:
    known = [*values]
    return None if None in known else statistics.fmean(one for one in known if one is not None)
