"""Slurm's own commands, each with a time limit: clients hang while the controller is away."""

import os
import re
from dataclasses import dataclass
from pathlib import Path

from experiments.support import process
from support.errors import InputError

TIME_LIMIT_SECONDS = 30.0
DEFAULT_MAX_ARRAY_SIZE = 1001
"""Slurm's own default."""

_WAITING = ("PENDING", "REQUEUED", "REQUEUE_FED", "REQUEUE_HOLD", "RESV_DEL_HOLD", "SPECIAL_EXIT")
_RUNNING = ("RUNNING", "CONFIGURING", "SUSPENDED", "STOPPED", "SIGNALING", "RESIZING", "STAGE_OUT")


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


Queue = dict[tuple[str, int], TaskState]
"""A job's name and a task's index in its array -> its state."""


def max_array_size() -> int:
    """MaxArraySize of the cluster: an index is less than that. Raises InputError if it cannot be read."""
    said = _ask("scontrol", "show", "config")
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)\s*$", said, re.MULTILINE)
    if found is None:
        raise InputError("scontrol show config: names no MaxArraySize")
    return max(1, int(found.group(1)))


def queue() -> Queue:
    """The user's tasks that wait or run, and those ended that Slurm has not yet forgotten.

    Raises InputError if squeue does not answer.
    """
    said = _ask("squeue", "--me", "--array", "--noheader", "--states=all", "--format=%j|%K|%T|%r")
    tasks: Queue = {}
    for line in said.splitlines():
        name, index, state, reason = (line.split("|", 3) + [""] * 3)[:4]
        # A task may be listed twice, by the job that was requeued and by its twin: what lives counts.
        known = tasks.get((name, int(index))) if index.isdigit() else None
        if index.isdigit() and (known is None or not (known.waits or known.runs)):
            tasks[name, int(index)] = TaskState(state, reason)
    return tasks


def submit(script: Path) -> str:
    """Submit a batch script; returns the job's id. Raises InputError with Slurm's words if it is refused."""
    return _ask("sbatch", "--parsable", os.fspath(script)).strip().partition(";")[0]


def _ask(*command: str) -> str:
    # sbatch lets its own variables overrule the script, which is to be the one account of what was asked for.
    environment = {key: value for key, value in os.environ.items() if not key.startswith("SBATCH_")}
    done = process.run(command, environment, TIME_LIMIT_SECONDS)
    if done.exit_code != 0:
        raise InputError(f"{command[0]}: {done.reason.removeprefix(f'{command[0]}: ')}")
    return done.output
