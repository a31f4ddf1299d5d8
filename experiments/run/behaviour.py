"""What earlier runs tell of how to measure a program: whether it minds standing still, how long it takes."""

import statistics
from dataclasses import dataclass, field

from experiments.plan.point import Point
from experiments.results.record import Record
from experiments.results.store import Store
from experiments.side_by_side.contest import LEFT_ALONE


@dataclass
class Behaviour:
    """Of one point; `turns` is None as long as it was not found out."""

    turns: bool | None = None
    seconds: list[float] = field(default_factory=list)

    @property
    def expected_seconds(self) -> float | None:
        """How long a run takes undisturbed, if any was seen."""
        return statistics.median(self.seconds) if self.seconds else None


class Behaviours:
    """Of all points of a results folder, each in a note of its own: tasks of a cluster share the folder."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._known: dict[str, Behaviour] = {}

    def of(self, point: Point) -> Behaviour:
        """What is known of a point."""
        if point.id not in self._known:
            self._known[point.id] = _read(self._store.note(_note_of(point)))
        return self._known[point.id]

    def learn(self, point: Point, there: Record, *, found_out: bool) -> str:
        """Take in what was measured of the point; `found_out` says that it was left to the program to find
        out whether the point may take turns. Returns why it does not, if that is news.
        """
        process = there.get("process")
        if process is None or (point.command is not None and point.command.benchmark):
            return ""
        known = self.of(point)
        known.seconds.append(float(process["wall_seconds"]) / process.get("runs", 1))
        reason = process.get("undisturbed") if found_out else None
        if reason == LEFT_ALONE:
            reason = None
        elif reason:
            known.turns = False
        elif found_out and there["slices"]:
            known.turns = True
        self._store.keep_note(_note_of(point), {"turns": known.turns, "seconds": known.seconds})
        return str(reason or "")


def _read(note: object) -> Behaviour:
    """A note's content; of anything else nothing."""
    match note:
        case {"turns": bool() | None as turns, "seconds": [*seconds]}:
            return Behaviour(
                turns, [float(one) for one in seconds if isinstance(one, int | float) and one > 0]
            )
    return Behaviour()


def _note_of(point: Point) -> str:
    return f"turns/{point.id}.json"
