"""Block after block of an experiment, and what the records say of each command."""

import ctypes
import itertools
import os
import random
import statistics
import time
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from experiments.compare.others import Others
from experiments.compare.question import in_options
from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.record import Record, is_failed, unusable
from experiments.results.store import Store
from experiments.run.host_lock import WAITS
from experiments.run.processes import HINDERED_SECONDS
from experiments.run.runner import Runner
from experiments.run.schedule import FIRST_LOOK
from experiments.run.task import Task
from experiments.run.together import together
from support.files import read_json
from support.vocabulary import AGAIN

PADDING = "CAROM_PADDING"
MOST_PADDING = 4096
"""The longest value of the variable that changes where a process finds its stack: a page."""

_WAITS = "voluntary_context_switches"

CONTROL_EACH = 4
"""After the first look the reference runs under its second name in every block of so many: what it is for, an
effect that turns have on equal programs, is there in all blocks alike."""

_BESIDES = 1.5
"""How much longer a block takes than its runs, about."""

_NO_RANDOM_ADDRESSES = 0x0040000


@dataclass
class Runs:
    """What was measured of one command, a value a block: seconds, processors busy, and bytes at the most."""

    blocks: list[int] = field(default_factory=list)
    """The number of each block."""
    seconds: list[float] = field(default_factory=list)
    cores: list[float] = field(default_factory=list)
    bytes: list[float] = field(default_factory=list)
    counts: dict[str, list[float]] = field(default_factory=dict)
    """What was counted of a run, by name: page faults, context switches, and what the machine counts."""
    memory: str = ""
    """Of what the bytes are the peak, or what is known without them."""
    reason: str = ""
    """Why it failed, if it did."""
    undisturbed: str = ""
    """Why it was not stopped while others ran."""
    all: list[float] = field(default_factory=list)
    """The seconds of every run."""
    codes: Counter[int] = field(default_factory=Counter)
    """How many runs ended with each exit code."""
    output: str = ""
    """The end of what it printed."""
    error: str = ""
    """The last line that it wrote into its standard error."""
    left_behind: list[float] = field(default_factory=list)
    """Of each block the share of its time that went on after the command had ended."""
    knows_waiting: bool = True
    """Whether the system told of each run how long it waited for a processor."""
    tries: int = 0
    """How many runs ended well, those included that no longer count."""

    def median(self, name: str) -> float:
        """The middle of one of the lists."""
        return statistics.median(getattr(self, name))


Key = tuple[str, int]
"""The name of a command, and the number of a case of a Google Benchmark, 0 where whole commands are run."""


def key_of(point: Point) -> Key:
    """Whose run it is."""
    return point.series, int(point.x)


