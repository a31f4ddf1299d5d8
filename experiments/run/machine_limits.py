"""What the machine can do at most, which questions about limits are compared with: measured once."""

import json
import os
from dataclasses import asdict
from pathlib import Path

from experiments.plan.point import Point
from experiments.plan.program import tag_arguments
from experiments.results.store import Store
from experiments.run.host_lock import run_alone
from experiments.support.digest import digest
from experiments.support.process import Completed
from support.files import move, read_json
from support.record_schema import is_record

KIND = "limits"
FOLDER = "limits-of-machines"
"""Below `records/`."""


def measure_limits(store: Store, point: Point, time_limit: float) -> Completed | None:
    """Make the record of program, machine and threads that a point needs, unless it is there, by `carom
    limits` with the point's OpenMP variables. Returns how that failed, else None.
    """
    if point.kind != KIND:
        return None
    key = digest(json.dumps((point.program.sha256, asdict(point.machine), point.threads, point.openmp)))
    path = store.root / "records" / FOLDER / f"{key}.json"
    if _is_of_limits(path):
        return None
    if os.path.lexists(path):
        store.retire(path)
    scratch = store.temporary / "limits.json"
    scratch.unlink(missing_ok=True)
    words = (KIND, "--threads", str(point.threads), "--record", str(scratch))
    own = tag_arguments({"experiment": FOLDER, "site": point.site})
    done = run_alone([str(point.program.path), *words, *own], point.openmp, time_limit)
    if done.exit_code == 0 and _is_of_limits(scratch):
        move(scratch, path)
        return None
    reason = done.reason if done.exit_code else "no record that can be used"
    return Completed(done.command, done.exit_code or 1, "", f"limits of the machine: {reason}")


def _is_of_limits(path: Path) -> bool:
    record = read_json(path)
    return is_record(record) and record["kind"] == KIND
