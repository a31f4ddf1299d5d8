"""Hand what is missing of a study to Slurm: one job array for each partition."""

import shutil
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from experiments.plan.site import load_site
from experiments.run.progress import warn
from experiments.run.study import Settings, Study
from experiments.slurm import scheduler
from experiments.slurm.hand_over import hand_over, plan_job, script_of
from experiments.slurm.jobs import (
    PartitionFolder,
    Unit,
    blocks_of,
    cluster_of,
    folders,
    results_of,
    submitted,
    units,
)
from experiments.slurm.pack import Room
from experiments.slurm.refusal import RefusedError
from experiments.slurm.scheduler import DEFAULT_MAX_ARRAY_SIZE, Queue
from support.errors import InputError
from support.files import locked

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
    site, size = load_site(settings.site), scheduler.max_array_size()
    with locked(results_of(settings, site)):
        queue, room = scheduler.queue(), Room(cluster_of(site), Counter())
        if room.is_limited:
            room.queued += scheduler.in_queue()
        _submit_all([_lacking(folder, study, queue) for folder, study in planned], room, size)
    return 0


def resume(settings: Settings, *, dry_run: bool = False) -> int:
    """Submit what is missing of all that has been submitted before, at the scale of the last time."""
    chosen = submitted(settings)
    if chosen is None:
        raise InputError(f"site {settings.site}: nothing was submitted yet; `carom study submit` does it")
    return submit(chosen, dry_run=dry_run)


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


@dataclass(frozen=True)
class _Lacking:
    """What of the study one partition lacks."""

    folder: PartitionFolder
    study: Study
    wanted: Mapping[Unit, int]
    """Units to submit, each with its number of processes."""
    cut_off: Mapping[str, int]
    """The experiments that are not submitted any more."""
    is_active: bool
    """Whether tasks wait or run."""

    @property
    def name(self) -> str:
        return self.folder.partition.name

    def processes(self, units: Collection[Unit]) -> int:
        return sum(self.wanted[unit] for unit in units)


def _lacking(folder: PartitionFolder, study: Study, queue: Queue) -> _Lacking:
    """What is to be submitted, once what is stale and what was left half-written is out of the way."""
    active = is_active(folder, queue)
    for experiment in study.experiments:
        study.store.settle(experiment)
    if not active:
        # What tasks that were killed left half-written.
        shutil.rmtree(study.store.root / ".running", ignore_errors=True)
    without = too_long(folder, study, active)
    return _Lacking(folder, study, _missing(study, active, without), without, bool(active))


def _submit_all(lacking: Sequence[_Lacking], room: Room, size: int) -> None:
    """Submit what each partition lacks. What is refused to one, others may be given; the last refusal is
    raised in the end, after a line for each of the others.
    """
    refused: list[RefusedError] = []
    for number, one in enumerate(lacking):
        for name, cut_off in one.cut_off.items():
            print(said(one.name, name, cut_off))
        sharing = sum(bool(other.wanted) for other in lacking[number:])
        try:
            _submit(one, room, room.of(one.folder.partition, sharing), size)
        except RefusedError as refusal:
            refused.append(refusal)
            if refusal.is_away:
                break
    for earlier in refused[:-1]:
        warn(str(earlier))
    if refused:
        raise refused[-1]


def _submit(lacking: _Lacking, room: Room, most_tasks: int | None, size: int) -> None:
    name = lacking.name
    if not lacking.wanted:
        rest = "waits or runs" if lacking.is_active else "was cut off" if lacking.cut_off else ""
        print(f"{name}: nothing to submit; " + (f"the rest {rest}" if rest else "all is measured"))
        return
    if most_tasks == 0:
        blocks = len(lacking.wanted)
        print(f"{name}: max_submitted leaves room for no task; {_left(blocks)} once jobs of yours have ended")
        return
    most_tasks = size if most_tasks is None else min(size, most_tasks)
    handed = hand_over(lacking.folder, lacking.study, list(lacking.wanted), most_tasks)
    room.take(lacking.folder.partition, len(handed.job.tasks))
    points = lacking.processes(lacking.wanted.keys() - set(handed.left))
    print(
        f"{name}: job {handed.number}, {points} processes in {len(handed.job.tasks)} tasks: {handed.script}"
    )
    if handed.left:
        print(f"{name}: no more fit into the time limit of so many tasks; {_left(len(handed.left))}")


def _left(blocks: int) -> str:
    those = f"{blocks} blocks that are" if blocks != 1 else "block that is"
    return f"`carom study resume` submits the {those} left"


def _missing(study: Study, active: Collection[tuple[str, Unit]], without: Collection[str]) -> dict[Unit, int]:
    """Units to submit, and the number of processes of each, `without` those of some experiments."""
    busy = of_scale(study, active)
    return {
        unit: len(points)
        for unit, experiment, points in units(study, busy)
        if points and unit not in busy and experiment.name not in without
    }


def _print_script(folder: PartitionFolder, study: Study, array_size: int) -> None:
    wanted = _missing(study, (), too_long(folder, study, ()))
    if not wanted:
        print(f"# {folder.partition.name}: nothing to submit")
        return
    job, path = plan_job(folder, study, list(wanted), array_size)
    points = sum(wanted[unit] for task in job.tasks for unit in task)
    print(f"# {folder.partition.name}: {points} processes in {len(job.tasks)} tasks")
    print(script_of(folder, study, job, path))


def _array_size_or_default() -> int:
    try:
        return scheduler.max_array_size()
    except InputError as error:
        warn(f"{error}; MaxArraySize is taken to be {DEFAULT_MAX_ARRAY_SIZE}, Slurm's default")
        return DEFAULT_MAX_ARRAY_SIZE
