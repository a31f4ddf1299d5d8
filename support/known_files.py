"""What is known of a folder's files, kept beside them, so that each is read once.

The files alone are the truth. What is known of one counts as long as its size, its time and its number on the
disk are those that it had when it was read. What is kept is written whole, by a rename, so that no reader
ever sees a part of it, whoever else writes at the same time; no lock is asked for, which a network file
system may not have. Missing, older or damaged it is made again; where it cannot be written, the files are
read each time.
"""

import contextlib
import hashlib
import os
import time
from collections.abc import Iterator
from pathlib import Path

from support.record_schema import SCHEMA_FILE

FOLDER = "index"
"""Below the results; it may be removed at any time."""

_OLD_ENOUGH = 2.0
"""Seconds since a file was changed: an older one would have another time if it were changed again."""

_FEW, _SHARE = 20, 0.02
"""What is new is kept once it is more than so many files and than that share of all."""

Stamp = tuple[int, int, int]
"""Of a file: its size, its time in nanoseconds, its number on the disk."""


def files_below(folder: Path) -> list[tuple[str, Stamp | None]]:
    """Return the JSON files below a folder in the order of their paths, each by its path from the folder;
    none of a folder that is not there. The stamp is None where a file cannot be looked at.
    """
    return sorted(_walk(os.fspath(folder), ""), key=lambda one: one[0].split("/"))


def _walk(folder: str, prefix: str) -> Iterator[tuple[str, Stamp | None]]:
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.endswith(".json"):
                yield prefix + entry.name, _stamp_of(entry)
            elif entry.is_dir(follow_symlinks=False):
                yield from _walk(entry.path, f"{prefix}{entry.name}/")


def _stamp_of(entry: "os.DirEntry[str]") -> Stamp | None:
    try:
        status = entry.stat()
    except OSError:
        return None  # it is gone, or a link to nothing
    return status.st_size, status.st_mtime_ns, status.st_ino


def lasting(stamp: Stamp | None) -> Stamp | None:
    """Return the stamp of a file that was read just now if it tells any later change; None if it may not: the
    clock that stamps files ticks slowly, and a change within a tick leaves the time as it is.
    """
    is_old = stamp is not None and time.time() - stamp[1] * 1e-9 > _OLD_ENOUGH
    return stamp if is_old else None


def is_worth_keeping(changed: int, files: int) -> bool:
    """Whether so many files, of so many, that are new, changed or gone are worth writing down again."""
    return changed > _FEW + _SHARE * files


def kept(file: Path, version: int) -> bytes | None:
    """Return what was kept in a file by the same version of a program; None if there is nothing, or something
    else.
    """
    with contextlib.suppress(OSError):
        head, _, body = file.read_bytes().partition(b"\n")
        if head == _head(body, version):
            return body
    return None


def keep(file: Path, body: bytes, version: int) -> None:
    """Keep it, if it can be written."""
    # Of its own, since others may write at the same time.
    part = file.with_name(f".{file.stem}.{os.getpid()}.part")
    with contextlib.suppress(OSError):
        file.parent.mkdir(exist_ok=True)
        try:
            part.write_bytes(_head(body, version) + b"\n" + body)
            part.replace(file)
        finally:
            part.unlink(missing_ok=True)


def _head(body: bytes, version: int) -> bytes:
    """The first line of the file: by which version it was written, what a record was to it, and a sum over
    the rest, so that one damaged byte is noticed.
    """
    schema = hashlib.sha256(SCHEMA_FILE.read_bytes()).hexdigest()
    return f"{version} {schema} {hashlib.sha256(body).hexdigest()}".encode()
