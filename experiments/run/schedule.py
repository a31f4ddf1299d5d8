"""How many blocks each experiment has, what is still to be run, and what that costs."""

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property

from experiments.plan.claims import published_claims
from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Found, Store
from experiments.run.costs import Costs
from experiments.run.missing import missing
from experiments.run.next_blocks import Waiting
from experiments.run.progress import Status
from experiments.run.runner import ProcessResult
from experiments.run.task import Task
from experiments.run.together import Position, together
from experiments.run.verdicts import Verdicts
from support.vocabulary import CONTROL, PLAN

FIRST_LOOK = 6
"""Blocks of the first planned look (analysis/statistics/looks.py)."""

BESIDES = 2.0
"""About how many times as long as a process what it does but once takes. It counts until it was measured."""

DECIDING = ("comparison", "schedule", CONTROL)
"""Kinds of questions that have verdicts, also where no claim is about them."""


class Part:
    """One experiment of a study: the blocks that it is to have, what its records hold, what it still costs.

    It begins with its least number of blocks, or with what is there. The number grows.
    """

    def __init__(self, experiment: Experiment, store: Store, found: Found, costs: Costs) -> None:
        self.experiment = experiment
        self.name = experiment.name
        self.asked = experiment.question.blocks
        self.found = found
        self._store = store
        self._costs = costs
        self._given_up: set[str] = set()
        self.blocks = max([self.asked.minimum, *(block + 1 for _, block in found.seconds)])

    def forget(self) -> None:
        """Let what follows from records and costs be worked out anew."""
        for name in ("lacking", "_seconds_by_point", "status"):
            vars(self).pop(name, None)

    def give_up(self, points: Iterable[str]) -> None:
        """Try these points no further."""
        self._given_up.update(points)
        self.forget()

    @cached_property
    def lacking(self) -> dict[int, list[Position]]:
        """The blocks in which something is still to be run, and what, in the block's order."""
        about = self.experiment, self.found
        there = {one: missing(*about, one, self._store.session, self._given_up) for one in range(self.blocks)}
        return {block: positions for block, positions in there.items() if positions}

    @property
    def next(self) -> int | None:
        """The first block in which something is still to be run."""
        return next(iter(self.lacking), None)

    @property
    def left(self) -> list[Point]:
        """The points of all processes that are still to be run."""
        return [point for positions in self.lacking.values() for _, point in positions]

    @property
    def planned(self) -> int:
        """How many points there are in all blocks together."""
        return self.blocks * len(self.experiment.points)

    @property
    def is_complete(self) -> bool:
        """Whether nothing of it is still to be run."""
        return not self.lacking

    def give(self, blocks: int) -> None:
        """Give it so many blocks; it loses none."""
        self.blocks = max(self.blocks, blocks)
        self.forget()

    def begin(self) -> None:
        """Write down how many blocks it gets for certain from now on, and how many runs there are once it has
        them.
        """
        entry = {
            "blocks": self.blocks,
            "runs": self.planned,
            "order_seed": self.experiment.order_seed,
            "points": [point.id for point in self.experiment.points],
        }
        plan = self._store.note(PLAN) or {}
        of_scale = plan.setdefault(self.experiment.points[0].scale, {})
        if of_scale.get(self.name) != entry:
            of_scale[self.name] = entry
            self._store.keep_note(PLAN, plan)

    def clear(self, block: int) -> None:
        """Move what is to be measured anew in a block out of the way."""
        self._store.clear(self.found, [(point.id, block) for _, point in self.lacking.get(block, ())])

    def waiting(self, verdicts: Verdicts) -> Waiting | None:
        """What it lacks to its next look, where something in it is open. Who has its blocks waits for the
        others that a claim rests on.

        What was spent on it since its least blocks counts as well: an effect near a border always seems a few
        blocks from being settled.
        """
        found = verdicts.open.get(self.name)
        if found is None or self._given_up or self.name == CONTROL:
            return None
        lacking = len(self.lacking) + max(0, found.next - self.blocks)
        each, spent = self.seconds_each, found.needed - self.asked.minimum
        return Waiting(self.name, lacking, each, each * spent, found.blocks < FIRST_LOOK) if lacking else None

    @property
    def growth(self) -> int:
        """The blocks by which it may grow at a time: two, since an even number is balanced in position
        exactly, or what it lacks to what it wants.
        """
        return max(0, min(2, self.asked.wanted - self.blocks))

    @property
    def share(self) -> float:
        """How far it is between the least that it needs and what it wants."""
        return (self.blocks - self.asked.minimum) / max(1, self.asked.wanted - self.asked.minimum)

    @cached_property
    def _seconds_by_point(self) -> dict[str, float]:
        """What a process of each point takes, with the runs that it would make now."""
        # A later block: what the first one does besides keeps points out of turns.
        groups = together(self.experiment, 1, list(enumerate(self.experiment.points)))
        runs = {
            point.id: self._costs.runs([point for _, point in group])
            for group in groups
            if len(group) > 1
            for _, point in group
        }
        return {one.id: self._costs.point(one, runs.get(one.id)) for one in self.experiment.points}

    @property
    def seconds_each(self) -> float:
        """About what a block of it takes."""
        return sum(self._seconds_by_point.values())

    def seconds_of(self, blocks: int) -> float:
        """About what it takes until it has so many blocks, checks included."""
        done = len(self.found.seconds) / max(1, len(self.experiment.points))
        return self._seconds_once + max(0.0, blocks - done) * self.seconds_each

    @property
    def _seconds_once(self) -> float:
        """What the first process of each point that has none takes besides: checks, errors, counts."""
        measured = {point for point, _ in self.found.seconds}
        each = self._seconds_by_point.items()
        return BESIDES * sum(seconds for point, seconds in each if point not in measured)

    @cached_property
    def status(self) -> Status:
        """How far it is; what is left counts checks."""
        again = {(point.id, block) for block, positions in self.lacking.items() for _, point in positions}
        done = self.found.seconds.keys() - again
        left = sum(self._seconds_by_point[point] for point, _ in again)
        return Status(
            self.planned,
            len(done),
            sum(self.found.seconds[key] for key in done),
            left + (0.0 if self.is_complete else self._seconds_once),
        )


