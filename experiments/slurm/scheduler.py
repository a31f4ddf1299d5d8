"""Slurm's own commands, each with a time limit: clients hang while the controller is away."""

import os
import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from experiments.support import process
from experiments.support.process import Completed
from support.errors import InputError

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
    """A job that was not taken, in Slurm's words, or of which nobody says whether it was."""

    def __init__(self, done: Completed) -> None:
        said, limit = _words_of(done), _POLICY.search(done.error)
        if limit is not None and limit[0] not in said:
            said += f" ({limit[0]})"
        super().__init__(f"{said}; `carom study resume` submits the rest later")
        self.is_of_number = "SubmitJob" in limit[0] if limit else "job submit limit" in done.error
        """Whether fewer tasks may be taken."""
        self.is_away = False
        """Whether nobody answers any more, so that no other job will be taken now."""


@dataclass(frozen=True)
class TaskState:
    """What the scheduler says of one task of an array, e.g. `PENDING` and `Resources`."""

    state: str
    reason: str

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
    said = _ask("squeue", "--me", "--array", "--noheader", "--states=all", "--format=%K|%T|%r|%j")
    tasks: list[tuple[tuple[str, int], TaskState]] = []
    for line in said.splitlines():
        index, state, reason, name = (line.strip().split("|", 3) + [""] * 4)[:4]
        if index.isdecimal():
            tasks.append(((name, int(index)), TaskState(state.rstrip("+"), reason)))
    # A task may be listed twice, by the job that was requeued and by its twin: what lives counts.
    return dict(sorted(tasks, key=lambda one: one[1].lives))


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
        raise RefusedError(done)
    return done.output.strip().partition(";")[0]


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
