"""What each task tells of itself, a line of JSON at a time, beside the list of blocks of its job.

Durations are of the task's own node: nothing here compares the clocks of two machines.
"""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import fmean
from typing import Any

from experiments.slurm.jobs import Unit, read_job
from support.files import of_json, to_json


class TaskLog:
    """Of one task; each line is whole or, where its node died, the last."""

    def __init__(self, manifest: Path, index: int) -> None:
        self._path = path_of(manifest.parent, manifest.stem, index)

    def begins(self, processor: str) -> None:
        """Tell what it runs on."""
        self._tell(processor=processor)

    def measured(self, unit: Unit, seconds: float) -> None:
        """Tell how long a whole block took."""
        self._tell(block=unit, seconds=seconds)

    def _tell(self, **what: object) -> None:
        # It only helps to foretell: a task goes on without it.
        with contextlib.suppress(OSError), self._path.open("ab") as file:
            file.write(to_json(what) + b"\n")


@dataclass
class Told:
    """By all tasks of a partition, of one scale."""

    seconds: dict[str, list[float]] = field(default_factory=dict)
    """Of each whole block that was measured, by experiment."""
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
    """What the tasks of a folder of jobs have told so far."""
    told = Told()
    for manifest in sorted(jobs.glob("*.json")):
        job = read_job(manifest)
        if job.settings.scale == scale:
            for index in range(len(job.tasks)):
                _take(told, lines(path_of(jobs, manifest.stem, index)))
    return told


def path_of(jobs: Path, job: str, index: int) -> Path:
    """Where a task of a job tells of itself."""
    return jobs / f"{job}-{index}.jsonl"


def lines(path: Path) -> list[dict[str, Any]]:
    """What one task told; nothing of a line that is no JSON."""
    found = []
    with contextlib.suppress(OSError):
        for line in path.read_bytes().splitlines():
            with contextlib.suppress(ValueError):
                found.append(of_json(line))
    return [one for one in found if isinstance(one, dict)]


def _take(told: Told, found: Sequence[dict[str, Any]]) -> None:
    for one in found:
        match one:
            case {"processor": str() as processor}:
                told.processors.add(processor)
            case {"block": [str() as name, int()], "seconds": float() as seconds}:
                told.seconds.setdefault(name, []).append(seconds)
