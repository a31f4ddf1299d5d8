"""What the files of a results folder hold, kept in memory and beside them, so that each is read once.

The files alone are the truth. What is kept of one counts as long as its size, its time and its number on the
disk are those that it had when it was read. It is written whole, by a rename, so that no reader ever sees a
part of it, whoever else writes at the same time. Missing, older or damaged it is made again; where it cannot
be written, the files are read each time.
"""

import contextlib
import hashlib
import os
import time
from dataclasses import dataclass
from pathlib import Path

from experiments.results.summary import Summary, packed, summary_of, unpacked
from support.files import of_json, read_json, to_json
from support.record_schema import SCHEMA_FILE

VERSION = 1

FOLDER = "index"
"""Below the results; it may be removed at any time."""

_OLD_ENOUGH = 2.0
"""Seconds since a file was changed: an older one would have another time if it were changed again."""

_FEW, _SHARE = 20, 0.02
"""What is new is kept once it is more than so many files and than that share of all."""

Stamp = tuple[int, int, int]
"""Of a file: its size, its time in nanoseconds, its number on the disk."""


@dataclass(frozen=True, slots=True)
class _Row:
    stamp: Stamp | None
    """None of a file that cannot be looked at, or was changed too short a time ago."""
    summary: Summary | None


class Index:
    """Of one results folder."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._rows: dict[tuple[str, str], dict[str, _Row]] = {}

    def summaries(self, kind: str, experiment: str) -> dict[str, Summary | None]:
        """Return what each file of `records/EXPERIMENT` or `failures/EXPERIMENT` holds, by name and in the
        order of their names; None of a file that is no record.
        """
        folder = self._root / kind / experiment
        before = self._rows.get((kind, experiment))
        if before is None:
            before = self._kept(kind, experiment)
        rows: dict[str, _Row] = {}
        new = 0
        for name, stamp in _files(folder):
            row = before.get(name)
            if row is None or stamp is None or row.stamp != stamp:
                is_old = stamp is not None and time.time() - stamp[1] * 1e-9 > _OLD_ENOUGH
                row = _Row(stamp if is_old else None, summary_of(read_json(folder / name)))
                new += 1
            rows[name] = row
        self._rows[kind, experiment] = rows
        if new + len(before.keys() - rows.keys()) > _FEW + _SHARE * len(rows):
            self._keep(kind, experiment, rows)
        return {name: row.summary for name, row in rows.items()}

    def _file(self, kind: str, experiment: str) -> Path:
        return self._root / FOLDER / f"{kind}-{experiment}.json"

    def _kept(self, kind: str, experiment: str) -> dict[str, _Row]:
        """What an earlier process has written; nothing of anything else."""
        with contextlib.suppress(OSError, ValueError):
            head, _, body = self._file(kind, experiment).read_bytes().partition(b"\n")
            if head == _head(body):
                rows = of_json(body)
                return {name: _Row(_stamp(row[0]), unpacked(row[1])) for name, row in rows.items()}
        return {}

    def _keep(self, kind: str, experiment: str, rows: dict[str, _Row]) -> None:
        told = {name: [row.stamp, packed(row.summary)] for name, row in rows.items() if row.stamp is not None}
        file = self._file(kind, experiment)
        # Of its own, since others may write at the same time.
        part = file.with_name(f".{file.stem}.{os.getpid()}.part")
        with contextlib.suppress(OSError):
            file.parent.mkdir(exist_ok=True)
            try:
                body = to_json(told)
                part.write_bytes(_head(body) + b"\n" + body)
                part.replace(file)
            finally:
                part.unlink(missing_ok=True)


def _files(folder: Path) -> list[tuple[str, Stamp | None]]:
    """The JSON files of a folder with their stamps; none of a folder that is not there."""
    found: list[tuple[str, Stamp | None]] = []
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.endswith(".json"):
                found.append((entry.name, _stamp_of(entry)))
    return sorted(found)


def _stamp_of(entry: "os.DirEntry[str]") -> Stamp | None:
    try:
        status = entry.stat()
    except OSError:
        return None  # it is gone, or a link to nothing
    return status.st_size, status.st_mtime_ns, status.st_ino


def _stamp(told: object) -> Stamp:
    match told:
        case [int() as size, int() as changed, int() as number]:
            return size, changed, number
    raise ValueError("is no stamp of a file")


def _head(body: bytes) -> bytes:
    """The first line of the file: by which program it was written, what a record was to it, and a sum over
    the rest, so that one damaged byte is noticed.
    """
    schema = hashlib.sha256(SCHEMA_FILE.read_bytes()).hexdigest()
    return f"{VERSION} {schema} {hashlib.sha256(body).hexdigest()}".encode()
