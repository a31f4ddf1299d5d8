"""Hand what is missing of a study to Slurm: one job array for each partition, its script from a template."""

import shlex
import shutil
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import jinja2

from experiments.plan.cluster import Cluster, Partition
from experiments.plan.site import load_site
from experiments.run.progress import warn
from experiments.run.study import Settings
from experiments.slurm import scheduler
from experiments.slurm.jobs import (
    Job,
    Standing,
    Unit,
    cluster_of,
    folders,
    results_of,
    submitted,
)
from experiments.slurm.scheduler import DEFAULT_MAX_ARRAY_SIZE, RefusedError
from support.errors import InputError
from support.files import locked, write_json, write_text
from support.home import ROOT

COMPILERS = {"gcc": "g++", "clang": "clang++"}


_OF_MEMORY = ("--mem", "--mem-per-cpu", "--mem-per-gpu")


def submit(settings: Settings, *, dry_run: bool = False) -> int:
    """Submit what the records lack and no waiting or running task will bring. Returns the exit code, 0.

    With `dry_run` the scripts are printed and nothing is written.
    """
    # Every partition is planned before the first one is submitted: bad input submits nothing.
    planned = [(folder, folder.study(to_be_built=True)) for folder in folders(settings)]
    if dry_run:
        size = _array_size_or_default()
        for folder, study in planned:
            _print_script(Standing(folder, study, {}), size)
        return 0
    site, size = load_site(settings.site), scheduler.max_array_size()
    with locked(results_of(settings, site)):
        queue, cluster = scheduler.queue(), cluster_of(site)
        lacking = []
        for folder, study in planned:
            # What is stale goes out of the way, and so does what tasks that were killed left half-written.
            for experiment in study.experiments:
                study.store.settle(experiment)
            lacking.append(Standing(folder, study, queue))
            if not lacking[-1].is_active:
                shutil.rmtree(study.store.root / ".running", ignore_errors=True)
        _submit_all(lacking, cluster, scheduler.in_queue(), size)
    return 0


def resume(settings: Settings, *, dry_run: bool = False) -> int:
    """Submit what is missing of all that has been submitted before, at the scale of the last time."""
    chosen = submitted(settings)
    if chosen is None:
        raise InputError(f"site {settings.site}: nothing was submitted yet; `carom study submit` does it")
    return submit(chosen, dry_run=dry_run)


def _submit_all(lacking: Sequence[Standing], cluster: Cluster, queued: Counter[str], size: int) -> None:
    """Submit what each partition lacks, where so many jobs of the user are `queued` by partition. What is
    refused to one, others may be given; the last refusal is raised in the end, after a line for each of the
    others.
    """
    refused: list[RefusedError] = []
    for number, one in enumerate(lacking):
        print(*one.said_of_too_long(), sep="\n", end="\n" if one.too_long else "")
        sharing = sum(bool(other.wanted) for other in lacking[number:])
        room = _room(cluster, one.folder.partition, queued, sharing)
        try:
            queued[one.name] += _submit(one, min(size, room) if room is not None else size)
        except RefusedError as refusal:
            refused.append(refusal)
            if refusal.is_away:
                break
    for earlier in refused[:-1]:
        warn(str(earlier))
    if refused:
        raise refused[-1]