class Blocks:
    """Runs one block after the other; `runs` holds what came of each command, or of each case of it."""

    def __init__(self, experiment: Experiment, store: Store, runner: Runner, *, has_cases: bool) -> None:
        self.has_cases = has_cases
        self._store = store
        self._runner = runner
        self._slice_seconds = runner.slice_seconds
        self.began = time.monotonic()
        self.others = Others()
        self._plan(experiment)

    def _plan(self, experiment: Experiment) -> None:
        self.experiment = experiment
        self.done = 0
        self._took: list[float] = []
        """Seconds of each block of this call."""
        self._ran = 0.0
        """Seconds that the runs of its first block took together."""
        self.before = 0
        """Blocks that an earlier call measured."""
        self.runs: dict[Key, Runs] = {key_of(point): Runs() for point in experiment.points}

    def begin(self) -> None:
        """Let the time count from here."""
        self.began = time.monotonic() - WAITS.seconds

    def again(self, experiment: Experiment) -> None:
        """Begin again with another experiment, as if nothing had been run but what failed."""
        for path in self._store.files(self.experiment.name, 0):
            path.unlink()
        before = self.runs
        self._plan(experiment)
        for key, one in before.items():
            if one.reason:
                self.runs[key] = one
            elif key in self.runs:
                self.runs[key].tries = one.tries

    def leave_out(self, names: Collection[str]) -> None:
        """Go on without commands that failed, or the numbers of cases where one did; what was measured of
        them stays.
        """
        points = tuple(
            point
            for point in self.experiment.points
            if not {point.series, str(int(point.x)) if self.has_cases else ""} & {*names}
        )
        self.experiment = replace(self.experiment, points=points)

    def take_up(self, records: Sequence[Record]) -> str:
        """Count what an earlier call measured; returns why it cannot be counted, and then counts nothing."""
        points = {point.id: point for point in self.experiment.points}
        of_block: dict[int, set[str]] = {}
        for record in records:
            for one in record["contenders"]:
                point, block = points.get(str(one["tags"].get("point"))), int(one["tags"].get("block", -1))
                wrong = (
                    "other commands or options, or changed programs"
                    if point is None
                    else unusable(record, one, point, block)
                )
                if point is None or wrong is not None:
                    return str(wrong)
                of_block.setdefault(block, set()).add(point.id)
        whole = next(
            block
            for block in itertools.count()
            if of_block.get(block) != {one.id for one in self._points(block)}
        )
        for record in records:
            if record["contenders"][0]["tags"]["block"] < whole:
                self._store.keep(record)
        for block in range(whole):
            self._take_in(block)
        self.done = self.before = whole
        self._ran = 0.0
        return ""

    @property
    def records(self) -> list[Record]:
        """All records of whole blocks, of what is still compared."""
        return [
            record | {"contenders": contenders}
            for block in range(self.done)
            for record, contenders in self._measured(block)
        ]

    def _measured(self, block: int) -> Iterator[tuple[Record, list[Record]]]:
        """The records of a block, and what was measured in each of what is still compared."""
        ids = {point.id for point in self._points(block)}
        for path in self._store.files(self.experiment.name, block):
            record = read_json(path)
            own = [one for one in record["contenders"] if one["tags"]["point"] in ids and not is_failed(one)]
            if own:
                yield record, own

    def _points(self, block: int) -> tuple[Point, ...]:
        """What a block runs."""
        has_control = block < FIRST_LOOK or block % CONTROL_EACH == 0
        points = self.experiment.points
        return points if has_control else tuple(one for one in points if not one.series.endswith(AGAIN))

    @property
    def seconds(self) -> float:
        """Since the first block began, but for waiting for other measurements."""
        return time.monotonic() - self.began - WAITS.seconds

    @property
    def seconds_each(self) -> float:
        """What a block of this call took. The first one does more: it finds out who minds being stopped. What
        comes before and after each run is there in every block.
        """
        commands = [one.command for one in self.experiment.points if one.command is not None]
        has_more = self.experiment.question.warm_up or any(one.prepare or one.conclude for one in commands)
        if len(self._took) == 1 and self._ran and not (has_more or self.has_cases):
            return min(self._took[0], _BESIDES * self._ran)
        return statistics.median(self._took[1:] or self._took or [0.0])

    @property
    def failed(self) -> Mapping[Key, str]:
        """What failed, with its reason."""
        return {key: one.reason for key, one in self.runs.items() if one.reason}

    def run(self, *, vary_layout: bool) -> bool:
        """Run a block; returns whether nothing of it failed that had not failed before."""
        began = self.seconds
        is_whole = self._run(vary_layout=vary_layout)
        self._took.append(self.seconds - began)
        return is_whole

    def _run(self, *, vary_layout: bool) -> bool:
        block, failed = self.done, len(self.failed)
        there = self._points(block)
        is_hindered = self._slice_seconds is None and self.others.are_in_the_way
        self._runner.slice_seconds = HINDERED_SECONDS if is_hindered else self._slice_seconds
        if vary_layout:
            padding = random.Random(f"{self.experiment.order_seed} {block}").randrange(MOST_PADDING)
            os.environ[PADDING] = "x" * padding
        order = list(enumerate(one for one in self.experiment.block(block) if one in there))
        for group in together(self.experiment, block, order):
            tasks = [Task(self.experiment, point, block, at, block + 1, len(there)) for at, point in group]
            with self.others.watching():
                outcomes = self._runner.run(tasks)
            for task, outcome in zip(tasks, outcomes, strict=True):
                if outcome.seconds is None:
                    self.runs[key_of(task.point)].reason = in_options(outcome.reason)
        self._take_in(block)
        is_whole = len(self.failed) == failed
        self.done += is_whole
        return is_whole

    def _take_in(self, block: int) -> None:
        points = {point.id: point for point in self._points(block)}
        for _, contenders in self._measured(block):
            for one in contenders:
                self._take_in_one(self.runs[key_of(points[one["tags"]["point"]])], one, block)

    def _take_in_one(self, runs: Runs, one: Record, block: int) -> None:
        process = one["process"]
        taken = [run["steps_seconds"] for run in one["repetitions"]]
        runs.blocks.append(block)
        runs.seconds.append(statistics.median(taken))
        runs.all += taken
        self._ran += sum(taken) if not self._took else 0.0
        runs.codes.update(process.get("exit_codes") or [process["exit_code"]])
        runs.tries += len(taken)
        runs.output, runs.error = (process.get(key) or "" for key in ("output_end", "error_end"))
        left_behind = process.get("seconds_left_behind", 0.0) / max(process["wall_seconds"], 1e-9)
        runs.left_behind.append(min(left_behind, 1.0))  # it passes also while the command stands still
        busy = process["user_seconds"] + process["system_seconds"]
        runs.cores.append(busy / max(process["wall_seconds"], 1e-9))
        if process["peak_memory_bytes"] is not None:
            runs.bytes.append(process["peak_memory_bytes"])
        runs.knows_waiting &= all(run.get("waited_seconds") is not None for run in one["repetitions"])
        stops = len((one["slices"] or {}).get("seconds", ())) / len(taken)
        for name, amount in process.get("counted", {}).items():
            if amount is not None:
                # Each stop is a wait that is none of the command's own.
                own = max(0.0, amount - stops) if name == _WAITS else amount
                runs.counts.setdefault(name, []).append(own)
        runs.memory = process["peak_memory_reason"]
        runs.undisturbed = process["undisturbed"] or runs.undisturbed
        if len(runs.codes) > 1:
            runs.reason = (
                f"found runs that ended unlike ({codes_said(runs.codes)}): their times are not of one kind"
            )


def codes_said(codes: Mapping[int, int]) -> str:
    """How many runs ended with each exit code."""
    return ", ".join(f"{number} with exit code {code}" for code, number in sorted(codes.items()))


def keep_addresses() -> None:
    """Let all that is started from here on find the same addresses in each run, as far as the system lets
    it (personality(2)).
    """
    libc = ctypes.CDLL(None)
    libc.personality(libc.personality(0xFFFFFFFF) | _NO_RANDOM_ADDRESSES)


def shell_seconds(times: int = 15) -> float:
    """What the start of a shell takes, the middle of some."""
    taken: list[float] = []
    for _ in range(times):
        began = time.perf_counter()
        os.waitpid(os.posix_spawnp("sh", ["sh", "-c", ":"], os.environ), 0)
        taken.append(time.perf_counter() - began)
    return statistics.median(taken)
