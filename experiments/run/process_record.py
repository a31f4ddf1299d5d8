"""What a whole process leaves: its record, or that of its failure, as harness/record.schema.json has them."""

import json
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from experiments.plan.point import PROCESS, Tags
from experiments.plan.site import OPENMP_VARIABLES
from experiments.run.sources import Sources
from experiments.side_by_side.contest import Entrant
from experiments.support.digest import digest_of_hashes

Record = dict[str, Any]


@dataclass(frozen=True)
class Described:
    """What a record says of a process beside what was measured."""

    tags: Tags
    axes: Mapping[str, object]
    checked: str = ""
    """How its result was checked beforehand; empty if it was not."""
    build: Mapping[str, Any] | None = None
    """Of the provenance, what is not as that of the program which measures."""


def process_record(
    one: Entrant,
    its: Described,
    sources: Sources,
    surroundings: tuple[Record, Any],
    contest: tuple[int, int],
) -> Record:
    """The record of a process of which a run counts. The `surroundings` are its machine's provenance and its
    scene, as the sampler tells them; `contest` is how many were measured beside each other, and the seed of
    their order. Without runs that count it is the record of its failure.
    """
    if one.failure:
        return {
            **_head("failure", its),
            "command": [*one.contender.words],
            "exit_code": one.exit_code,
            "reason": one.failure,
        }
    process = _process(one, sources)
    provenance, scene = surroundings
    return {
        **_head(PROCESS, its),
        "scene": scene,
        "warm_ups": one.contender.warm_ups,
        "repetitions": _repetitions(one),
        "process_seconds": process["wall_seconds"],
        "process": process,
        "turns": _turns(one, *contest),
        "check": {
            "verdict": "passed" if its.checked else "unchecked",
            "scope": its.checked or "nothing",
            "reason": None,
        },
        "provenance": _provenance(provenance, its, one.contender.environment, sources),
    }


def _head(kind: str, its: Described) -> Record:
    return {
        "schema_version": 1,
        "kind": kind,
        "recorded_at": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "tags": {key: _number_or_text(value) for key, value in its.tags.items()},
        "axes": dict(its.axes),
    }


def _number_or_text(value: str | float) -> str | int | float:
    """A text that is a number of JSON as one, as the program takes tags."""
    try:
        number = json.loads(str(value), parse_constant=str)
    except ValueError:
        return value
    return number if isinstance(number, int | float) and not isinstance(number, bool) else value


def _provenance(told: Record, its: Described, environment: Mapping[str, str], sources: Sources) -> Record:
    """That of the program which measured it, but for build, environment and the hash of the program."""
    build = its.build or {}
    openmp = {key: value for key, value in environment.items() if key.startswith(OPENMP_VARIABLES)}
    return {
        **told,
        **build,
        "openmp": {**told["openmp"], **build.get("openmp", {}), "environment": openmp},
        "binary_sha256": digest_of_hashes([sources.hashes[file] for file in sources.files]),
    }


def _turns(one: Entrant, contenders: int, seed: int) -> Record | None:
    """None if no other took turns with it."""
    if contenders == 1 or (not one.is_sliced and len(one.runs) == 1):
        return None
    return {
        "contenders": contenders,
        "seed": seed,
        "seconds": [seconds for run in one.runs for seconds in run.seconds],
        "seconds_alone": sum(run.seconds_alone for run in one.runs) if one.is_sliced else 0.0,
    }


def _repetitions(one: Entrant) -> list[Record]:
    """A time for each run: the one that the program says, or the one from outside."""
    if one.stated:
        return [
            {"steps_seconds": said.seconds, "cpu_seconds": said.cpu_seconds, "waited_seconds": None}
            for said in one.stated
        ]
    return [
        {
            "steps_seconds": run.wall_seconds,
            "cpu_seconds": run.cpu_seconds,
            "waited_seconds": run.waited_seconds,
        }
        for run in one.runs
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
