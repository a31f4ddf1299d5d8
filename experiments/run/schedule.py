"""How many blocks each experiment has, what is still to be run, and what that costs."""

from collections.abc import Iterator, Sequence
from functools import cached_property

from experiments.plan.claims import published_claims
from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Found, Store
from experiments.run.costs import Costs
from experiments.run.next_blocks import Waiting
from experiments.run.progress import Status
from experiments.run.runner import ProcessResult, Task
from experiments.run.together import together
from experiments.run.verdicts import Verdicts
from experiments.run.whole_blocks import WholeBlocks
from support.vocabulary import CONTROL, PLAN

FIRST_LOOK = 6
"""Blocks of the first planned look (analysis/statistics/looks.py)."""

BESIDES = 2.0
"""About how many times as long as a process what it does but once takes. It counts until it was measured."""

DECIDING = ("comparison", "schedule", CONTROL)
"""Kinds of questions that have verdicts, also where no claim is about them."""


class Part:
    """One experiment of a study: the blocks that it was `given`, what its records hold, what it still costs.

    It begins with its least number of blocks, or with what an earlier session gave it. The number grows, and
    is written down before a block begins.
    """

    def __init__(self, experiment: Experiment, store: Store, found: Found, costs: Costs) -> None:
        self.experiment = experiment
        self.name = experiment.name
        self.asked = experiment.question.blocks
        self.found = found
        self._store = store
        self._costs = costs
        self._given_up: set[str] = set()
        kept = (store.note(PLAN) or {}).get(experiment.points[0].scale, {}).get(self.name)
        # A question that now asks for more blocks than it was given has changed, and is decided anew.
        self.is_begun = bool(kept and found.seconds and self.asked.minimum <= kept["blocks"])
        self.given = int(kept["blocks"]) if self.is_begun else self.asked.minimum

    def forget(self) -> None:
        """Let what follows from records and costs be worked out anew."""
        for name in ("blocks", "_seconds_by_point", "status"):
            vars(self).pop(name, None)

    @cached_property
    def blocks(self) -> WholeBlocks:
        """Its blocks, as its records stand now."""
        return WholeBlocks(self.experiment, self.given, self.found, self._store.session, self._given_up)

    @property
    def left(self) -> list[Point]:
        """The points of all processes that are still to be run."""
        return [point for missing in self.blocks.lacking.values() for _, point in missing]

    @property
    def is_complete(self) -> bool:
        """Whether nothing of it is still to be run."""
        return not self.blocks.lacking

    def give(self, blocks: int) -> None:
        """Give it so many blocks; it loses none."""
        self.given = max(self.given, blocks)
        self.forget()

    def begin(self) -> None:
        """Write down its number of blocks, which it gets for certain from now on, and how many runs there are
        once it has them.
        """
        self.is_begun = True
        runs = len({*self.found.seconds, *self.blocks.keys})
        entry = {
            "blocks": self.given,
            "runs": runs,
            "order_seed": self.experiment.order_seed,
            "points": [point.id for point in self.experiment.points],
        }
        plan = self._store.note(PLAN) or {}
        of_scale = plan.setdefault(self.experiment.points[0].scale, {})
        if of_scale.get(self.name) != entry:
            of_scale[self.name] = entry
            self._store.keep_note(PLAN, plan)

    def finish(self, tasks: Sequence[Task], ended: Sequence[ProcessResult]) -> None:
        """Processes of a block ended. The point of one that failed is not tried again."""
        for task, result in zip(tasks, ended, strict=True):
            key = (task.point.id, task.block)
            if result.seconds is None:
                self._given_up.add(task.point.id)
                continue
            self.found.take(key, result.seconds, result.runs, self._store.session)
        self.forget()

    def waiting(self, verdicts: Verdicts) -> Waiting | None:
        """What it lacks to its next look, where something in it is open. Who has its blocks waits for the
        others that a claim rests on.

        What was spent on it since its least blocks counts as well: an effect near a border always seems a few
        blocks from being settled.
        """
        found = verdicts.open.get(self.name)
        if found is None or self._given_up or self.name == CONTROL:
            return None
        lacking = len(self.blocks.lacking) + max(0, found.next - self.given)
        each, spent = self.seconds_each, found.needed - self.asked.minimum
        return Waiting(self.name, lacking, each, each * spent, found.blocks < FIRST_LOOK) if lacking else None

    @property
    def growth(self) -> int:
        """The blocks by which it may grow at a time: two, since an even number is balanced in position
        exactly, or what it lacks to what it wants.
        """
        return max(0, min(2, self.asked.wanted - self.given))

    @property
    def share(self) -> float:
        """How far it is between the least that it needs and what it wants."""
        return (self.given - self.asked.minimum) / max(1, self.asked.wanted - self.asked.minimum)

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
        """How far it is; what is left counts checks. What stands without its partners is no part of it."""
        keys, found = self.blocks.keys, self.found.seconds
        done = [found[key] for key in keys if key in found]
        left = sum(self._seconds_by_point[point.id] for point in self.left)
        return Status(
            len(keys), len(done), sum(done), left + (0.0 if self.is_complete else self._seconds_once)
        )

    def measured_again(self) -> str:
        """What is to be said where it has lost partners: what is measured again with them."""
        blocks = self.blocks
        if not blocks.broken or self.is_complete:
            return ""
        lost = f"without {', '.join(blocks.lost())}" if blocks.lost() else "not of one session"
        return (
            f"{self.name}: {len(blocks.broken)} earlier blocks are {lost} (changed, failed or cut off); "
            "what lost its partner is measured again with it"
        )


class Schedule:
    """The parts of a study, by the names of their experiments."""

    def __init__(self, parts: Sequence[Part], costs: Costs) -> None:
        self.parts = {one.name: one for one in parts}
        self.costs = costs

    def finish(self, tasks: Sequence[Task], ended: Sequence[ProcessResult], seconds: float) -> None:
        """Processes of a block ended, measured in so many seconds, their checks and the like included."""
        self.costs.learn([task.point for task in tasks], ended, seconds)
        self.parts[tasks[0].experiment.name].finish(tasks, ended)
        for one in self.parts.values():
            if not one.found.seconds:
                one.forget()  # what others took is all that is known of its costs

    def waiting(self, verdicts: Verdicts) -> Iterator[Waiting]:
        """What is open and may be measured on."""
        return (found for one in self.parts.values() if (found := one.waiting(verdicts)) is not None)

    def measured_again(self) -> Iterator[str]:
        """Say of each experiment that has lost partners what is measured again with them."""
        return filter(None, (one.measured_again() for one in self.parts.values()))

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
