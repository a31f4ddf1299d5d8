"""Slurm's own commands, each with a time limit: clients hang while the controller is away."""

import os
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from experiments.support import process
from experiments.support.process import TIMED_OUT, Completed
from support.errors import InputError

_AGAIN = "`carom study resume` tries again"

_FULL = re.compile(r"temporarily un|queue (is )?full", re.IGNORECASE)
_AWAY = re.compile(
    r"unable to contact|connection refused|timed out|zero bytes|communication connection|receive failure",
    re.IGNORECASE,
)
_POLICY = re.compile(r"\b(?:Assoc|QOS)\w*Limit\b")
"""Which limit it was, on a line of its own before the general one."""

TIME_LIMIT_SECONDS = 30.0
DEFAULT_MAX_ARRAY_SIZE = 1001
"""Slurm's own default."""

_WAITING = (
    *("PENDING", "REQUEUED", "REQUEUE_FED", "REQUEUE_HOLD", "RESV_DEL_HOLD", "SPECIAL_EXIT"),
    *("EXPEDITING", "LAUNCH_FAILED"),
)
_RUNNING = (
    *("RUNNING", "CONFIGURING", "SUSPENDED", "STOPPED", "SIGNALING", "RESIZING", "STAGE_OUT"),
    # A task that was preempted is still leaving its node when it is put back into the queue.
    *("POWER_UP_NODE", "COMPLETING"),
)
_SUSPENDED = ("SUSPENDED", "STOPPED")


class RefusedError(InputError):
    """A job that was not taken. `too_many`: fewer tasks may be taken. `is_away`: nobody answered, so that no
    other job will be taken now. `is_unsure`: it may have been taken all the same.
    """

    def __init__(
        self, text: str, *, too_many: bool = False, is_away: bool = False, is_unsure: bool = False
    ) -> None:
        super().__init__(text)
        self.too_many = too_many
        self.is_away = is_away
        self.is_unsure = is_unsure

    @classmethod
    def of(cls, done: Completed) -> Self:
        """What sbatch said."""
        words, limit = _words_of(done), _POLICY.search(done.error)
        if limit is not None and limit[0] not in words:
            words += f" ({limit[0]})"
        if "SubmitJob" in limit[0] if limit is not None else "job submit limit" in done.error:
            return cls(
                f"{words}; `carom study resume` submits the rest once jobs of yours have ended", too_many=True
            )
        if done.exit_code == TIMED_OUT:
            # sbatch itself tries again for minutes while the cluster takes no more jobs.
            told = f"{words}; the queue is full, or the controller is away: {_AGAIN}"
            return cls(told, is_away=True, is_unsure=True)
        if _AWAY.search(done.error):
            is_unsure = "unable to contact" not in done.error.lower()
            return cls(f"{words}; {_AGAIN} once it answers", is_away=True, is_unsure=is_unsure)
        if _FULL.search(done.error):
            return cls(f"{words}; the queue is full: {_AGAIN}")
        return cls(words)


@dataclass(frozen=True)
class TaskState:
    """What the scheduler says of one task of an array, e.g. `PENDING` and `Resources`, and for how many
    seconds it has run, by the controller's clock.
    """

    state: str
    reason: str
    seconds: float = 0.0

    @property
    def waits(self) -> bool:
        """Whether it is still to be started, or started anew."""
        return self.state in _WAITING

    @property
    def runs(self) -> bool:
        """Whether it has nodes."""
        return self.state in _RUNNING

    @property
    def lives(self) -> bool:
        """Whether Slurm still has it."""
        return self.waits or self.runs

    @property
    def is_suspended(self) -> bool:
        """Whether it has nodes and stands still."""
        return self.state in _SUSPENDED


Queue = dict[tuple[str, int], TaskState]
"""A job's name and a task's index in its array -> its state."""


def max_array_size() -> int:
    """MaxArraySize of the cluster, an index is less than that; or MaxJobCount, how many jobs it keeps, if
    that is less. Raises InputError if it cannot be read.
    """
    said = _ask("scontrol", "show", "config")
    sizes = dict(re.findall(r"^\s*(MaxArraySize|MaxJobCount)\s*=\s*(\d+)\b", said, re.MULTILINE))
    if "MaxArraySize" not in sizes:
        raise InputError("scontrol show config: names no MaxArraySize")
    return max(1, min(map(int, sizes.values())))


def queue() -> Queue:
    """The user's tasks that wait or run, and those ended that Slurm has not yet forgotten.

    Raises InputError if squeue does not answer.
    """
    # The name comes last: others of the user's jobs may have any.
    said = _ask("squeue", "--me", "--array", "--noheader", "--states=all", "--format=%K|%T|%M|%r|%j")
    tasks: Queue = {}
    for line in said.splitlines():
        index, state, elapsed, reason, name = (line.strip().split("|", 4) + [""] * 5)[:5]
        for number in _indices(index):
            # A task may be listed twice, by the job that was requeued and by its twin: what lives counts.
            known = tasks.get((name, number))
            if known is None or not known.lives:
                tasks[name, number] = TaskState(state.rstrip("+"), reason, _seconds(elapsed))
    return tasks


def in_queue() -> Counter[str]:
    """How many of the user's jobs wait or run, by partition; each task of an array is a job to the limits.

    Raises InputError if squeue does not answer.
    """
    said = _ask("squeue", "--me", "--array", "--noheader", "--format=%P")
    return Counter(line.strip() for line in said.splitlines() if line.strip())


def submit(script: Path) -> str:
    """Submit a batch script; returns the job's id. Raises RefusedError with Slurm's words."""
    done = _run("sbatch", "--parsable", os.fspath(script))
    if done.exit_code != 0:
        raise RefusedError.of(done)
    return done.output.strip().partition(";")[0]


def _indices(text: str) -> Iterator[int]:
    """`7` is one, `N/A` is none; of `[0-3,9%4]`, which a version may leave together, it is five."""
    for part in text.strip("[]").partition("%")[0].split(","):
        found = re.fullmatch(r"(\d{1,9})(?:-(\d{1,9}))?(?::(\d{1,9}))?", part)
        if found is not None:
            first, last, step = int(found[1]), int(found[2] or found[1]), int(found[3] or 1)
            yield from range(first, last + 1, max(1, step))


def _seconds(elapsed: str) -> float:
    """Of `1-02:03:04`, `02:03:04` and `3:04`; 0 of what is no time, such as INVALID."""
    found = re.fullmatch(r"(?:(?:(\d+)-)?(\d+):)?(\d+):(\d+)", elapsed.strip())
    if found is None:
        return 0.0
    days, hours, minutes, seconds = (int(part or 0) for part in found.groups())
    return 86400.0 * days + 3600 * hours + 60 * minutes + seconds


def _ask(*command: str) -> str:
    done = _run(*command)
    if done.exit_code != 0:
        raise InputError(_words_of(done))
    return done.output


def _run(*command: str) -> Completed:
    # sbatch lets its own variables overrule the script, which is to be the one account of what was asked for.
    environment = {key: value for key, value in os.environ.items() if not key.startswith("SBATCH_")}
    return process.run(command, environment, TIME_LIMIT_SECONDS)


def _words_of(done: Completed) -> str:
    """What a command said last, after its name."""
    name = done.command[0]
    return f"{name}: {done.reason.removeprefix(f'{name}: ')}"
