"""What is to be known of a record without reading it again."""

from array import array
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

from experiments.plan.point import Point, Tags
from support.files import digest_of
from support.record_schema import is_record

_OF_ONE = ("block", "position")


@dataclass(frozen=True, slots=True)
class Summary:
    """Of a record of any kind; what its kind does not have is empty."""

    kind: str
    tags: Tags
    """All but those that tell one process of a point from another: records of a point share them."""
    block: object = None
    program: str = ""
    """The hash of the program that it was measured with."""
    verdict: str = ""
    """Of its check."""
    has_trajectory: bool = False
    """Whether its errors were measured."""
    seconds: float = 0.0
    """Of the whole process."""
    runs: Sequence[float] = ()
    """The seconds of each of its timed runs, in their order: what of the process was in the clock."""
    reason: str = ""
    """Of a failure."""
    owner: str = ""
    """The machine that it is of: the partition under Slurm, else the host, else the site."""
    recorded_at: str = ""
    digest: str = ""
    """Of the content: how the file is written does not matter."""


def summary_of(record: Any) -> Summary | None:  # noqa: ANN401 - read from a file
    """Return what is to be known of it; None for what is no record."""
    if not is_record(record):
        return None
    tags = record["tags"]
    return Summary(
        kind=record["kind"],
        tags={key: value for key, value in tags.items() if key not in _OF_ONE},
        block=tags.get("block"),
        program=record.get("provenance", {}).get("binary_sha256") or "",
        verdict=record.get("check", {}).get("verdict", ""),
        has_trajectory="trajectory" in (record.get("errors") or {}),
        seconds=float(record.get("process_seconds", 0.0)),
        runs=_runs(record),
        reason=record.get("reason") or "",
        owner=_owner(record),
        recorded_at=record["recorded_at"],
        digest=digest_of(record),
    )


def _owner(record: Any) -> str:  # noqa: ANN401 - read from a file
    """A failure tells it among its tags."""
    provenance, tags = record.get("provenance", {}), record["tags"]
    slurm = provenance.get("slurm") or {}
    host = provenance.get("host") or tags.get("host", "unknown")
    return str(slurm.get("SLURM_JOB_PARTITION") or tags.get("partition") or host)


def _runs(record: Any) -> Sequence[float]:  # noqa: ANN401 - read from a file
    """None of a profile, which times phases instead."""
    if record["kind"] not in ("bench", "process"):
        return ()
    return array("d", (float(one["steps_seconds"]) for one in record["repetitions"]))


def unusable(found: Summary | None, point: Point, block: int) -> str | None:
    """Why a record does not stand for this process of this point; None if it does."""
    if found is None:
        return "it does not match the record schema"
    if found.kind not in ("bench", "profile", "process"):
        return f"it is of the kind {found.kind}"
    if found.verdict == "failed":
        return "its result failed the check"
    if found.program != point.program.sha256:
        return "it was measured with another program"
    if point.measures_errors(block) and not found.has_trajectory:
        return "it lacks the error measures"
    if not point.tags.items() <= found.tags.items():
        key = next(key for key, value in point.tags.items() if found.tags.get(key) != value)
        return f"its {key} is {found.tags.get(key)!r}, not {point.tags[key]!r}"
    if found.block != block:
        return f"its block is {found.block!r}, not {block!r}"
    return None


def packed(found: Summary) -> list[Any]:
    """Return all but the tags as JSON has it."""
    told = {field.name: getattr(found, field.name) for field in fields(Summary) if field.name != "tags"}
    return [*(told | {"runs": list(found.runs)}).values()]


def unpacked(told: Any, tags: Tags) -> Summary:  # noqa: ANN401 - read from a file
    """Return what was packed. Raises ValueError or TypeError for anything else."""
    kind, *more = told
    found = Summary(kind, tags, *more)
    return replace(found, runs=array("d", found.runs))
