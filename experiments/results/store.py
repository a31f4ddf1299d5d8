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
from experiments.plan.point import Point
from experiments.results.record import Record, is_failed, runs_of, unusable
from experiments.support.digest import digest
from support.files import locked, move, read_json, write_json
from support.record_schema import is_record

Key = tuple[str, int]
"""A point's id and a block's number."""


@dataclass
class Found:
    """What a results folder holds of one experiment."""

    seconds: dict[Key, float] = field(default_factory=dict)
    """What each measured point took of its process, in wall time."""
    runs: dict[Key, Sequence[float]] = field(default_factory=dict)
    """The seconds of each of its timed runs, in their order: what of the process was in the clock."""
    failures: dict[Key, str] = field(default_factory=dict)
    """The reason of each point that failed and was not measured since."""
    sessions: dict[Key, str] = field(default_factory=dict)
    """Which session measured it, or saw it fail."""
    files: dict[Key, Path] = field(default_factory=dict)
    """The record in which it is."""
    stale: dict[Path, int] = field(default_factory=dict)
    """Files that no longer belong to the plan, and how many contenders each has."""

    def take(self, record: Record, path: Path) -> None:
        """Count all contenders of a process."""
        for key, one in zip(keys_of(record), record["contenders"], strict=True):
            self.files[key], self.sessions[key] = path, str(one["tags"].get("session", ""))
            for there in (self.seconds, self.runs, self.failures):
                there.pop(key, None)
            if is_failed(one):
                self.failures[key] = one["reason"]
            else:
                self.seconds[key], self.runs[key] = float(one["process_seconds"]), runs_of(record, one)


class Store:
    """One results folder. Records come into `records/` whole and checked, by a rename."""

    def __init__(self, root: Path, session: str) -> None:
        self.root = root
        self.session = session
        self.temporary = root / ".running" / session

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

    def path(self, points: Sequence[str], experiment: str, block: int) -> Path:
        """Where the record of a process of these points belongs: a block has a folder of its own."""
        own = points[0] if len(points) == 1 else "p" + digest(" ".join(sorted(points)))
        return place_of(self.root / "records" / experiment, f"{own}-b{block}.json")

    def find(self, experiment: Experiment, block: int | None = None) -> Found:
        """What is there of an experiment, or of one block of it; reads only."""
        found, points = Found(), {point.id: point for point in experiment.points}
        for path in self.files(experiment.name, block):
            record = read_json(path)
            if self._path_of(record, points) == path:
                found.take(record, path)
            else:
                found.stale[path] = len(record["contenders"]) if is_record(record) else 1
        return found

    def files(self, experiment: str, block: int | None = None) -> list[Path]:
        """The files of an experiment, or of one block of it; what was collected is none of them."""
        folder = self.root / "records" / experiment
        return sorted(folder.rglob("*.json") if block is None else (folder / f"b{block}").glob("*.json"))

    def _path_of(self, record: Any, points: Mapping[str, Point]) -> Path | None:  # noqa: ANN401 - any JSON
        """Where a record belongs, if it is one and all its contenders are still planned as they were."""
        if not is_record(record):
            return None
        ids = [str(one["tags"].get("point")) for one in record["contenders"]]
        block = record["contenders"][0]["tags"].get("block")
        for contender, name in zip(record["contenders"], ids, strict=True):
            point = points.get(name)
            is_of_block = isinstance(block, int) and contender["tags"].get("block") == block
            if point is None or not is_of_block:
                return None
            if not is_failed(contender) and unusable(record, contender, point, block):
                return None
        return self.path(ids, points[ids[0]].experiment, block)

    def settle(self, experiment: Experiment) -> Found:
        """Move what is stale out of the way and bring back what fits the plan again; say what is there then.

        Nothing is deleted: going from one scale to the other and back measures nothing twice. What was
        measured anew since does not come back.
        """
        found, points = self.find(experiment), {point.id: point for point in experiment.points}
        for path in found.stale:
            self.retire(path)
        found.stale.clear()
        for path in sorted((self.root / "stale" / "records" / experiment.name).rglob("*.json")):
            record = read_json(path)
            target = self._path_of(record, points)
            if target is not None and found.files.keys().isdisjoint(keys_of(record)):
                move(path, target)
                found.take(record, target)
        return found

    def clear(self, found: Found, keys: Iterable[Key]) -> None:
        """Move the records out of the way in which these are: they are measured anew."""
        for path in {found.files[key] for key in keys if key in found.files}:
            self.retire(path)

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

    def keep(self, record: Record) -> Path:
        """Take in the record of a process; returns its place."""
        tags = [one["tags"] for one in record["contenders"]]
        path = self.path([one["point"] for one in tags], tags[0]["experiment"], tags[0]["block"])
        write_json(path, record, self.temporary)
        return path

    def keep_note(self, name: str, content: object) -> None:
        """Write `name`, a JSON file of the runner's own."""
        write_json(self.root / name, content, self.temporary)

    def note(self, name: str) -> Any:  # noqa: ANN401 - JSON is any value
        """The content of a file of the runner's own, or None."""
        return read_json(self.root / name)


def keys_of(record: Record) -> list[Key]:
    """What each contender of a record is: its point and its block."""
    return [(one["tags"]["point"], one["tags"]["block"]) for one in record["contenders"]]


def new_session() -> str:
    """An id for one invocation of the runner, and no other: the time in UTC and the process."""
    return f"{datetime.now(UTC):%Y%m%dT%H%M%S.%f}-{os.uname().nodename}-{os.getpid()}"


def measured_by_point(found: Iterable[Found]) -> dict[str, list[tuple[float, Sequence[float]]]]:
    """Wall time of each process and its timed runs, by point id over all experiments: equal ids are the same
    measurement.
    """
    measured: dict[str, list[tuple[float, Sequence[float]]]] = {}
    for one in found:
        for key, value in one.seconds.items():
            measured.setdefault(key[0], []).append((value, one.runs[key]))
    return measured


def place_of(folder: Path, name: str) -> Path:
    """Where a file of a folder for one experiment belongs: of a process in the folder of its block."""
    block = re.search(r"-(b[0-9]{1,9})\.json$", name)
    return folder / block[1] / name if block else folder / name
