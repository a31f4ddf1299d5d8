"""The files that make up a program, and which of them another hand changed while it ran."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.plan.scenes import sha256_of
from support.errors import InputError

Touched = tuple[int, int, int, int] | None
"""What tells that a file was written, if only what it held before: None if it is not there."""


class Sources:
    """The files that make up a program, each with its SHA-256 before it ran."""

    def __init__(self, files: Sequence[Path], written: Mapping[Path, str]) -> None:
        """`written` are those that the program is known to write itself, each with the hash that stands for
        it, whatever it holds now. Raises InputError for a file that cannot be read.
        """
        self.files = files
        self.hashes = {file: written.get(file) or sha256_of(file) for file in files}
        self._touched = {file: touch_of(file) for file in files if file not in written}

    def changed(self) -> list[Path]:
        """Those that hold something else by now, the written ones left out."""
        touched = [file for file, touch in self._touched.items() if touch_of(file) != touch]
        return [file for file in touched if _hash_or_none(file) != self.hashes[file]]


def touch_of(file: Path) -> Touched:
    """What changes with each time that a file is written."""
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns, found.st_ctime_ns


def _hash_or_none(path: Path) -> str | None:
    try:
        return sha256_of(path)
    except InputError:
        return None  # it is gone, which is a change
