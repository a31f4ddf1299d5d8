"""What the machine can do at most, which questions about limits are compared with: measured once."""

import json
from dataclasses import asdict

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


class MachineLimits:
    """Runs `carom limits`, with the point's program and OpenMP variables, where there is no record yet."""

    def __init__(self, store: Store, time_limit: float) -> None:
        self._store = store
        self._time_limit = time_limit

    def ensure(self, point: Point) -> Completed | None:
        """Make the record of program, machine and threads that a point needs, unless it is there. Returns how
        that failed, else None.
        """
        if point.kind != KIND:
            return None
        key = digest(json.dumps((point.program.sha256, asdict(point.machine), point.threads, point.openmp)))
        path = self._store.root / "records" / FOLDER / f"{key}.json"
        if self._store.holds(path, KIND):
            return None
        scratch = self._store.temporary / "limits.json"
        scratch.unlink(missing_ok=True)
        words = (KIND, "--threads", str(point.threads), "--record", str(scratch))
        own = tag_arguments({"experiment": FOLDER, "site": point.site})
        done = run_alone([str(point.program.path), *words, *own], point.openmp, self._time_limit)
        if done.exit_code == 0 and is_record(read_json(scratch)):
            move(scratch, path)
            return None
        reason = done.reason if done.exit_code else "no record that can be used"
        return Completed(done.command, done.exit_code or 1, "", f"limits of the machine: {reason}")
