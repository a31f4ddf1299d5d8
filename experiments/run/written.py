"""Files among a program's words that it writes: what they hold says nothing of whether it was built anew.

The first run of a program that writes one of its files changes it, and so does somebody who builds that file
anew. So the program is run a second time: who writes it touches it again. What is written is kept in a note,
with the SHA-256 that it had before, so that ids stay what they were.
"""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from experiments.plan.executable import is_file
from experiments.plan.program import Program
from experiments.plan.scenes import sha256_of
from experiments.results.store import Store
from support.errors import InputError

NOTE = "written.json"

Touched = tuple[int, int, int, int] | None
"""What tells that a file was written, if only what it held before: None if it is not there."""


def first_seen(store: Store) -> dict[str, str | None]:
    """Each file that is known to be written, with its SHA-256 before that, or None where it was not there."""
    kept = store.note(NOTE)
    items = kept.items() if isinstance(kept, dict) else ()
    return {str(name): value for name, value in items if value is None or isinstance(value, str)}


@dataclass(frozen=True)
class Sources:
    """The files that make up a program, each with its SHA-256 before it ran."""

    files: Sequence[Path]
    hashes: Mapping[Path, str]
    _touched: Mapping[Path, Touched]

    @classmethod
    def of(cls, files: Sequence[Path], written: Mapping[Path, str]) -> "Sources":
        """`written` are those that the program is known to write itself, each with the hash that stands for
        it, whatever it holds now. Raises InputError for a file that cannot be read.
        """
        hashes = {file: written.get(file) or sha256_of(file) for file in files}
        return cls(files, hashes, {file: touch_of(file) for file in files if file not in written})

    def changed(self) -> list[Path]:
        """Those that hold something else by now, the written ones left out."""
        touched = [file for file, touch in self._touched.items() if touch_of(file) != touch]
        return [file for file in touched if _hash_or_none(file) != self.hashes[file]]


class Written:
    """What is known of a results folder's programs, and is learned while they run."""

    def __init__(self, store: Store) -> None:
        self._store = store

    def known(self, program: Program) -> Program:
        """The program, with those of its files that are known to be written by now."""
        seen = first_seen(self._store)
        return replace(program, written=frozenset(file for file in program.inputs if os.fspath(file) in seen))

    def changed(self, program: Program, sources: Sources) -> frozenset[Path]:
        """Those of its files that are not what they were, before a run or after it. Raises InputError if the
        program itself was built anew.
        """
        hash_of = program.hash_of
        if not hash_of:
            return frozenset()
        before = {file for file, sha256 in sources.hashes.items() if sha256 != hash_of.get(file, sha256)}
        changed = (before | {*sources.changed()}) - program.written
        if not changed <= {*program.inputs}:
            raise built_anew(program.path)
        return frozenset(changed)

    def learn(self, programs: Iterable[Program], suspected: Mapping[Path, Touched]) -> None:
        """Keep which of these files are written, as they were touched again by a second run. Raises
        InputError for one that was not: somebody else had built it anew.
        """
        for file, touched in suspected.items():
            if touch_of(file) == touched is not None:
                raise built_anew(file)
        hash_of = {file: sha256 for program in programs for file, sha256 in program.hash_of.items()}
        self._keep({os.fspath(file): hash_of[file] for file in suspected})

    def learn_created(self, programs: Iterable[Program]) -> None:
        """Keep which files are there that were not: they are no part of what made them."""
        self._keep({os.fspath(file): None for one in programs for file in one.absent if is_file(file)})

    def _keep(self, more: Mapping[str, str | None]) -> None:
        kept = first_seen(self._store)
        if not more.keys() <= kept.keys():
            self._store.keep_note(NOTE, {**more, **kept})


def built_anew(path: Path) -> InputError:
    """What is said of a program, or a file of it, that is another one than before."""
    return InputError(f"{path}: was built anew while the study ran; run the study again to go on with it")


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
