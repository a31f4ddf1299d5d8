"""How many blocks each experiment has, what is still to be run, and who gets the next ones."""

from collections.abc import Collection, Iterator, Mapping, Sequence

from experiments.plan.claims import LARGE_SCALE_CLAIMS
from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Found, Store
from experiments.run.budget import Load, allocate
from experiments.run.costs import Costs
from experiments.run.given import given_before, keep
from experiments.run.next_blocks import Waiting
from experiments.run.progress import Status
from experiments.run.repeats import process_runs
from experiments.run.runner import ProcessResult, Task
from experiments.run.together import together
from experiments.run.verdicts import Open, Verdicts
from experiments.run.verify import representative
from experiments.run.whole_blocks import WholeBlocks
from support.vocabulary import CONTROL

FIRST_LOOK = 6
"""Blocks of the first planned look (analysis/statistics/looks.py)."""


DECIDING = ("comparison", "schedule", CONTROL)
"""Kinds of questions that have verdicts, also where no claim is about them."""


class Schedule:
    """The number of blocks of each experiment: it grows, and is written down before a block begins."""

    def __init__(
        self, store: Store, experiments: Sequence[Experiment], found: Mapping[str, Found], costs: Costs
    ) -> None:
        """An experiment begins with its least number of blocks, or with what an earlier session gave it."""
        self.experiments = tuple(experiments)
        self._store = store
        self._found = found
        self._costs = costs
        self._once_each = {one.name: _once_each(one, costs) for one in experiments}
        self._given_up: dict[str, set[str]] = {one.name: set() for one in experiments}
        before = given_before(store, experiments, found)
        self.given = {one.name: one.question.blocks.minimum for one in experiments} | before
        self._begun = set(before)
        # What follows from all this for one experiment, until something of it changes.
        self._laid_out: dict[str, WholeBlocks] = {}
        self._runs: dict[str, dict[str, int]] = {}
        self._statuses: dict[str, Status] = {}

    def _give(self, name: str, blocks: int) -> None:
        self.given[name] = blocks
        self._forget(name)

    def _forget(self, name: str) -> None:
        for known in (self._laid_out, self._runs, self._statuses):
            known.pop(name, None)

    def blocks_of(self, experiment: Experiment) -> WholeBlocks:
        """Its blocks, as its records stand now."""
        name = experiment.name
        if name not in self._laid_out:
            self._laid_out[name] = WholeBlocks(
                experiment, self.given[name], self._found[name], self._store.session, self._given_up[name]
            )
        return self._laid_out[name]

    def blocks(self, experiment: Experiment, most: int | None = None) -> Iterator[int]:
        """The numbers of its blocks in which something is missing, or of the first so many alone, each to be
        measured before the next one is asked for. They may grow more: what failed in an earlier session and
        now does not is measured again with all others.
        """
        block = self.blocks_of(experiment).following(-1, most)
        while block is not None:
            yield block
            block = self.blocks_of(experiment).following(block, most)

    def share_out_time(self, seconds_left: float, settled: Collection[str] = ()) -> None:
        """Share the time left among the experiments but those settled; none loses a block it was given."""
        once = self._once_seconds()
        loads = [self._load(one, once[one.name], enough=one.name in settled) for one in self.experiments]
        for name, blocks in allocate(loads, seconds_left).items():
            self._give(name, blocks)

    def give(self, experiment: Experiment, found: Open) -> None:
        """Give an experiment the blocks up to its next look."""
        self._give(experiment.name, max(self.given[experiment.name], found.next))

    def waiting(self, verdicts: Verdicts) -> Iterator[Waiting]:
        """What is open and may be measured on. Who has its blocks waits for the others that a claim rests on.

        What was spent on it since its least blocks counts as well: an effect near a border always seems a few
        blocks from being settled.
        """
        for one in self.experiments:
            found = verdicts.open.get(one.name)
            if found is None or self._given_up[one.name] or one.name == CONTROL:
                continue
            lacking = len(self.blocks_of(one).lacking) + max(0, found.next - self.given[one.name])
            if not lacking:
                continue
            block = sum(self._seconds_each(one).values())
            spent = found.needed - one.question.blocks.minimum
            is_first = found.blocks < FIRST_LOOK
            yield Waiting(one.name, lacking, block, block * spent, is_first)

    def runs(self, group: Sequence[Point]) -> int:
        """How many timed runs a process of these points makes, by what is known of their times so far."""
        return process_runs(group, self._costs)

    def _seconds_each(self, experiment: Experiment) -> dict[str, float]:
        """What a process of each point takes, with the runs that it would make now."""
        if experiment.name not in self._runs:
            # A later block: what the first one does besides keeps points out of turns.
            groups = together(experiment, 1, list(enumerate(experiment.points)))
            shared = [[point for _, point in group] for group in groups if len(group) > 1]
            self._runs[experiment.name] = {
                point.id: runs for points in shared for runs in [self.runs(points)] for point in points
            }
        runs_of = self._runs[experiment.name]
        return {point.id: self._costs.point(point, runs_of.get(point.id)) for point in experiment.points}

    def begin(self, experiment: Experiment) -> None:
        """Write down the experiment's number of blocks, which it gets for certain from now on."""
        self._begun.add(experiment.name)
        seconds = self._found[experiment.name].seconds
        lacking = sum(key not in seconds for key in self.blocks_of(experiment).keys)
        keep(self._store, experiment, self.given[experiment.name], len(seconds) + lacking)

    def promised(self, experiment: Experiment) -> int:
        """The blocks that the experiment gets for certain: those decided, until then the least."""
        is_decided = experiment.name in self._begun
        return self.given[experiment.name] if is_decided else experiment.question.blocks.minimum

    def left(self, experiment: Experiment) -> list[Point]:
        """The points of all processes that are still to be run."""
        lacking = self.blocks_of(experiment).lacking.values()
        return [point for missing in lacking for _, point in missing]

    def is_complete(self, experiment: Experiment) -> bool:
        """Whether nothing of it is still to be run."""
        return not self.blocks_of(experiment).lacking

    def measured_again(self) -> Iterator[str]:
        """Say of each experiment that has lost partners what is measured again with them."""
        for one in self.experiments:
            blocks = self.blocks_of(one)
            if not blocks.broken or self.is_complete(one):
                continue
            lost = f"without {', '.join(blocks.lost())}" if blocks.lost() else "not of one session"
            yield (
                f"{one.name}: {len(blocks.broken)} earlier blocks are {lost} (changed, failed or cut off); "
                "what lost its partner is measured again with it"
            )

    def finish(self, tasks: Sequence[Task], ended: Sequence[ProcessResult], seconds: float) -> None:
        """Processes of a block ended, measured in so many seconds, their records' checks and the like
        included. The point of one that failed is not tried again.
        """
        self._costs.learn_group([task.point for task in tasks], ended, seconds)
        for task, result in zip(tasks, ended, strict=True):
            found, key = self._found[task.experiment.name], (task.point.id, task.block)
            self._forget(task.experiment.name)
            if result.seconds is None:
                self._given_up[task.experiment.name].add(task.point.id)
                continue
            found.seconds[key], found.runs[key] = result.seconds, result.runs
            found.sessions[key] = self._store.session
            found.failures.pop(key, None)

    def status(self) -> Status:
        """How far the study is; what is left counts scenes and checks too. What stands without its partners
        is not part of it.
        """
        parts = [self._status_of(one) for one in self.experiments]
        return Status(
            planned=sum(one.planned for one in parts),
            done=sum(one.done for one in parts),
            seconds_done=sum(one.seconds_done for one in parts),
            seconds_left=sum(self._once_seconds().values()) + sum(one.seconds_left for one in parts),
        )

    def _status_of(self, experiment: Experiment) -> Status:
        """The part of one experiment, worked out anew as long as what others took is all that is known of its
        costs.
        """
        found = self._found[experiment.name].seconds
        if experiment.name not in self._statuses or not found:
            keys, cost = self.blocks_of(experiment).keys, self._seconds_each(experiment)
            done = [found[key] for key in keys if key in found]
            left = sum(cost[point.id] for point in self.left(experiment))
            self._statuses[experiment.name] = Status(len(keys), len(done), sum(done), left)
        return self._statuses[experiment.name]

    def has_begun(self, experiment: Experiment) -> bool:
        """Whether anything of it was measured."""
        return bool(self._found[experiment.name].seconds)

    def one_more(self, experiment: Experiment) -> None:
        """Give an experiment a block more."""
        self._give(experiment.name, self.given[experiment.name] + 1)

    def seconds_each(self, experiment: Experiment) -> float:
        """About what a block of it takes."""
        return sum(self._seconds_each(experiment).values())

    def seconds_of(self, experiment: Experiment, blocks: int) -> float:
        """About what it takes until it has so many blocks, scenes and checks included."""
        each = self.seconds_each(experiment)
        done = len(self._found[experiment.name].seconds) / max(1, len(experiment.points))
        return self._once_seconds()[experiment.name] + max(0.0, blocks - done) * each

    def least_seconds(self, experiment: Experiment) -> float:
        """About what an experiment takes until it has its least number of blocks."""
        return self._once_seconds()[experiment.name] + self._status_of(experiment).seconds_left

    def _load(self, experiment: Experiment, once: float, *, enough: bool) -> Load:
        seconds, found = self._seconds_each(experiment), self._found[experiment.name].seconds
        minimum = self.given[experiment.name]
        wanted = minimum if enough else max(minimum, experiment.question.blocks.wanted)
        done = sum(seconds[key[0]] for key in self.blocks_of(experiment).keys if key in found)
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


def may_decide(experiment: Experiment, scale: str) -> bool:
    """Whether a claim, or a verdict on a difference, may come of it at that scale."""
    claim = experiment.question.claim
    if claim in LARGE_SCALE_CLAIMS and scale == "quick":
        return False
    return claim is not None or experiment.question.kind in DECIDING


def _once_each(experiment: Experiment, costs: Costs) -> list[tuple[str, object, float]]:
    """What an experiment costs once: the id of the point that needs it, what it is, and its seconds."""
    return [
        (point.id, key, seconds)
        for point in experiment.points
        if point.program.sha256 is not None
        for first in [representative(experiment, point)]
        for key, seconds in (
            (f"besides {experiment.name} {point.id}", costs.besides(point)),
            (point.scene, costs.scene(point.scene)),
            ((point.program.sha256, point.variant, first.scene), costs.check(first)),
        )
    ]


def control_apart(experiments: Sequence[Experiment]) -> tuple[list[Experiment], Experiment | None]:
    """The questions proper, and the control."""
    others = [experiment for experiment in experiments if experiment.name != CONTROL]
    return others, next((experiment for experiment in experiments if experiment.name == CONTROL), None)
