"""Files that are whole or not there, and a folder that has one user at a time."""

import contextlib
import errno
import fcntl
import hashlib
import json
import math
import os
import re
import stat
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import orjson

from support.errors import InputError, require_text

FLEETING: set[Path] = set()
"""Folders that vanish with this process: what is in them need not outlast a failure of power."""

_STREAMS = {"-": 1, "/dev/stdin": 0, "/dev/stdout": 1, "/dev/stderr": 2}


def require_room_for_folder(what: str, folder: Path) -> None:
    """Raises InputError where something else stands in the place of a folder, or of one that it is in, and
    for a path that is no text.
    """
    require_text(what, folder.absolute())
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not there.is_dir():
        raise InputError(f"{what}: found {there}, which is no folder, expected one or a place for one")


def require_place(what: str, path: Path) -> None:
    """Raises InputError where no file can be written: a folder is there, or the folder may not be changed.
    Streams have a place (`write_out`).
    """
    if descriptor_of(path) is not None or (path.exists() and not path.is_dir() and not path.is_file()):
        return
    if path.is_dir():
        raise InputError(f"{what}: found {path}, which is a folder, expected a place for a file")
    try:
        folder = path.resolve().parent
    except RuntimeError as error:
        raise InputError(f"{what}: found {path}, which is a link to itself, expected a file") from error
    if path.exists() and not os.access(path, os.W_OK):
        raise InputError(f"{what}: found {path}, expected a file that you may write")
    require_text(what, folder)
    if not folder.is_dir():
        raise InputError(f"{what}: found {path}, expected a file in a folder that is there")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{what}: found {path}, expected a file in a folder that you may write into")


def descriptor_of(path: Path) -> int | None:
    """The open file that a name such as `-` or /dev/stdout stands for; None for any other name."""
    found = re.fullmatch(r"/(?:dev/fd|proc/self/fd)/(\d+)", os.fspath(path))
    return int(found[1]) if found else _STREAMS.get(os.fspath(path))


def write_out(path: Path, text: str) -> None:
    """Write a text: a file whole or not at all, anything else, such as a pipe, as the stream that it is.
    Raises OSError that names it, or InputError.
    """
    number = descriptor_of(path)
    is_stream = number is not None or (path.exists() and not path.is_file())
    if not is_stream:
        with replacing(path) as part:
            part.write_text(text, encoding="utf-8")
        return
    try:
        opened = os.dup(number) if number is not None else _opened(path)
        with os.fdopen(opened, "w", encoding="utf-8") as stream:
            stream.write(text)
    except OSError as error:
        raise InputError(
            f"{path}: {error.strerror or error}, expected room, and somebody who reads it"
        ) from error


def _opened(path: Path) -> int:
    """Something that is no regular file, for writing. Who is to read from a pipe has some seconds to come."""
    until = time.monotonic() + 10
    while True:
        try:
            opened = os.open(path, os.O_WRONLY | os.O_NONBLOCK)
        except OSError as error:
            if error.errno != errno.ENXIO or time.monotonic() > until:
                raise
            time.sleep(0.05)
        else:
            os.set_blocking(opened, True)
            return opened


def read_json(path: Path) -> Any:  # noqa: ANN401 - JSON is any value
    """The content of a JSON file, or None if it is missing or not JSON, which has no NaN and no infinity."""
    try:
        return of_json(path.read_bytes())
    except (OSError, ValueError):
        return None


def of_json(text: bytes) -> Any:  # noqa: ANN401 - JSON is any value
    """The content of a text. Raises ValueError for what is not JSON, such as NaN."""
    return orjson.loads(text)


def digest_of(content: object) -> str:
    """The SHA-256 of what a JSON file holds: how it is written does not matter."""
    return hashlib.sha256(orjson.dumps(content, option=orjson.OPT_SORT_KEYS)).hexdigest()


def finite(text: str) -> float:
    """The number that a text of JSON or TOML is. Raises ValueError for NaN and infinity, whatever a parser
    makes of them.
    """
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"found {text}, expected a finite number")
    return number


def write_json(path: Path, content: object, temporary: Path) -> None:
    """Write a JSON file, as `write_text` does."""
    write_text(path, json.dumps(content, indent=1, sort_keys=True) + "\n", temporary)


def write_text(path: Path, text: str, temporary: Path) -> None:
    """Write a file so that a power failure leaves the old one or the new one, never a part of one.

    Meanwhile it is `.*.part` in `temporary`, a folder on the same disk.
    """
    with _becoming(path, temporary / f".{path.parent.name}-{path.name}.part") as part:
        part.write_text(text, encoding="utf-8")


def move(source: Path, target: Path) -> None:
    """Rename a finished file into its place, folders made as needed, and make the rename last."""
    target.parent.mkdir(parents=True, exist_ok=True)
    source.replace(target)
    _make_last(target.parent)


def _make_last(path: Path) -> None:
    """Wait until it is on the disk, unless it vanishes anyway."""
    if not FLEETING.isdisjoint((path, *path.parents)):
        return
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the folder for this process; the kernel lets go of it however the process ends.

    Raises InputError if another process holds it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / ".lock").open("a+", encoding="ascii") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.seek(0)
            holder = file.read().strip() or "another process"
            told = f"{folder}: is in use by {holder}; wait for it, or give --results FOLDER"
            raise InputError(told) from None
        file.seek(0)
        file.truncate()
        file.write(f"process {os.getpid()} on {os.uname().nodename}\n")
        file.flush()
        yield


@contextlib.contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Give a path to write to, which becomes the target once all of it is on the disk.

    Meanwhile it is `.NAME.part.SUFFIX` beside the target; if writing fails it is gone, and an earlier target
    as it was. Makes the folder; follows links. Raises OSError that names the target, also for one that is no
    regular file.
    """
    target = target.resolve() if target.is_symlink() else target
    if target.exists() and not target.is_file():
        raise OSError(errno.EINVAL, "is no regular file", os.fspath(target))
    if target.exists() and not os.access(target, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES), os.fspath(target))
    target.parent.mkdir(parents=True, exist_ok=True)
    with _becoming(target, target.with_name(f".{target.stem}.part{target.suffix}")) as part:
        yield part
        if target.exists():
            before = target.stat()
            part.chmod(stat.S_IMODE(before.st_mode))
            with contextlib.suppress(PermissionError):
                os.chown(part, before.st_uid, before.st_gid)


@contextlib.contextmanager
def _becoming(target: Path, part: Path) -> Iterator[Path]:
    try:
        yield part
        _make_last(part)
        move(part, target)
    except BaseException as error:
        with contextlib.suppress(OSError):
            part.unlink()
        if isinstance(error, OSError) and error.filename in (None, os.fspath(part)):
            raise OSError(error.errno, error.strerror or str(error), os.fspath(target)) from error
        raise
