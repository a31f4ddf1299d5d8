"""The results folder: what is done, missing, failed or stale, decided by the files alone."""

import contextlib
import os
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from experiments.plan.plan import Experiment
from experiments.plan.point import Point, Tags
from experiments.results.index import Index
from experiments.results.summary import Summary, summary_of, unusable
from experiments.support.process import Completed
from support.files import locked, move, read_json, write_json

_Summaries = Mapping[str, Summary | None]

Key = tuple[str, int]
"""A point's id and a block's number: one process, one record."""


@dataclass
class Found:
    """What a results folder holds of one experiment."""

    seconds: dict[Key, float] = field(default_factory=dict)
    """Whole-process wall time of each finished process."""
    runs: dict[Key, Sequence[float]] = field(default_factory=dict)
    """The seconds of each of its timed runs, in their order: what of the process was in the clock."""
    sessions: dict[Key, str] = field(default_factory=dict)
    """Which session measured it."""
    failures: dict[Key, str] = field(default_factory=dict)
    """Reason of each failed process that has not been measured since."""
    stale: list[Path] = field(default_factory=list)
    """Files that no longer belong to the plan."""

    def take(self, key: Key, seconds: float, runs: Sequence[float], session: str) -> None:
        """Count a process that was measured."""
        self.seconds[key], self.runs[key], self.sessions[key] = seconds, runs, session
        self.failures.pop(key, None)


class Store:
    """One results folder. Records come into `records/` whole and checked, by a rename."""

    def __init__(self, root: Path, session: str) -> None:
        self.root = root
        self.session = session
        self.temporary = root / ".running" / session
        self._index = Index(root)

    @contextmanager
    def opened(self) -> Iterator[None]:
        """Hold the folder and clear away what a killed run left half-written."""
        with locked(self.root):
            shutil.rmtree(self.root / ".running", ignore_errors=True)
            self.temporary.mkdir(parents=True)
            try:
                yield
            finally:
                shutil.rmtree(self.root / ".running", ignore_errors=True)

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Work in the folder beside others that do so: only what is this session's own is cleared away."""
        self.temporary.mkdir(parents=True)
        try:
            yield
        finally:
            shutil.rmtree(self.temporary, ignore_errors=True)

    def record_path(self, point: Point, block: int) -> Path:
        """Where the record of one process belongs."""
        return place_of(self.root / "records" / point.experiment, f"{point.id}-b{block}.json")

    def failure_path(self, point: Point, block: int) -> Path:
        """Where the failure of one process belongs."""
        return place_of(self.root / "failures" / point.experiment, f"{point.id}-b{block}.json")

    def find(self, experiment: Experiment) -> Found:
        """What is there of an experiment; reads only."""
        records, failures = (self._index.summaries(kind, experiment.name) for kind in ("records", "failures"))
        return self._sorted(experiment, records, failures)

    def find_block(self, experiment: Experiment, block: int) -> Found:
        """What is there of one block: only files of its own names are read, however many others there are."""
        names = [f"{point.id}-b{block}.json" for point in experiment.points]
        records, failures = (
            {
                name: summary_of(read_json(place_of(self.root / kind / experiment.name, name)))
                for name in names
            }
            for kind in ("records", "failures")
        )
        return self._sorted(experiment, records, failures)

    def _sorted(self, experiment: Experiment, records: _Summaries, failures: _Summaries) -> Found:
        points = {point.id: point for point in experiment.points}
        found = Found()
        for name, summary in records.items():
            key = _key(name)
            point = points.get(key[0]) if key else None
            if key is None or point is None or unusable(summary, point, key[1]):
                found.stale.append(self.root / "records" / experiment.name / name)
            else:
                assert summary is not None
                found.take(key, summary.seconds, summary.runs, str(summary.tags.get("session", "")))
        for name, summary in failures.items():
            key = _key(name)
            is_failure = summary is not None and summary.kind == "failure"
            if key is None or key[0] not in points or key in found.seconds or not is_failure:
                found.stale.append(self.root / "failures" / experiment.name / name)
            else:
                assert summary is not None
                found.failures[key] = summary.reason
        return found

    def has(self, point: Point, block: int) -> bool:
        """Whether one process has been measured by now, perhaps by someone else."""
        return unusable(summary_of(read_json(self.record_path(point, block))), point, block) is None

    def settle(self, experiment: Experiment) -> Found:
        """Move what is stale out of the way and bring back what fits the plan again; say what is there then.

        Nothing is deleted: going from one scale to the other and back measures nothing twice.
        """
        for path in self.find(experiment).stale:
            self.retire(path)
        points = {point.id: point for point in experiment.points}
        for path in (self.root / "stale" / "records" / experiment.name).rglob("*.json"):
            key = _key(path.name)
            point = points.get(key[0]) if key else None
            if key is None or point is None:
                continue
            target = self.record_path(point, key[1])
            if not target.exists() and not unusable(summary_of(read_json(path)), point, key[1]):
                move(path, target)
        return self.find(experiment)

    def retire(self, path: Path) -> None:
        """Move a file below `stale/`, beside any earlier one of the same name."""
        target = self.root / "stale" / path.relative_to(self.root)
        number = 0
        while os.path.lexists(target):
            number += 1
            target = target.with_name(f"{path.stem}.{number}.json")
        # Whoever else settles the same folder may have been faster.
        with contextlib.suppress(FileNotFoundError):
            move(path, target)

    def keep_record(self, point: Point, block: int, scratch: Path) -> None:
        """Take in a finished record; an earlier failure of the same process is history then."""
        path, failure = self.record_path(point, block), self.failure_path(point, block)
        move(scratch, path)
        if failure.exists():
            self.retire(failure)

    def keep_failure(self, point: Point, block: int, done: Completed, tags: Tags) -> None:
        """Record that a process failed, why, where and with which program."""
        failure = {
            "schema_version": 1,
            "kind": "failure",
            "tags": {**tags, **_where(point)},
            "axes": point.axes,
            "command": list(done.command),
            "exit_code": done.exit_code,
            "reason": done.reason,
            "recorded_at": datetime.now(UTC).isoformat(timespec="seconds"),
        }
        write_json(self.failure_path(point, block), failure, self.temporary)

    def keep_note(self, name: str, content: object) -> None:
        """Write `name`, a JSON file of the runner's own."""
        write_json(self.root / name, content, self.temporary)

    def note(self, name: str) -> Any:  # noqa: ANN401 - JSON is any value
        """The content of a file of the runner's own, or None."""
        return read_json(self.root / name)


