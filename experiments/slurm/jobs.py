"""What was handed to Slurm and what is lacking: for each job array, the blocks that its tasks are to measure.

A job is written down before it is submitted, under the name it will have in the queue. It is never edited:
whether its blocks are measured is told by the records alone.
"""

import contextlib
import hashlib
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime, timedelta
from functools import cached_property
from pathlib import Path
from statistics import fmean
from typing import Any

from experiments.plan.cluster import Cluster, Partition
from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.plan.program import GENERATOR, find_programs
from experiments.plan.site import Machine, Site, load_site
from experiments.run.study import Settings, Study
from experiments.run.whole_blocks import WholeBlocks
from experiments.slurm.scheduler import Queue, TaskState
from experiments.support.digest import digest
from support.errors import InputError
from support.files import of_json, read_json, to_json

Unit = tuple[str, int]
"""An experiment and one of its blocks: what is measured within one allocation."""

MOST_CUT_OFF = 2
"""Blocks of an experiment that allocations may cut off, in those that the question asks for."""

_OF_ONE_RUN: dict[str, Any] = {"budget_seconds": None, "figures": False}
"""Settings that no job keeps: its tasks draw nothing, and Slurm limits their time."""


@dataclass(frozen=True)
class Job:
    """One job array: its name in the queue, the settings of the study, the units of each task; and in a word
    (`made_of`), by the experiment's name, what its blocks were made of and how long they might take.
    """

    name: str
    partition: str
    settings: Settings
    tasks: tuple[tuple[Unit, ...], ...]
    submitted_at: str
    made_of: Mapping[str, str]

    def content(self) -> dict[str, Any]:
        """As JSON."""
        kept = {key: value for key, value in asdict(self.settings).items() if key not in _OF_ONE_RUN}
        return {
            "name": self.name,
            "partition": self.partition,
            "tasks": self.tasks,
            "submitted_at": self.submitted_at,
            "made_of": dict(self.made_of),
            **{key: os.fspath(value) if isinstance(value, Path) else value for key, value in kept.items()},
        }


def read_job(path: Path) -> Job:
    """Raises InputError if the file does not hold a job."""
    content = read_json(path)
    try:
        defaults = {key: value for key, value in vars(Settings()).items() if key not in _OF_ONE_RUN}
        kept = {key: _like(default, content[key]) for key, default in defaults.items()}
        tasks = tuple(tuple((str(name), int(block)) for name, block in task) for task in content["tasks"])
        settings = Settings(**_OF_ONE_RUN, **kept)
        made_of = {str(name): str(word) for name, word in content["made_of"].items()}
        return Job(content["name"], content["partition"], settings, tasks, content["submitted_at"], made_of)
    except (TypeError, KeyError, ValueError, AttributeError):
        raise InputError(f"{path}: is not the list of blocks of a job") from None


def _like(default: Any, value: Any) -> Any:  # noqa: ANN401 - read from a file
    """What JSON made of a setting, as its default is: a path of a text, a tuple of a list."""
    return value if default is None else type(default)(value)


