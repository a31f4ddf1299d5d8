"""What of a study on a cluster is measured, running, waiting, failed or missing, and why."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from experiments.run.progress import warn
from experiments.run.status import new_console, new_table
from experiments.run.study import Settings, Study
from experiments.slurm import scheduler
from experiments.slurm.forecast import Tasks, progress_line, tasks_of
from experiments.slurm.jobs import PartitionFolder, blocks_of, folders, submitted, units
from experiments.slurm.scheduler import Queue, TaskState
from experiments.slurm.submit import is_active, of_scale, said, too_long
from experiments.slurm.task_log import Told, read_told
from support.errors import InputError

_STATES = ("done", "running", "waiting", "failed", "missing")


@dataclass(frozen=True)
class Row:
    """One experiment on one partition: its processes by state, and the reasons of its failures."""

    partition: str
    experiment: str
    counts: Counter[str]
    reasons: Counter[str]


def show_cluster_status(settings: Settings) -> int:
    """Print the state of what has been submitted; nothing is written. Returns the exit code, 0.

    What is done and what failed is told by the files. Slurm tells what runs and waits, and as what a task
    ended; without its answer both count as missing.
    """
    chosen = submitted(settings) or settings
    if settings.study:
        chosen = replace(chosen, study=settings.study)
    answer = _queue()
    queue = answer or {}
    screen = new_console()
    shown = new_table("partition", "experiment", *_STATES)
    explained, lines = [], []
    for folder in folders(chosen):
        study = folder.study(to_be_built=True)
        state = rows(folder, study, queue)
        for row in state:
            shown.add_row(row.partition, row.experiment, *(str(row.counts[name]) for name in _STATES))
        told = read_told(folder.jobs, study.scale.name)
        lines.append(
            _progress(folder, state, told, tasks_of(folder, study, queue) if answer is not None else None)
        )
        explained += [
            f"{row.partition}: {row.experiment}: {number} failed: {reason}"
            for row in state
            for reason, number in row.reasons.items()
        ]
        explained += _explain(folder, study, queue)
        if len(told.processors) > 1:
            kinds = ", ".join(sorted(told.processors))
            explained.append(
                f"{folder.partition.name}: its nodes differ, and count as {len(told.processors)} machines: "
                f"{kinds}; `constraint` in the site file picks one"
            )
        without = too_long(folder, study, is_active(folder, queue))
        explained += [said(folder.partition.name, name, number) for name, number in without.items()]
    screen.print(shown)
    for line in (*lines, *explained):
        screen.print(line)
    return 0


def _queue() -> Queue | None:
    """The queue, or None with a line where Slurm does not answer."""
    try:
        return scheduler.queue()
    except InputError as error:
        warn(f"{error}; what runs and what waits is shown as missing")
        return None


def rows(folder: PartitionFolder, study: Study, queue: Queue) -> list[Row]:
    """The state of each experiment on one partition."""
    active = is_active(folder, queue)
    found = {one.name: study.store.find(one) for one in study.experiments}
    result = {name: Row(folder.partition.name, name, Counter(), Counter()) for name in found}
    for one in study.experiments:
        keys = blocks_of(study, one).keys
        result[one.name].counts["done"] = sum(key in found[one.name].seconds for key in keys)
    for (name, block), _, points in units(study, of_scale(study, active)):
        for _, point in points:
            state = active.get((study.scale.name, (name, block)))
            reason = found[name].failures.get((point.id, block))
            if state is None and reason is not None:
                state = "failed"
                result[name].reasons[reason] += 1
            result[name].counts[state or "missing"] += 1
    return list(result.values())


def _explain(folder: PartitionFolder, study: Study, queue: Queue) -> list[str]:
    """Why tasks wait, and what became of those that left blocks unfinished."""
    active = of_scale(study, is_active(folder, queue))
    unfinished = {(study.scale.name, unit) for unit, _, points in units(study, active) if points}
    told: Counter[tuple[str, str]] = Counter()
    # Of the jobs that a block was part of, the last one tells what became of it.
    for job in reversed(folder.known_jobs()):
        number = job.name.rpartition("-")[2]
        for index, task in enumerate(job.tasks):
            own = {(job.settings.scale, unit) for unit in task} & unfinished
            unfinished -= own
            state = queue.get((job.name, index))
            if own and not (state is not None and state.runs):
                told[number, _fate(state, folder.jobs / f"{number}-{index}.log")] += 1
    name = folder.partition.name
    return [
        f"{name}: job {number}: {count} of the tasks {became}" for (number, became), count in told.items()
    ]


def _fate(state: TaskState | None, log: Path) -> str:
    """What became of a task that left blocks unfinished; `state` is None if Slurm has forgotten it."""
    if state is not None and state.waits:
        return f"wait: {state.reason}"
    if not log.exists():
        return "never started, and have left the queue (cancelled?)"
    ended = f"ended as {state.state}" if state is not None else "have ended"
    return f"{ended} and left processes unfinished; their logs are in {log.parent}"


def _progress(folder: PartitionFolder, state: Sequence[Row], told: Told, tasks: Tasks | None) -> str:
    """How far the partition is, with what its tasks do now as far as that is known."""
    counts = sum((row.counts for row in state), Counter[str]())
    return progress_line(folder.partition.name, counts, tasks, told, datetime.now().astimezone())
