"""How many blocks each experiment has, what is still to be run, and who gets the next ones."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence

from experiments.plan.kinds import COUNTS
from experiments.plan.plan import Experiment
from experiments.plan.point import PROCESS, Point
from experiments.plan.question import CONTROL
from experiments.results.store import Found, Store
from experiments.run.budget import Load, allocate
from experiments.run.costs import Costs
from experiments.run.given import Given, given_before, keep
from experiments.run.next_blocks import Waiting
from experiments.run.progress import Status
from experiments.run.repeats import choose_runs, spread
from experiments.run.runner import Outcome
from experiments.run.together import together
from experiments.run.verdicts import Open, Verdicts
from experiments.run.verify import representative
from experiments.run.whole_blocks import WholeBlocks


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
        self._laid_out: dict[str, WholeBlocks] = {}
        self._runs: dict[str, dict[str, int]] = {}
        self._statuses: dict[str, tuple[WholeBlocks, Status]] = {}

    def blocks_of(self, experiment: Experiment) -> WholeBlocks:
        """Its blocks, as its records stand now."""
        name = experiment.name
        if name not in self._laid_out:
            given_up = {point for one, point in self._given_up if one == name}
            self._laid_out[name] = WholeBlocks(
                experiment, self.given[name], self._found[name], self._store.session, given_up
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

    def share(self, seconds_left: float, settled: Collection[str] = ()) -> None:
        """Share the time left among the experiments but those settled; none loses a block it was given."""
        once = self._once_seconds()
        loads = [self._load(one, once[one.name], enough=one.name in settled) for one in self.experiments]
        for name, blocks in allocate(loads, seconds_left).items():
            self.given[name].blocks = blocks
        self._laid_out.clear()

    def give(self, experiment: Experiment, found: Open) -> None:
        """Give an experiment the blocks up to its next look."""
        given = self.given[experiment.name]
        given.blocks = max(given.blocks, found.next)
        self._laid_out.pop(experiment.name, None)

    def waiting(self, verdicts: Verdicts) -> Iterator[Waiting]:
        """What is open and may be measured on. Who has its blocks waits for the others that a claim rests on.

        What was spent on it since its least blocks counts as well: an effect near a border always seems a few
        blocks from being settled.
        """
        for one in self.experiments:
            found = verdicts.open.get(one.name)
            if found is None or any(self._is_given_up(one, point) for point in one.points):
                continue
            lacking = found.next - self.given[one.name].blocks
            if lacking <= 0 and self.is_complete(one):
                continue
            block = self.block_seconds(one)
            spent = found.needed - one.question.blocks.minimum
            yield Waiting(one.name, max(1, lacking), block, block * spent)

    def block_seconds(self, experiment: Experiment) -> float:
        """What a block of an experiment takes, with the runs that its processes would make now."""
        return sum(self._process_seconds(experiment, point) for point in experiment.points)

    def runs(self, experiment: Experiment, group: Sequence[Point]) -> int:
        """How many timed runs a process of these points makes, by what is known of their times so far."""
        if len(group) < 2 or group[0].verb == PROCESS or group[0].kind == COUNTS:
            return 1
        found = self._found[experiment.name].runs
        processes = []
        for block in range(1 + max((at for _, at in found), default=-1)):
            process = [found.get((point.id, block), ()) for point in group]
            if all(process):
                processes.append(process)
        fixed, run = (sum(map(cost, group)) for cost in (self._costs.fixed, self._costs.run))
        last = len(processes[-1][0]) if processes else 0
        return choose_runs(fixed, run, spread(processes), last)

    def _process_seconds(self, experiment: Experiment, point: Point) -> float:
        if experiment.name not in self._runs:
            # A later block: what the first one does besides keeps points out of turns.
            groups = together(experiment, 1, list(enumerate(experiment.points)))
            self._runs[experiment.name] = {
                point.id: self.runs(experiment, points)
                for points in ([one for _, one in group] for group in groups if len(group) > 1)
                for point in points
            }
        return self._costs.point(point, self._runs[experiment.name].get(point.id))

    def _is_given_up(self, experiment: Experiment, point: Point) -> bool:
        return (experiment.name, point.id) in self._given_up

    def begin(self, experiment: Experiment) -> None:
        """Write down the experiment's number of blocks, which it gets for certain from now on."""
        given = self._begun[experiment.name] = self.given[experiment.name]
        seconds = self._found[experiment.name].seconds
        lacking = sum(key not in seconds for key in self.blocks_of(experiment).keys)
        keep(self._store, experiment, given, len(seconds) + lacking)

    def promised(self, experiment: Experiment) -> int:
        """The blocks that the experiment gets for certain: those decided, until then the least."""
        begun = self._begun.get(experiment.name)
        return begun.blocks if begun else experiment.question.blocks.minimum

    def left(self, experiment: Experiment) -> list[Point]:
        """The points of all processes that are still to be run."""
        blocks = self.blocks_of(experiment)
        return [point for block in range(blocks.end()) for _, point in blocks.missing(block)]

    def is_complete(self, experiment: Experiment) -> bool:
        """Whether nothing of it is still to be run."""
        blocks = self.blocks_of(experiment)
        return not any(blocks.missing(block) for block in range(blocks.end()))

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

    def finish(self, experiment: Experiment, point: Point, block: int, outcome: Outcome) -> None:
        """A process ended; if it failed, its point is not tried again."""
        self._laid_out.pop(experiment.name, None)
        self._runs.pop(experiment.name, None)
        if outcome.seconds is None:
            self._given_up.add((experiment.name, point.id))
            return
        found, key = self._found[experiment.name], (point.id, block)
        found.seconds[key], found.runs[key] = outcome.seconds, outcome.runs
        found.sessions[key] = self._store.session
        found.failures.pop(key, None)
        self._costs.learn(point, outcome.seconds, outcome.runs)

    def learn_beside(self, experiment: Experiment, seconds: float, outcomes: Sequence[Outcome]) -> None:
        """These were measured in so many seconds, their records' checks and the like included."""
        own = [one.seconds for one in outcomes if one.seconds is not None]
        if len(own) == len(outcomes):
            self._costs.learn_beside(experiment.name, max(0.0, seconds - sum(own)) / len(own))
            self._runs.pop(experiment.name, None)

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
        """The part of one experiment, worked out anew once it was given or has got more, and as long as what
        others took is all that is known of its costs.
        """
        blocks = self.blocks_of(experiment)
        known = self._statuses.get(experiment.name)
        found = self._found[experiment.name].seconds
        if known is None or known[0] is not blocks or not found:
            done = [seconds for key in blocks.keys if (seconds := found.get(key)) is not None]
            left = sum(self._process_seconds(experiment, point) for point in self.left(experiment))
            known = (blocks, Status(len(blocks.keys), len(done), sum(done), left))
            self._statuses[experiment.name] = known
        return known[1]

    def control_due(self, control: Experiment) -> int:
        """How many of the control's blocks should be done by now: spread evenly over the study's time."""
        status = self.status()
        share = status.seconds_done / max(status.seconds_done + status.seconds_left, 1e-9)
        return math.ceil(self.given[control.name].blocks * share)

    def _load(self, experiment: Experiment, once: float, *, enough: bool) -> Load:
        seconds = {point.id: self._process_seconds(experiment, point) for point in experiment.points}
        minimum = self.given[experiment.name].blocks
        wanted = minimum if enough else max(minimum, experiment.question.blocks.wanted)
        measured = self._found[experiment.name].seconds
        done = sum(seconds[key[0]] for key in self.blocks_of(experiment).keys if key in measured)
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
