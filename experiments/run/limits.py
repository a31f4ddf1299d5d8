"""What the machine can do at most, measured once before anything is compared with it."""

from dataclasses import asdict

from experiments.plan.point import Point
from experiments.plan.program import tag_arguments
from experiments.results.store import Store
from experiments.run import beside
from experiments.support.process import Completed

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
        done = beside.record(command, point.openmp, self._time_limit, scratch, path)
        if done.exit_code != 0:
            return Completed(command, done.exit_code, "", f"limits of the machine: {done.reason}")
        return done


def _name(point: Point) -> str:
    return beside.name_of([point.program.sha256, asdict(point.machine), point.threads, point.openmp])