def _room(cluster: Cluster, partition: Partition, queued: Counter[str], sharing: int) -> int | None:
    """How many tasks may be submitted to one partition, where so many, with itself, want some, as far as the
    site's file says; None for any number.
    """
    room = []
    if cluster.max_submitted is not None:
        room.append(-(-max(0, cluster.max_submitted - queued.total()) // max(1, sharing)))
    if partition.max_submitted is not None:
        room.append(max(0, partition.max_submitted - queued[partition.name]))
    return min(room, default=None)


def _submit(one: Standing, most_tasks: int) -> int:
    """Submit what one partition lacks; returns in how many tasks."""
    name = one.name
    if not one.wanted:
        rest = "waits or runs" if one.is_active else "was cut off" if one.too_long else ""
        print(f"{name}: nothing to submit; " + (f"the rest {rest}" if rest else "all is measured"))
        return 0
    if most_tasks == 0:
        left = _left(len(one.wanted))
        print(f"{name}: max_submitted leaves room for no task; {left} once jobs of yours have ended")
        return 0
    number, job, manifest = _hand_over(one, most_tasks)
    handed = [unit for task in job.tasks for unit in task]
    points, script = sum(one.wanted[unit] for unit in handed), manifest.with_suffix(".sbatch")
    print(f"{name}: job {number}, {points} processes in {len(job.tasks)} tasks: {script}")
    if len(one.wanted) > len(handed):
        left = _left(len(one.wanted) - len(handed))
        print(f"{name}: no more fit into the time limit of so many tasks; {left}")
    return len(job.tasks)


def _left(blocks: int) -> str:
    those = f"{blocks} blocks that are" if blocks != 1 else "block that is"
    return f"`carom study resume` submits the {those} left"


def _hand_over(one: Standing, most_tasks: int) -> tuple[str, Job, Path]:
    """Submit blocks in at most so many tasks, or in half as many, and so on, where the cluster takes fewer;
    returns the job's number and its list of blocks. Raises RefusedError if it takes none; nothing is left
    then.
    """
    while True:
        job, manifest = _plan_job(one, most_tasks)
        script = manifest.with_suffix(".sbatch")
        manifest.parent.mkdir(parents=True, exist_ok=True)
        write_text(script, _script_of(one, job, manifest), manifest.parent)
        write_json(manifest, job.content(), manifest.parent)
        try:
            return scheduler.submit(script), job, manifest
        except RefusedError as refusal:
            if _is_queued(job, refusal):
                return "known by its name", job, manifest
            # A job that was never in the queue must not be taken for one that has left it.
            manifest.unlink()
            script.unlink()
            if not refusal.is_of_number or len(job.tasks) == 1:
                raise
            most_tasks = len(job.tasks) // 2


def _is_queued(job: Job, refusal: RefusedError) -> bool:
    """Whether the queue holds the job although nobody said so. Raises the refusal if nobody answers: its list
    of blocks then stays, for its tasks or as one that has left the queue.
    """
    try:
        return any(name == job.name for name, _ in scheduler.queue())
    except InputError:
        refusal.is_away = True
        raise refusal from None


def _plan_job(one: Standing, most_tasks: int) -> tuple[Job, Path]:
    """A job of the blocks, as far as they fit into so many tasks, and where its list of blocks belongs."""
    partition = one.folder.partition
    tasks = pack(list(one.wanted), partition.blocks_per_task, most_tasks)
    return one.folder.next_job(within_time(tasks, partition, one.block_seconds))


def pack(wanted: Sequence[Unit], blocks_per_task: int, array_size: int) -> list[list[Unit]]:
    """Share blocks out among tasks: so many each, or more where the array would else be too long."""
    each = max(blocks_per_task, -(-len(wanted) // array_size))
    return [list(wanted[first : first + each]) for first in range(0, len(wanted), each)]


def within_time(
    tasks: Iterable[Sequence[Unit]], partition: Partition, seconds: Mapping[str, float]
) -> list[list[Unit]]:
    """The tasks without the blocks that would not be measured before the signal that ends them, as far as the
    `seconds` of a block of an experiment are known. As many as the site wishes stay in any case.
    """
    kept = []
    for task in tasks:
        left, own = float(partition.measuring_seconds), list[Unit]()
        for unit in task:
            left -= seconds.get(unit[0], 0.0)
            if left < 0 and len(own) >= partition.blocks_per_task:
                break
            own.append(unit)
        kept.append(own)
    return kept


def _print_script(one: Standing, array_size: int) -> None:
    if not one.wanted:
        print(f"# {one.name}: nothing to submit")
        return
    job, path = _plan_job(one, array_size)
    points = sum(one.wanted[unit] for task in job.tasks for unit in task)
    print(f"# {one.name}: {points} processes in {len(job.tasks)} tasks")
    print(_script_of(one, job, path))


def _array_size_or_default() -> int:
    try:
        return scheduler.max_array_size()
    except InputError as error:
        warn(f"{error}; MaxArraySize is taken to be {DEFAULT_MAX_ARRAY_SIZE}, Slurm's default")
        return DEFAULT_MAX_ARRAY_SIZE


def _script_of(one: Standing, job: Job, manifest: Path) -> str:
    programs = one.study.site.programs
    return render(job.name, one.folder.partition, manifest, len(job.tasks), programs)


def render(job: str, partition: Partition, manifest: Path, tasks: int, programs: Mapping[str, str]) -> str:
    """The script of an array of `tasks` tasks that work through `manifest`.

    Every value that is put into the template is quoted, so that no shell takes one for anything but a word.
    Raises InputError for a program that is to be built in the job but that this project does not know how to
    build, and for a value that would not stay within its line.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        undefined=jinja2.StrictUndefined,
        finalize=_word,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    folder = manifest.parent.parent
    return environment.get_template("job.sh.jinja").render(
        job=job,
        partition=partition,
        asks_for_memory=any(one.split("=")[0] in _OF_MEMORY for one in partition.arguments),
        last_task=tasks - 1,
        builds=_builds(folder / "build", programs) if partition.build else [],
        folder=folder,
        root=ROOT,
        python=sys.executable,
        manifest=manifest,
        # In a file name Slurm puts %a and the like in place; a % of the folder's own is written twice.
        log=str(manifest.with_suffix("")).replace("%", "%%"),
    )


def _word(value: object) -> str:
    """A value as one word of a shell. In a comment that Slurm reads it has to stay within its line: at the
    line's end bash would go on reading.
    """
    text = str(value)
    if not text.isprintable() or any(sign in text for sign in "'\"\\#"):
        raise InputError(
            f"{text!r}: cannot be said in a batch script; expected no quotes, backslashes, # and line ends"
        )
    return shlex.quote(text)


def _builds(folder: Path, programs: Mapping[str, str]) -> list[tuple[str, Path]]:
    """C++ compiler and build folder of each program."""
    for name, relative in programs.items():
        if name not in COMPILERS or relative != f"{name}/carom":
            known = ", ".join(f'{one} = "{one}/carom"' for one in COMPILERS)
            raise InputError(f'programs.{name}: found "{relative}"; a job can build {known}, and no others')
    return [(COMPILERS[name], folder / name) for name in programs]