class PartitionFolder:
    """The results of one partition: a results folder of its own, and `jobs/` beside the records."""

    def __init__(self, settings: Settings, site: Site, partition: Partition) -> None:
        self.settings = settings
        self.partition = partition
        self.path = results_of(settings, site) / partition.name
        self.jobs = self.path / "jobs"
        self._site = site

    @property
    def build(self) -> Path:
        """Where the programs of this kind of node are."""
        return self.path / "build" if self.partition.build else self.settings.build

    def study(self, *, to_be_built: bool = False) -> Study:
        """The study on this kind of node.

        Before the first job has built its programs there, `to_be_built` plans with those at hand: they know
        the names of the variants, and nothing has been measured with the ones that are still to come.
        """
        build = self.build
        if to_be_built and find_programs(self._site, build)[GENERATOR].sha256 is None:
            build = self.settings.build
        machine = Machine(self.partition.name, self.partition.cpus, self.partition.hardware_threads)
        return Study(replace(self.settings, results=self.path, build=build, figures=False), machine)

    def known_jobs(self) -> list[Job]:
        """All jobs ever submitted, the first one first."""
        return [read_job(path) for path in sorted(self.jobs.glob("*.json"))]

    def next_job(self, study: Study, tasks: Sequence[Sequence[Unit]]) -> tuple[Job, Path]:
        """A job of these tasks of the study with a name of its own, and the path to write it to."""
        numbers = [int(path.stem) for path in self.jobs.glob("*.json") if re.fullmatch(r"\d+", path.stem)]
        number = f"{max(numbers, default=0) + 1:04d}"
        # Another study of the same user may have jobs of the same number in the queue.
        folder = hashlib.sha256(os.fsencode(self.path)).hexdigest()[:8]
        name = f"carom-{self.partition.name}-{folder}-{number}"
        units = tuple(tuple(task) for task in tasks)
        now = self._after_all_others(datetime.now(UTC))
        words = {one.name: self.made_of(one) for one in study.experiments}
        return Job(name, self.partition.name, self.settings, units, now, words), self.jobs / f"{number}.json"

    def _after_all_others(self, now: datetime) -> str:
        """The time, or just after the last job of any partition: that may be of another login node, whose
        clock is ahead.
        """
        paths = self.path.parent.glob("*/jobs/*.json")
        last = max((read_job(path).submitted_at for path in paths), default="")
        with contextlib.suppress(ValueError):
            now = max(now, datetime.fromisoformat(last).astimezone(UTC) + timedelta(microseconds=1))
        return now.isoformat()

    def made_of(self, experiment: Experiment) -> str:
        """The points of an experiment and a task's time limit in a word: another one where any is another."""
        words = sorted(point.id for point in experiment.points)
        return digest(" ".join([*words, str(self.partition.minutes)]))


def folders(settings: Settings) -> list[PartitionFolder]:
    """One folder for each of the site's partitions. Raises InputError if the site is no cluster."""
    site = load_site(settings.site)
    cluster = cluster_of(site)
    given = Path(settings.site)
    chosen = replace(
        settings,
        site=os.fspath(given.absolute()) if given.suffix == ".toml" else settings.site,
        results=settings.results.absolute(),
        build=settings.build.absolute(),
        questions=settings.questions.absolute(),
    )
    return [PartitionFolder(chosen, site, partition) for partition in cluster.partitions]


def submitted(settings: Settings) -> Settings | None:
    """The settings of the last submission, with the questions of all others that differ in nothing else."""
    jobs = [job for folder in folders(settings) for job in folder.known_jobs()]
    if not jobs:
        return None
    last = max(jobs, key=lambda job: job.submitted_at).settings
    same = [job.settings for job in jobs if replace(job.settings, study=()) == replace(last, study=())]
    names = tuple(dict.fromkeys(name for chosen in same for name in chosen.study))
    return replace(last, study=names if all(chosen.study for chosen in same) else ())


def cluster_of(site: Site) -> Cluster:
    """Raises InputError if the site has none."""
    if site.cluster is None:
        raise InputError(f'site {site.name}: kind: found "{site.kind}", expected slurm')
    return site.cluster


def results_of(settings: Settings, site: Site) -> Path:
    """The folder of all partitions of a site: the one that it names, else `slurm/SITE` below the results."""
    return cluster_of(site).results or settings.results.absolute() / "slurm" / site.name


