"""Hand what is missing of a study to Slurm: one job array for each partition."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from experiments.plan.site import load_site
from experiments.run.progress import warn
from experiments.run.study import Settings, Study
from experiments.slurm import scheduler
from experiments.slurm.jobs import Job, PartitionFolder, Unit, folders, results_of, submitted, units
from experiments.slurm.scheduler import DEFAULT_MAX_ARRAY_SIZE, Queue
from experiments.slurm.script import render
from experiments.support.errors import InputError
from experiments.support.files import locked, write_json, write_text


def submit(settings: Settings, *, dry_run: bool = False) -> int:
    """Submit what the records lack and no waiting or running task will bring. Returns the exit code, 0.

    With `dry_run` the scripts are printed and nothing is written.
    """
    # Every partition is planned before the first one is submitted: bad input submits nothing.
    planned = [(folder, folder.study(to_be_built=True)) for folder in folders(settings)]
    if dry_run:
        size = _array_size_or_default()
        for folder, study in planned:
            _print_script(folder, study, size)
        return 0
    size = scheduler.max_array_size()
    with locked(results_of(settings, load_site(settings.site))):
        queue = scheduler.queue()
        for folder, study in planned:
            _submit(folder, study, queue, size)
    return 0


def resume(settings: Settings, *, dry_run: bool = False) -> int:
    """Submit what is missing of all that has been submitted before, at the scale of the last time."""
    chosen = submitted(settings)
    if chosen is None:
        raise InputError(f"site {settings.site}: nothing has been submitted yet; `make submit` does it")
    return submit(chosen, dry_run=dry_run)


def pack(wanted: Sequence[Unit], blocks_per_task: int, array_size: int) -> list[list[Unit]]:
    """Share blocks out among tasks: so many each, or more where the array would else be too long."""
    each = max(blocks_per_task, -(-len(wanted) // array_size))
    return [list(wanted[first : first + each]) for first in range(0, len(wanted), each)]


def is_active(folder: PartitionFolder, queue: Queue) -> dict[tuple[str, Unit], str]:
    """Scale and unit -> `running` or `waiting`, of all tasks of the folder's jobs that Slurm still has."""
    active: dict[tuple[str, Unit], str] = {}
    for job in folder.known_jobs():
        for index, task in enumerate(job.tasks):
            state = queue.get((job.name, index))
            if state is not None and (state.waits or state.runs):
                for unit in task:
                    active[job.settings.scale, unit] = "running" if state.runs else "waiting"
    return active


def _submit(folder: PartitionFolder, study: Study, queue: Queue, array_size: int) -> None:
    active = is_active(folder, queue)
    for experiment in study.experiments:
        study.store.settle(experiment)
    if not active:
        # What tasks that were killed left half-written.
        shutil.rmtree(study.store.root / ".running", ignore_errors=True)
    wanted, points = _missing(study, active)
    name = folder.partition.name
    if not wanted:
        print(f"{name}: nothing to submit; " + ("the rest waits or runs" if active else "all is measured"))
        return
    job, path = folder.next_job(pack(wanted, folder.partition.blocks_per_task, array_size))
    script = path.with_suffix(".sbatch")
    text = _script(folder, study, job, path)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(script, text, path.parent)
    write_json(path, job.content(), path.parent)
    try:
        number = scheduler.submit(script)
    except InputError:
        # A job that was never in the queue must not be taken for one that has left it.
        path.unlink()
        script.unlink()
        raise
    print(f"{name}: job {number}, {points} processes in {len(job.tasks)} tasks: {script}")


def _missing(study: Study, active: dict[tuple[str, Unit], str]) -> tuple[list[Unit], int]:
    """Units to submit, and the number of their processes."""
    lacking = {
        unit: len(points)
        for unit, _, points in units(study)
        if points and (study.scale.name, unit) not in active
    }
    return list(lacking), sum(lacking.values())


def _print_script(folder: PartitionFolder, study: Study, array_size: int) -> None:
    wanted, points = _missing(study, {})
    if not wanted:
        print(f"# {folder.partition.name}: nothing to submit")
        return
    job, path = folder.next_job(pack(wanted, folder.partition.blocks_per_task, array_size))
    print(f"# {folder.partition.name}: {points} processes in {len(job.tasks)} tasks")
    print(_script(folder, study, job, path))


def _script(folder: PartitionFolder, study: Study, job: Job, manifest: Path) -> str:
    return render(job.name, folder.partition, manifest, len(job.tasks), study.site.programs)


def _array_size_or_default() -> int:
    try:
        return scheduler.max_array_size()
    except InputError as error:
        warn(f"{error}; MaxArraySize is taken to be {DEFAULT_MAX_ARRAY_SIZE}, Slurm's default")
        return DEFAULT_MAX_ARRAY_SIZE
