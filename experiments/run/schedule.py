"""How many blocks each experiment has, what is still to be run, and who gets the next ones."""

import math
from collections.abc import Collection, Mapping, Sequence

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.plan.question import CONTROL
from experiments.results.store import Found, Store
from experiments.run.budget import Load, allocate
from experiments.run.costs import Costs
from experiments.run.given import Given, given_before, keep
from experiments.run.progress import Status
from experiments.run.verdicts import Open, Verdicts
from experiments.run.verify import representative


class Schedule:
    """The number of blocks of each experiment: it grows, and is written down before a block begins."""

    def __init__(
        self,
        store: Store,
        experiments: Sequence[Experiment],
        found: Mapping[str, Found],
        costs: Costs,
    ) -> None:
        """An experiment begins with its least number of blocks, or with what an earlier session gave it."""
        self.experiments = tuple(experiments)
        self._store = store
        self._found = found
        self._costs = costs
        self._once_each = {one.name: _once_each(one, costs) for one in experiments}
        self._given_up: set[tuple[str, str]] = set()
        self._begun = given_before(store, experiments, found)
        least = {one.name: Given(one.question.blocks.minimum) for one in experiments}
        self.given = least | self._begun

    def share(self, seconds_left: float, settled: Collection[str] = ()) -> None:
        """Share the time left among the experiments that are not settled; none loses a block it was given."""
        once = self._once_seconds()
        loads = [self._load(one, once[one.name], stopped=one.name in settled) for one in self.experiments]
        for name, blocks in allocate(loads, seconds_left).items():
            self.given[name].blocks = blocks

    def give(self, experiment: Experiment, found: Open) -> None:
        """Give an experiment the blocks up to its next look, without the points of which nothing is asked."""
        given = self.given[experiment.name]
        for point in experiment.points:
            if (point.series, point.x) in found.points_stopped:
                given.stopped.setdefault(point.id, given.blocks)
        given.blocks = max(given.blocks, found.next)

    def cheapest(self, verdicts: Verdicts, seconds_left: float) -> Experiment | None:
        """The experiment in which something is settled at the least expense, of those whose next look there
        is time for; None if there is none. One that has its blocks waits for the others that a claim rests
        on.

        What was spent on it since its least blocks counts as well: an effect near a border always seems a few
        blocks from being settled.
        """
        best, least = None, math.inf
        for one in self.experiments:
            found = verdicts.open.get(one.name)
            if found is None or any(self._is_given_up(one, point) for point in one.points):
                continue
            if self.given[one.name].blocks >= found.next and self.is_complete(one):
                continue
            goes_on = [point for point in one.points if (point.series, point.x) not in found.points_stopped]
            block = sum(map(self._costs.point, goes_on))
            seconds = block * (found.needed - one.question.blocks.minimum)
            if seconds < least and block * (found.next - found.blocks) <= seconds_left:
                best, least = one, seconds
        return best

    def _is_given_up(self, experiment: Experiment, point: Point) -> bool:
        return (experiment.name, point.id) in self._given_up

    def begin(self, experiment: Experiment) -> int:
        """The experiment's number of blocks, fixed and written down."""
        given = self._begun[experiment.name] = self.given[experiment.name]
        keep(self._store, experiment, given)
        return given.blocks

    def promised(self, experiment: Experiment) -> int:
        """The blocks that the experiment gets for certain: those decided, until then the least."""
        begun = self._begun.get(experiment.name)
        return begun.blocks if begun else experiment.question.blocks.minimum

    def size(self, experiment: Experiment, block: int) -> int:
        """How many points the block has."""
        given = self.given[experiment.name]
        return sum(given.includes(point, block) for point in experiment.points)

    def missing(self, experiment: Experiment, block: int) -> list[tuple[int, Point]]:
        """Position and point of what is still to be run in one block, in the block's order."""
        seconds, given = self._found[experiment.name].seconds, self.given[experiment.name]
        return [
            (position, point)
            for position, point in enumerate(experiment.block(block))
            if given.includes(point, block)
            and (point.id, block) not in seconds
            and not self._is_given_up(experiment, point)
        ]

    def is_complete(self, experiment: Experiment) -> bool:
        """Whether nothing of it is still to be run."""
        blocks = self.given[experiment.name].blocks
        return not any(self.missing(experiment, block) for block in range(blocks))

    def finish(self, experiment: Experiment, point: Point, block: int, seconds: float | None) -> None:
        """A process ended after so many seconds; None if it failed, and then its point is not tried again."""
        if seconds is None:
            self._given_up.add((experiment.name, point.id))
            return
        self._found[experiment.name].seconds[point.id, block] = seconds
        self._costs.learn(point, seconds)

    def status(self) -> Status:
        """How far the study is; what is left counts scenes and checks too."""
        missing = self._all_missing()
        planned = sum(len(self.given[one.name].keys(one.points)) for one in self.experiments)
        return Status(
            planned=planned,
            done=planned - len(missing) - self._without_hope(),
            seconds_done=sum(sum(found.seconds.values()) for found in self._found.values()),
            seconds_left=sum(self._once_seconds().values()) + sum(map(self._costs.point, missing)),
        )

    def _without_hope(self) -> int:
        """How many processes of points that failed will not be run."""
        return sum(
            (point.id, block) not in self._found[one.name].seconds and self._is_given_up(one, point)
            for one in self.experiments
            for point in one.points
            for block in range(self.given[one.name].blocks)
        )

    def control_due(self, control: Experiment) -> int:
        """How many of the control's blocks should be done by now: spread evenly over the study's time."""
        status = self.status()
        share = status.seconds_done / max(status.seconds_done + status.seconds_left, 1e-9)
        return math.ceil(self.given[control.name].blocks * share)

    def _load(self, experiment: Experiment, once: float, *, stopped: bool) -> Load:
        seconds = {point.id: self._costs.point(point) for point in experiment.points}
        minimum = self.given[experiment.name].blocks
        wanted = minimum if stopped else max(minimum, experiment.question.blocks.wanted)
        done = sum(seconds[point] for point, block in self._found[experiment.name].seconds if block < minimum)
        return Load(experiment.name, sum(seconds.values()), once - done, minimum, wanted)

    def _once_seconds(self) -> dict[str, float]:
        """What each experiment that is not complete still costs once: its scenes and checks.

        What several need is counted for the first of them only.
        """
        seconds = dict.fromkeys((one.name for one in self.experiments), 0.0)
        counted: set[object] = set()
        for one in self.experiments:
            if self.is_complete(one):
                continue
            measured = {point for point, _ in self._found[one.name].seconds}
            for point, key, cost in self._once_each[one.name]:
                if key not in counted and point not in measured:
                    seconds[one.name] += cost
                counted.add(key)
        return seconds

    def _all_missing(self) -> list[Point]:
        return [
            point
            for one in self.experiments
            for block in range(self.given[one.name].blocks)
            for _, point in self.missing(one, block)
        ]


def _once_each(experiment: Experiment, costs: Costs) -> list[tuple[str, object, float]]:
    """What an experiment costs once: the id of the point that needs it, what it is, and its seconds."""
    return [
        (point.id, key, seconds)
        for point in experiment.points
        for first in [representative(experiment, point)]
        for key, seconds in (
            (f"besides {experiment.name} {point.id}", costs.besides(point)),
            (point.scene, costs.scene(point.scene)),
            ((point.program.sha256, point.variant, first.scene), costs.check(first)),
        )
    ]


def split(experiments: Sequence[Experiment]) -> tuple[list[Experiment], Experiment | None]:
    """The questions proper, and the control."""
    others = [experiment for experiment in experiments if experiment.name != CONTROL]
    return others, next((experiment for experiment in experiments if experiment.name == CONTROL), None)