def _where(point: Point) -> Tags:
    """The host, the partition under Slurm and the program: what a record of the process would tell."""
    told = {
        "host": os.uname().nodename,
        "partition": os.environ.get("SLURM_JOB_PARTITION"),
        "program_sha256": point.program.sha256,
    }
    return {key: value for key, value in told.items() if value}


def new_session() -> str:
    """An id for one invocation of the runner, and no other: the time in UTC and the process."""
    return f"{datetime.now(UTC):%Y%m%dT%H%M%S.%f}-{os.uname().nodename}-{os.getpid()}"


def measured_by_point(found: Iterable[Found]) -> dict[str, list[tuple[float, Sequence[float]]]]:
    """Wall time of each whole process and its timed runs, by point id over all experiments: equal ids are the
    same measurement.
    """
    measured: dict[str, list[tuple[float, Sequence[float]]]] = {}
    for one in found:
        for key, value in one.seconds.items():
            measured.setdefault(key[0], []).append((value, one.runs.get(key, ())))
    return measured


def place_of(folder: Path, name: str) -> Path:
    """Where a file of a folder for one experiment belongs: of a process below the first three letters of its
    point's id, so that no folder holds a hundred thousand files.
    """
    return folder / name[:3] / name if _key(name) else folder / name


_NAME = re.compile(r"(.*?)-b([0-9]{1,9})\.json", re.DOTALL)


def _key(name: str) -> Key | None:
    """Of a file's name, with folders or without."""
    found = _NAME.fullmatch(name, name.rfind("/") + 1)
    return (found[1], int(found[2])) if found else None
