"""What a record holds: one process with all its contenders, each of them measured or failed."""

import os
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from experiments.plan.point import Point, Tags
from experiments.support.process import Completed
from support.record_schema import VERSION

Record = dict[str, Any]
"""A record, or one of its contenders, as harness/record.schema.json has them."""


def new_record(kind: str, contenders: Sequence[Record], **more: object) -> Record:
    """A record of this kind, of now."""
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return {
        "schema_version": VERSION,
        "kind": kind,
        "recorded_at": now,
        "contenders": [*contenders],
        **more,
    }


def failed(point: Point, done: Completed, tags: Tags) -> Record:
    """A contender that was not measured: why, where and with which program."""
    where = {
        "host": os.uname().nodename,
        "partition": os.environ.get("SLURM_JOB_PARTITION"),
        "program_sha256": point.program.sha256,
    }
    return {
        "tags": {**tags, **{key: value for key, value in where.items() if value}},
        "axes": point.axes,
        "command": list(done.command),
        "exit_code": done.exit_code,
        "reason": done.reason,
    }


def is_failed(contender: Mapping[str, Any]) -> bool:
    """Whether it was not measured."""
    return "reason" in contender


def together_in(records: Sequence[Record]) -> Record:
    """Several records of processes of the same program as one, where those who were to share a process could
    not.
    """
    first = next((one for one in records if one["kind"] != "failure"), records[0])
    return first | {"contenders": [one for record in records for one in record["contenders"]]}


def runs_of(record: Record, contender: Record) -> list[float]:
    """The seconds of each of its timed runs, in their order: what of its process was in the clock. None of a
    profile, which times phases instead.
    """
    is_timed = record["kind"] in ("bench", "process")
    return [float(one["steps_seconds"]) for one in contender["repetitions"]] if is_timed else []


def owner_of(record: Record) -> str:
    """The machine that it is of: the partition under Slurm, else the host. Where all failed it is told among
    the tags.
    """
    provenance, tags = record.get("provenance") or {}, record["contenders"][0]["tags"]
    slurm = provenance.get("slurm") or {}
    host = provenance.get("host") or tags.get("host", "unknown")
    return str(slurm.get("SLURM_JOB_PARTITION") or tags.get("partition") or host)


def unusable(record: Record, contender: Record, point: Point, block: int) -> str | None:
    """Why what was measured does not stand for this point in this block; None if it does."""
    tags, provenance = contender["tags"], record["provenance"] | contender.get("provenance", {})
    if record["kind"] not in ("bench", "profile", "process"):
        return f"it is of the kind {record['kind']}"
    if contender["check"]["verdict"] == "failed":
        return "its result failed the check"
    if provenance["binary_sha256"] != point.program.sha256:
        return "it was measured with another program"
    if point.measures_errors(block) and "trajectory" not in contender["errors"]:
        return "it lacks the error measures"
    if not point.tags.items() <= tags.items():
        key = next(key for key, value in point.tags.items() if tags.get(key) != value)
        return f"its {key} is {tags.get(key)!r}, not {point.tags[key]!r}"
    if tags.get("block") != block:
        return f"its block is {tags.get('block')!r}, not {block!r}"
    return None
