"""How far a partition is, in one line: a bar, its tasks, and when it will be done."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from experiments.run.progress import about
from experiments.run.study import Study
from experiments.slurm.jobs import PartitionFolder, Unit
from experiments.slurm.scheduler import Queue, TaskState
from experiments.slurm.task_log import Told

_WIDTH = 24


@dataclass(frozen=True)
class Tasks:
    """The tasks of a study that Slurm still has, each with its blocks."""

    running: Sequence[tuple[TaskState, Sequence[Unit]]]
    waiting: Sequence[tuple[TaskState, Sequence[Unit]]]
    at_once: int
    """How many may run at a time, of all of their arrays."""

    @property
    def suspended(self) -> int:
        """How many of those that run stand still."""
        return sum(state.is_suspended for state, _ in self.running)

    def seconds_left(self, told: Told) -> float:
        """How long they will take, by what blocks have taken so far."""
        left = [max(0.0, told.seconds_of(units) - state.seconds) for state, units in self.running]
        left += [told.seconds_of(units) for _, units in self.waiting]
        return max(max(left, default=0.0), sum(left) / max(1, min(self.at_once, len(left))))


def tasks_of(folder: PartitionFolder, study: Study, queue: Queue) -> Tasks:
    """Those of the folder's jobs, of the scale of the study."""
    running: list[tuple[TaskState, Sequence[Unit]]] = []
    waiting: list[tuple[TaskState, Sequence[Unit]]] = []
    arrays: set[str] = set()
    for job in folder.known_jobs():
        for index, units in enumerate(job.tasks if job.settings.scale == study.scale.name else ()):
            state = queue.get((job.name, index))
            if state is not None and (state.runs or state.waits):
                (running if state.runs else waiting).append((state, units))
                arrays.add(job.name)
    return Tasks(running, waiting, len(arrays) * folder.partition.at_once)


def progress_line(name: str, counts: Counter[str], tasks: Tasks | None, told: Told, now: datetime) -> str:
    """The line of one partition, whose processes have these states. `tasks` is None where Slurm does not tell
    them; `now` is the local time.
    """
    all_of_them, done = counts.total(), counts["done"]
    share = done / all_of_them if all_of_them else 1.0
    filled = int(_WIDTH * share)
    parts = [f"{name}: [{'#' * filled}{'-' * (_WIDTH - filled)}] {done} of {all_of_them} processes"]
    if tasks is None:
        parts.append("what runs and waits is not known")
    elif tasks.running or tasks.waiting:
        run = "task runs" if len(tasks.running) == 1 else "tasks run"
        parts += [f"{len(tasks.running)} {run}, {len(tasks.waiting)} wait", _end(tasks, told, now)]
        if tasks.suspended:
            parts.append(f"{tasks.suspended} suspended: what the pause cut through is measured again")
    elif done < all_of_them:
        parts.append("no task runs or waits: `carom study resume` submits what is missing")
    return "; ".join(parts)


def _end(tasks: Tasks, told: Told, now: datetime) -> str:
    if not told.seconds:
        return "when they will be done is not known: no task has ended yet"
    seconds = tasks.seconds_left(told)
    end = now + timedelta(seconds=seconds)
    at = f"{end:%H:%M}" if end.date() == now.date() else f"{end:%Y-%m-%d %H:%M}"
    together = min(tasks.at_once, len(tasks.running) + len(tasks.waiting))
    return f"{about(seconds)} left if {together} run at a time, done at {at}"