class Standing:
    """What of a study one partition has and lacks, by its records and by what Slurm still has."""

    def __init__(self, folder: PartitionFolder, study: Study, queue: Queue) -> None:
        self.folder = folder
        self.study = study
        self.name = folder.partition.name
        jobs = folder.known_jobs()
        self.is_active = any(self._tasks(jobs, queue, "lives"))
        """Whether tasks wait or run, of this study or of one at another scale."""
        self.jobs = [one for one in jobs if one.settings.scale == study.scale.name]
        self.running, self.waiting = (list(self._tasks(self.jobs, queue, what)) for what in ("runs", "waits"))
        waiting, running = (
            {unit for _, task, _ in tasks for unit in task} for tasks in (self.waiting, self.running)
        )
        self.active = dict.fromkeys(waiting, "waiting") | dict.fromkeys(running, "running")
        """What of the study waits or runs."""
        self.found = {one.name: study.store.find(one) for one in study.experiments}
        self.blocks = {one.name: self._blocks(one) for one in study.experiments}

    @staticmethod
    def _tasks(
        jobs: Iterable[Job], queue: Queue, what: str
    ) -> Iterator[tuple[Job, Sequence[Unit], TaskState]]:
        """The tasks of jobs that Slurm says are so, with their blocks."""
        for job in jobs:
            for index, task in enumerate(job.tasks):
                state = queue.get((job.name, index))
                if state is not None and getattr(state, what):
                    yield job, task, state

    def _blocks(self, one: Experiment) -> WholeBlocks:
        """The experiment's blocks; those that wait in a queue or run count, whatever they hold."""
        busy = {block for name, block in self.active if name == one.name}
        given, found = one.question.blocks.minimum, self.found[one.name]
        return WholeBlocks(one, given, found, self.study.store.session, busy=busy)

    @cached_property
    def missing(self) -> dict[Unit, list[Point]]:
        """What is not measured yet, by block; the first blocks of all experiments come before the second
        ones, so that the control is spread over all.
        """
        ends = {name: blocks.end() for name, blocks in self.blocks.items()}
        return {
            (name, block): [point for _, point in missing]
            for block in range(max(ends.values()))
            for name, blocks in self.blocks.items()
            if block < ends[name] and (missing := blocks.missing(block))
        }

    @cached_property
    def too_long(self) -> dict[str, int]:
        """The experiments of which so many blocks were cut off that no further ones are submitted, with their
        number: else a block that is longer than its allocation would be submitted for ever.
        """
        found = {}
        for one in self.study.experiments:
            made_of = self.folder.made_of(one)
            jobs = [job for job in self.jobs if job.made_of.get(one.name) == made_of]
            handed_out = {unit for job in jobs for task in job.tasks for unit in task if unit[0] == one.name}
            cut_off = sum(self.blocks[one.name].cut_off(block) for _, block in handed_out)
            if cut_off >= MOST_CUT_OFF * one.question.blocks.minimum:
                found[one.name] = cut_off
        return found

    @cached_property
    def wanted(self) -> dict[Unit, int]:
        """What is to be submitted, and the number of processes of each."""
        return {
            unit: len(points)
            for unit, points in self.missing.items()
            if unit not in self.active and unit[0] not in self.too_long
        }

    def said_of_too_long(self) -> list[str]:
        """Lines on what is not submitted any more."""
        return [
            f"{self.name}: {name}: {number} blocks were cut off before they were whole; no further ones are "
            "submitted: raise `minutes` in the site file"
            for name, number in self.too_long.items()
        ]


def tell(manifest: Path, index: int, **what: object) -> None:
    """Let a task of a job tell a line of itself, which is whole or, where its node died, the last. Durations
    are of its own node: nothing compares the clocks of two machines.
    """
    # It only helps to foretell: a task goes on without it.
    with contextlib.suppress(OSError), _told_by(manifest, index).open("ab") as file:
        file.write(to_json(what) + b"\n")


def _told_by(manifest: Path, index: int) -> Path:
    return manifest.with_name(f"{manifest.stem}-{index}.jsonl")


@dataclass
class Told:
    """What all tasks of a partition told, of one scale: the seconds of each whole block by experiment, and
    what they ran on.
    """

    seconds: dict[str, list[float]] = field(default_factory=dict)
    processors: set[str] = field(default_factory=set)

    @property
    def means(self) -> dict[str, float]:
        """Seconds of a block, by experiment."""
        return {name: fmean(values) for name, values in self.seconds.items()}

    def seconds_of(self, units: Sequence[Unit]) -> float:
        """How long blocks would take; one of an unknown experiment as long as others on average."""
        known = self.means
        usual = fmean(known.values()) if known else 0.0
        return sum(known.get(name, usual) for name, _ in units)


def read_told(jobs: Path, scale: str) -> Told:
    """What the tasks of a folder of jobs have told so far; nothing of a line that is no JSON."""
    told = Told()
    for manifest in sorted(jobs.glob("*.json")):
        job = read_job(manifest)
        files = (_told_by(manifest, index) for index in range(len(job.tasks)))
        for path in files if job.settings.scale == scale else ():
            for line in path.read_bytes().splitlines() if path.exists() else ():
                with contextlib.suppress(ValueError):
                    _take(told, of_json(line))
    return told


def _take(told: Told, line: object) -> None:
    match line:
        case {"processor": str() as processor}:
            told.processors.add(processor)
        case {"block": [str() as name, int()], "seconds": float() as seconds}:
            told.seconds.setdefault(name, []).append(seconds)
