"""Hand what is missing of a study to Slurm: one job array for each partition."""

import shutil
from collections.abc import Collection, Sequence
from pathlib import Path

from experiments.plan.site import load_site
from experiments.run.progress import warn
from experiments.run.study import Settings, Study
from experiments.slurm import scheduler
from experiments.slurm.jobs import (
    Job,
    PartitionFolder,
    Unit,
    blocks_of,
    folders,
    results_of,
    submitted,
    units,
)
from experiments.slurm.scheduler import DEFAULT_MAX_ARRAY_SIZE, Queue
from experiments.slurm.script import render
from support.errors import InputError
from support.files import locked, write_json, write_text

MOST_CUT_OFF = 2
"""Blocks of an experiment that allocations may cut off, in those that the question asks for."""


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
        raise InputError(f"site {settings.site}: nothing was submitted yet; `carom study submit` does it")
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


def of_scale(study: Study, active: Collection[tuple[str, Unit]]) -> set[Unit]:
    """The units of the study itself."""
    return {unit for scale, unit in active if scale == study.scale.name}


def too_long(folder: PartitionFolder, study: Study, active: Collection[tuple[str, Unit]]) -> dict[str, int]:
    """The experiments of which so many blocks were cut off that no further ones are submitted, with their
    number: else a block that is longer than its allocation would be submitted for ever.
    """
    busy, found = of_scale(study, active), {}
    for one in study.experiments:
        word = folder.made_of(one)
        handed_out = {
            block
            for job in folder.known_jobs()
            if job.made_of.get(one.name) == word and job.settings.scale == study.scale.name
            for task in job.tasks
            for name, block in task
            if name == one.name
        }
        blocks = blocks_of(study, one, {block for name, block in busy if name == one.name})
        cut_off = sum(map(blocks.cut_off, handed_out))
        if cut_off >= MOST_CUT_OFF * one.question.blocks.minimum:
            found[one.name] = cut_off
    return found


def said(partition: str, experiment: str, cut_off: int) -> str:
    """Say that no further blocks are submitted."""
    return (
        f"{partition}: {experiment}: {cut_off} blocks were cut off before they were whole; no further ones "
        "are submitted: raise `minutes` in the site file"
    )


def _submit(folder: PartitionFolder, study: Study, queue: Queue, array_size: int) -> None:
    active = is_active(folder, queue)
    for experiment in study.experiments:
        study.store.settle(experiment)
    if not active:
        # What tasks that were killed left half-written.
        shutil.rmtree(study.store.root / ".running", ignore_errors=True)
    without = too_long(folder, study, active)
    wanted, points = _missing(study, active, without)
    name = folder.partition.name
    for one, cut_off in without.items():
        print(said(name, one, cut_off))
    if not wanted:
        rest = "waits or runs" if active else "was cut off" if without else ""
        print(f"{name}: nothing to submit; " + (f"the rest {rest}" if rest else "all is measured"))
        return
    job, path = folder.next_job(study, pack(wanted, folder.partition.blocks_per_task, array_size))
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


def _missing(
    study: Study, active: Collection[tuple[str, Unit]], without: Collection[str]
) -> tuple[list[Unit], int]:
    """Units to submit, and the number of their processes, `without` those of some experiments."""
    busy = of_scale(study, active)
    lacking = {
        unit: len(points)
        for unit, experiment, points in units(study, busy)
        if points and unit not in busy and experiment.name not in without
    }
    return list(lacking), sum(lacking.values())


def _print_script(folder: PartitionFolder, study: Study, array_size: int) -> None:
    wanted, points = _missing(study, (), too_long(folder, study, ()))
    if not wanted:
        print(f"# {folder.partition.name}: nothing to submit")
        return
    job, path = folder.next_job(study, pack(wanted, folder.partition.blocks_per_task, array_size))
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