class Schedule:
    """The parts of a study, by the names of their experiments."""

    def __init__(self, parts: Sequence[Part], costs: Costs) -> None:
        self.parts = {one.name: one for one in parts}
        self.costs = costs

    def finish(self, tasks: Sequence[Task], ended: Sequence[ProcessResult], seconds: float) -> None:
        """A process ended, measured in so many seconds, its checks and the like included."""
        self.costs.learn([task.point for task in tasks], ended, seconds)
        failed = [task.point.id for task, one in zip(tasks, ended, strict=True) if one.seconds is None]
        self.parts[tasks[0].experiment.name].give_up(failed)
        for one in self.parts.values():
            if not one.found.seconds:
                one.forget()  # what others took is all that is known of its costs

    def waiting(self, verdicts: Verdicts) -> Iterator[Waiting]:
        """What is open and may be measured on."""
        return (found for one in self.parts.values() if (found := one.waiting(verdicts)) is not None)

    def status(self) -> Status:
        """How far the study is."""
        parts = [one.status for one in self.parts.values()]
        return Status(
            planned=sum(one.planned for one in parts),
            done=sum(one.done for one in parts),
            seconds_done=sum(one.seconds_done for one in parts),
            seconds_left=sum(one.seconds_left for one in parts),
        )


def may_decide(experiment: Experiment, scale: str) -> bool:
    """Whether a claim, or a verdict on a difference, may come of it at that scale."""
    claim = experiment.question.claim
    if scale not in published_claims().get(str(claim), {scale}):
        return False
    return claim is not None or experiment.question.kind in DECIDING
