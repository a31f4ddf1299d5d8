"""What the machine can do at most, measured once before anything is compared with it."""

import hashlib
import json
from dataclasses import asdict

from experiments.plan.point import Point
from experiments.plan.program import tag_arguments
from experiments.results.store import Store
from experiments.run.turn import run_in_turn
from experiments.support.files import move, read_json
from experiments.support.process import Completed
from experiments.support.schema import is_record

FIGURE = "limits"
"""The kind of figure that compares with them."""

FOLDER = "limits-of-machines"
"""Below `records/`, beside the folders of the experiments."""


class Limits:
    """Runs `carom limits`, once for each program, machine, number of threads and binding; records are
    kept.
    """

    def __init__(self, store: Store, time_limit: float) -> None:
        self._store = store
        self._time_limit = time_limit

    def measure(self, point: Point) -> Completed:
        """Measure what the point's machine can do, unless a record of it is there or the figure needs
        none.
        """
        path = self._store.root / "records" / FOLDER / f"{_name(point)}.json"
        scratch = self._store.temporary / "limits.json"
        words = [str(point.program.path), "limits", "--threads", str(point.threads), "--record", str(scratch)]
        command = (*words, *tag_arguments({"experiment": FOLDER, "site": point.site}))
        if point.figure != FIGURE or self._store.holds(path, "limits"):
            return Completed(command, 0, "", "")
        scratch.unlink(missing_ok=True)
        done = run_in_turn(command, point.openmp, self._time_limit)
        if done.exit_code != 0:
            return Completed(command, done.exit_code, "", f"limits of the machine: {done.reason}")
        if not is_record(read_json(scratch)):
            return Completed(command, 1, "", "limits of the machine: no record that can be used")
        move(scratch, path)
        return done


def _name(point: Point) -> str:
    content = [point.program.sha256, asdict(point.machine), point.threads, point.openmp]
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()[:16]
