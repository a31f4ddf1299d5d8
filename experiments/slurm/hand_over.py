"""A job array handed to Slurm: its script, its list of blocks, and as many tasks as the cluster takes."""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.run.study import Study
from experiments.slurm import scheduler
from experiments.slurm.jobs import Job, PartitionFolder, Unit
from experiments.slurm.pack import pack, within_time
from experiments.slurm.refusal import RefusedError
from experiments.slurm.script import render
from experiments.slurm.task_log import read_told
from support.errors import InputError
from support.files import write_json, write_text

_IN_THE_QUEUE = "known by its name"


@dataclass(frozen=True)
class Handed:
    """A job that Slurm has taken: its number there, and the blocks that did not fit into it."""

    number: str
    job: Job
    script: Path
    left: tuple[Unit, ...]


def hand_over(folder: PartitionFolder, study: Study, wanted: Sequence[Unit], most_tasks: int) -> Handed:
    """Submit blocks in at most so many tasks, or in half as many, and so on, where the cluster takes fewer.

    Raises RefusedError if it takes none; nothing is left of the job then.
    """
    while True:
        job, path = plan_job(folder, study, wanted, most_tasks)
        try:
            number = _submit(folder, study, job, path)
        except RefusedError as refusal:
            if not refusal.too_many or len(job.tasks) == 1:
                raise
            most_tasks = len(job.tasks) // 2
            continue
        handed = {unit for task in job.tasks for unit in task}
        left = tuple(unit for unit in wanted if unit not in handed)
        return Handed(number, job, path.with_suffix(".sbatch"), left)


def plan_job(
    folder: PartitionFolder, study: Study, wanted: Sequence[Unit], most_tasks: int
) -> tuple[Job, Path]:
    """A job of the blocks, as far as they fit into so many tasks, and where its list of blocks belongs."""
    partition = folder.partition
    tasks = pack(wanted, partition.blocks_per_task, most_tasks)
    known = read_told(folder.jobs, study.scale.name).means
    return folder.next_job(study, within_time(tasks, partition, known))


def script_of(folder: PartitionFolder, study: Study, job: Job, manifest: Path) -> str:
    """The batch script of a job."""
    return render(job.name, folder.partition, manifest, len(job.tasks), study.site.programs)


def _submit(folder: PartitionFolder, study: Study, job: Job, path: Path) -> str:
    script = path.with_suffix(".sbatch")
    text = script_of(folder, study, job, path)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(script, text, path.parent)
    write_json(path, job.content(), path.parent)
    try:
        return scheduler.submit(script)
    except InputError as error:
        is_queued = isinstance(error, RefusedError) and error.is_unsure and _is_queued(job)
        if is_queued:
            return _IN_THE_QUEUE
        if is_queued is not None:
            # A job that was never in the queue must not be taken for one that has left it.
            path.unlink()
            script.unlink()
        raise


def _is_queued(job: Job) -> bool | None:
    """Whether the queue holds the job although nobody said so. None if nobody answers: its list of blocks
    then stays, for its tasks or as one that has left the queue.
    """
    with contextlib.suppress(InputError):
        return any(name == job.name for name, _ in scheduler.queue())
    return None
