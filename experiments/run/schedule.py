"""How many blocks each experiment gets, what is still to be run, and when the control's blocks are due."""

import math
from collections.abc import Mapping, Sequence

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.plan.question import CONTROL
from experiments.results.store import Found, Store
from experiments.run.budget import Load, allocate
from experiments.run.costs import Costs
from experiments.run.progress import Status
from experiments.run.verify import representative

PLAN = "plan.json"


class Schedule:
    """The number of blocks of each experiment, decided when its first block begins and kept from then on."""

    def __init__(
        self,
        store: Store,
        experiments: Sequence[Experiment],
        found: Mapping[str, Found],
        costs: Costs,
        figure_seconds: float,
        *,
        more: bool = False,
    ) -> None:
        """With `more`, what an earlier session decided is the least: the budget may give further blocks."""
        self.experiments = tuple(experiments)
        self.figure_seconds = figure_seconds
        self._store = store
        self._found = found
        self._costs = costs
        self._once_each = {one.name: _once_each(one, costs) for one in experiments}
        self._given_up: set[tuple[str, str]] = set()
        self._decided = decided_blocks(store, experiments, found)
        self._growing = set(self._decided) if more else set()
        self.blocks = {one.name: one.question.blocks.minimum for one in experiments} | self._decided

    def decide(self, seconds_left: float) -> None:
        """Share what is left of the budget among the experiments; those already begun keep what they have."""
        once = self._once_seconds()
        loads = [self._load(experiment, once[experiment.name]) for experiment in self.experiments]
        self.blocks = allocate(loads, seconds_left)

    def begin(self, experiment: Experiment) -> int:
        """The experiment's number of blocks, fixed and written down."""
        blocks = self._decided[experiment.name] = self.blocks[experiment.name]
        self._growing.discard(experiment.name)
        plan = self._store.note(PLAN) or {}
        entry = {
            "blocks": blocks,
            "order_seed": experiment.order_seed,
            "points": [point.id for point in experiment.points],
        }
        of_scale = plan.setdefault(experiment.points[0].scale, {})
        if of_scale.get(experiment.name) != entry:
            of_scale[experiment.name] = entry
            self._store.keep_note(PLAN, plan)
        return blocks

    def promised(self, experiment: Experiment) -> int:
        """The blocks that the experiment gets for certain: those decided, until then the least."""
        return self._decided.get(experiment.name, experiment.question.blocks.minimum)

    def missing(self, experiment: Experiment, block: int) -> list[tuple[int, Point]]:
        """Position and point of what is still to be run in one block, in the block's order."""
        seconds = self._found[experiment.name].seconds
        return [
            (position, point)
            for position, point in enumerate(experiment.block(block))
            if (point.id, block) not in seconds and (experiment.name, point.id) not in self._given_up
        ]

    def is_complete(self, experiment: Experiment) -> bool:
        """Whether nothing of it is still to be run."""
        return not any(self.missing(experiment, block) for block in range(self.blocks[experiment.name]))

    def finish(self, experiment: Experiment, point: Point, block: int, seconds: float | None) -> None:
        """A process ended after so many seconds; None if it failed, and then its point is not tried again."""
        if seconds is None:
            self._given_up.add((experiment.name, point.id))
            return
        self._found[experiment.name].seconds[point.id, block] = seconds
        self._costs.learn(point, seconds)

    def status(self) -> Status:
        """How far the study is; what is left counts scenes, checks and figures too."""
        missing = self._all_missing()
        planned = sum(len(one.points) * self.blocks[one.name] for one in self.experiments)
        return Status(
            planned=planned,
            done=planned - len(missing) - self._without_hope(),
            seconds_done=sum(sum(found.seconds.values()) for found in self._found.values()),
            seconds_left=sum(self._once_seconds().values()) + sum(map(self._costs.point, missing)),
        )

    def _without_hope(self) -> int:
        """How many processes of points that failed will not be run."""
        return sum(
            (point.id, block) not in self._found[one.name].seconds and (one.name, point.id) in self._given_up
            for one in self.experiments
            for point in one.points
            for block in range(self.blocks[one.name])
        )

    def control_due(self, control: Experiment) -> int:
        """How many of the control's blocks should be done by now: spread evenly over the study's time."""
        status = self.status()
        share = status.seconds_done / max(status.seconds_done + status.seconds_left, 1e-9)
        return math.ceil(self.blocks[control.name] * share)

    def _load(self, experiment: Experiment, once: float) -> Load:
        seconds = {point.id: self._costs.point(point) for point in experiment.points}
        limits = experiment.question.blocks
        minimum = self._decided.get(experiment.name, limits.minimum)
        is_fixed = experiment.name in self._decided and experiment.name not in self._growing
        wanted = minimum if is_fixed else limits.wanted
        done = sum(seconds[point] for point, block in self._found[experiment.name].seconds if block < minimum)
        return Load(experiment.name, sum(seconds.values()), once - done, minimum, wanted)

    def _once_seconds(self) -> dict[str, float]:
        """What each experiment that is not complete still costs once: its figure, scenes and checks.

        What several need is counted for the first of them only.
        """
        seconds = dict.fromkeys((one.name for one in self.experiments), 0.0)
        counted: set[object] = set()
        for one in self.experiments:
            if self.is_complete(one):
                continue
            seconds[one.name] = self.figure_seconds
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
            for block in range(self.blocks[one.name])
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


def decided_blocks(
    store: Store, experiments: Sequence[Experiment], found: Mapping[str, Found]
) -> dict[str, int]:
    """The number of blocks that an earlier session gave to the experiments that it began.

    A question that now asks for more, or for fewer, has changed and is decided anew.
    """
    plan = store.note(PLAN) or {}
    decided = {}
    for experiment in experiments:
        kept = plan.get(experiment.points[0].scale, {}).get(experiment.name)
        limits = experiment.question.blocks
        if kept and found[experiment.name].seconds and limits.minimum <= kept["blocks"] <= limits.wanted:
            decided[experiment.name] = int(kept["blocks"])
    return decided


def split(experiments: Sequence[Experiment]) -> tuple[list[Experiment], Experiment | None]:
    """The questions proper, and the control."""
    others = [experiment for experiment in experiments if experiment.name != CONTROL]
    return others, next((experiment for experiment in experiments if experiment.name == CONTROL), None)
