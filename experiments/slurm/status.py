"""What of a study on a cluster is measured, running, waiting, failed or missing, and why."""

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

from experiments.run.progress import warn
from experiments.run.status import new_console, new_table
from experiments.run.study import Settings, Study
from experiments.slurm import scheduler
from experiments.slurm.jobs import PartitionFolder, blocks_of, folders, submitted, units
from experiments.slurm.scheduler import Queue, TaskState
from experiments.slurm.submit import is_active, of_scale, said, too_long
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

    What is done and what failed is told by the files. Slurm tells what runs and waits, and why a task ended
    early; without its answer both count as missing.
    """
    chosen = submitted(settings) or settings
    if settings.study:
        chosen = replace(chosen, study=settings.study)
    try:
        queue = scheduler.queue()
    except InputError as error:
        warn(f"{error}; what runs and what waits is shown as missing")
        queue = {}
    screen = new_console()
    shown = new_table("partition", "experiment", *_STATES)
    explained = []
    for folder in folders(chosen):
        study = folder.study(to_be_built=True)
        state = rows(folder, study, queue)
        for row in state:
            shown.add_row(row.partition, row.experiment, *(str(row.counts[name]) for name in _STATES))
        explained += [
            f"{row.partition}: {row.experiment}: {number} failed: {reason}"
            for row in state
            for reason, number in row.reasons.items()
        ]
        explained += _explain(folder, study, queue)
        without = too_long(folder, study, is_active(folder, queue))
        explained += [said(folder.partition.name, name, number) for name, number in without.items()]
    screen.print(shown)
    for line in explained:
        screen.print(line)
    return 0


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
    return [f"{name}: job {number}: {count} of the tasks {fate}" for (number, fate), count in told.items()]


def _fate(state: TaskState | None, log: Path) -> str:
    if state is not None and state.waits:
        return f"wait: {state.reason}"
    if not log.exists():
        return "never started, and have left the queue (cancelled?)"
    ended = f"ended as {state.state}" if state is not None else "have ended"
    return f"{ended} and left processes unfinished; their logs are in {log.parent}"
