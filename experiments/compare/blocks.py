"""Block after block of an experiment, and what the records say of each command."""

import ctypes
import os
import random
import statistics
import time
from collections.abc import Mapping
from dataclasses import dataclass, field

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Store
from experiments.run.runner import Runner, Task
from experiments.run.together import together
from support.files import read_json

PADDING = "CAROM_PADDING"
MOST_PADDING = 4096
"""The longest value of the variable that changes where a process finds its stack: a page."""

_NO_RANDOM_ADDRESSES = 0x0040000


@dataclass
class Runs:
    """What was measured of one command, a value a block: seconds, processors busy, and bytes at the most."""

    seconds: list[float] = field(default_factory=list)
    cores: list[float] = field(default_factory=list)
    bytes: list[float] = field(default_factory=list)
    memory: str = ""
    """Of what the bytes are the peak, or what is known without them."""
    reason: str = ""
    """Why it failed, if it did."""
    undisturbed: str = ""
    """Why it was not stopped while others ran."""

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

    def __init__(self, experiment: Experiment, store: Store, runner: Runner) -> None:
        self._experiment = experiment
        self._store = store
        self._runner = runner
        self._random = random.Random(experiment.order_seed)
        self.done = 0
        self.began = time.monotonic()
        self.runs: dict[Key, Runs] = {key_of(point): Runs() for point in experiment.points}

    def begin(self) -> None:
        """Let the time count from here."""
        self.began = time.monotonic()

    @property
    def seconds(self) -> float:
        """Since the first block began."""
        return time.monotonic() - self.began

    @property
    def failed(self) -> Mapping[Key, str]:
        """What failed, with its reason."""
        return {key: one.reason for key, one in self.runs.items() if one.reason}

    def run(self, *, vary_layout: bool) -> bool:
        """Run a block; returns whether all of it succeeded."""
        if vary_layout:
            os.environ[PADDING] = "x" * self._random.randrange(MOST_PADDING)
        block, size = self.done, len(self._experiment.points)
        order = list(enumerate(self._experiment.block(block)))
        for group in together(self._experiment, block, order):
            tasks = [Task(self._experiment, point, block, at, block + 1, size) for at, point in group]
            for task, outcome in zip(tasks, self._runner.run(tasks), strict=True):
                if outcome.seconds is None:
                    self.runs[key_of(task.point)].reason = outcome.reason
                else:
                    self._take_in(task)
        self.done += not self.failed
        return not self.failed

    def _take_in(self, task: Task) -> None:
        record = read_json(self._store.record_path(task.point, task.block))
        runs, process = self.runs[key_of(task.point)], record["process"]
        runs.seconds.append(statistics.median(one["steps_seconds"] for one in record["repetitions"]))
        busy = process["user_seconds"] + process["system_seconds"]
        runs.cores.append(busy / max(process["wall_seconds"], 1e-9))
        if process["peak_memory_bytes"] is not None:
            runs.bytes.append(process["peak_memory_bytes"])
        runs.memory = process["peak_memory_reason"]
        runs.undisturbed = process["undisturbed"] or runs.undisturbed


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
