"""What was handed to Slurm and what is lacking: for each job array, the blocks that its tasks are to measure.

A job is written down before it is submitted, under the name it will have in the queue. It is never edited:
whether its blocks are measured, and how long that took, is told by the records alone.
"""

import hashlib
import os
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from statistics import fmean
from typing import Any

from experiments.plan.cluster import Cluster, Partition
from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.plan.program import GENERATOR, find_programs
from experiments.plan.site import Machine, Site, load_site
from experiments.run.missing import missing
from experiments.run.progress import about
from experiments.run.study import Settings, Study
from experiments.slurm.scheduler import Queue
from support.errors import InputError
from support.files import read_json

Unit = tuple[str, int]
"""An experiment and one of its blocks: what is measured within one allocation."""

_OF_ONE_RUN: dict[str, Any] = {"budget_seconds": None, "figures": False}
"""Settings that no job keeps: its tasks draw nothing, and Slurm limits their time."""


@dataclass(frozen=True)
class Job:
    """One job array: its name in the queue, the settings of the study, and the units of each task."""

    name: str
    partition: str
    settings: Settings
    tasks: tuple[tuple[Unit, ...], ...]

    @property
    def number(self) -> int:
        """Which of the jobs of all partitions it is, from 1 on: no clock is compared with another one's."""
        return int(self.name.rpartition("-")[2])

    def content(self) -> dict[str, Any]:
        """As JSON."""
        kept = {key: value for key, value in asdict(self.settings).items() if key not in _OF_ONE_RUN}
        return {
            "name": self.name,
            "partition": self.partition,
            "tasks": self.tasks,
            **{key: os.fspath(value) if isinstance(value, Path) else value for key, value in kept.items()},
        }


def read_job(path: Path) -> Job:
    """Raises InputError if the file does not hold a job."""
    content = read_json(path)
    try:
        defaults = {key: value for key, value in vars(Settings()).items() if key not in _OF_ONE_RUN}
        kept = {key: _like(default, content[key]) for key, default in defaults.items()}
        tasks = tuple(tuple((str(name), int(block)) for name, block in task) for task in content["tasks"])
        return Job(content["name"], content["partition"], Settings(**_OF_ONE_RUN, **kept), tasks)
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

    def next_job(self, tasks: Sequence[Sequence[Unit]]) -> tuple[Job, Path]:
        """A job of these tasks with a name of its own, and the path to write it to."""
        known = (path.stem for path in self.path.parent.glob("*/jobs/*.json"))
        number = 1 + max((int(stem) for stem in known if re.fullmatch(r"\d+", stem)), default=0)
        # Another study of the same user may have jobs of the same number in the queue.
        folder = hashlib.sha256(os.fsencode(self.path)).hexdigest()[:8]
        name = f"carom-{self.partition.name}-{folder}-{number:04d}"
        units = tuple(tuple(task) for task in tasks)
        return Job(name, self.partition.name, self.settings, units), self.jobs / f"{number:04d}.json"


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
    last = max(jobs, key=lambda job: job.number).settings
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
        living = [
            (job, task, state)
            for job in jobs
            for index, task in enumerate(job.tasks)
            if (state := queue.get((job.name, index))) is not None and state.lives
        ]
        self.is_active = bool(living)
        """Whether tasks wait or run, of this study or of one at another scale."""
        self.jobs = [one for one in jobs if one.settings.scale == study.scale.name]
        self.tasks = [one for one in living if one[0].settings.scale == study.scale.name]
        """Those of the study that wait or run, each with its job, its blocks and its state."""
        self.active = {
            unit: "running" if state.runs else "waiting" for _, task, state in self.tasks for unit in task
        }
        """What of the study waits or runs."""
        self.found = {one.name: study.store.find(one) for one in study.experiments}
        self.block_seconds = {
            one.name: len(one.points) * fmean(self.found[one.name].seconds.values())
            for one in study.experiments
            if self.found[one.name].seconds
        }
        """About how long a block takes, of the experiments of which something was measured."""

    @cached_property
    def missing(self) -> dict[Unit, list[Point]]:
        """What is not measured yet, by block; the first blocks of all experiments come before the second
        ones, so that the control is spread over all.
        """
        least = [one.question.blocks.minimum for one in self.study.experiments]
        return {
            (one.name, block): points
            for block in range(max(least))
            for one in self.study.experiments
            if block < one.question.blocks.minimum and (points := self._missing(one, block))
        }

    def _missing(self, one: Experiment, block: int) -> list[Point]:
        """What a block lacks; of one that runs or waits what is there is not taken for unfinished."""
        found, is_active = self.found[one.name], (one.name, block) in self.active
        return [
            point
            for _, point in missing(one, found, block, self.study.store.session)
            if not (is_active and (point.id, block) in found.seconds)
        ]

    @cached_property
    def wanted(self) -> dict[Unit, int]:
        """What is to be submitted, and the number of processes of each."""
        return {
            unit: len(points)
            for unit, points in self.missing.items()
            if unit not in self.active and unit[0] not in self.too_long
        }

    @cached_property
    def too_long(self) -> list[str]:
        """The experiments of which blocks were cut off and take longer than an allocation: what measures
        another one would be submitted for ever.
        """
        most = self.folder.partition.measuring_seconds
        begun = {(name, block) for name, found in self.found.items() for _, block in found.seconds}
        cut_off = {name for name, _ in (begun & self.missing.keys()) - self.active.keys()}
        return [name for name, took in self.block_seconds.items() if took > most and name in cut_off]

    def said_of_too_long(self) -> list[str]:
        """Lines on what is not submitted any more."""
        return [
            f"{self.name}: {name}: a block takes about {about(self.block_seconds[name])}, more than a task "
            "has; no further ones are submitted: raise `minutes` in the site file"
            for name in self.too_long
        ]
