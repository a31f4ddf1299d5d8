"""A file with what earlier calls measured: the records of each session, the last of which may go on."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from experiments.compare.blocks import Blocks
from experiments.plan.scenes import sha256_of
from support.errors import InputError
from support.files import descriptor_of, read_json, replacing, require_place
from support.record_schema import is_record

SCHEMA_VERSION = 3


@dataclass(frozen=True)
class How:
    """How commands are measured that are no longer as they were asked for: what each first run told, and the
    names of those that failed.
    """

    rounds: tuple[int, ...]
    turns: bool | None
    left_out: tuple[str, ...] = ()
    fixed_layout: bool = False
    loaded: Mapping[str, str] = field(default_factory=dict)
    """The SHA-256 of each shared library that was loaded."""

    def no_longer(self, fixed_layout: bool) -> str:
        """Why nothing can be measured like this any more; empty if it can."""
        if fixed_layout != self.fixed_layout:
            return f"it was measured with{'out' * fixed_layout} --fixed-layout"
        other = (name for name, sha256 in self.loaded.items() if _hash_of(Path(name)) != sha256)
        return next((f"{name} is another library now" for name in other), "")


@dataclass(frozen=True)
class Session:
    """What was measured of the same commands and programs, and how."""

    how: How
    records: list[Any]


class Earlier:
    """The sessions of a file; of no file there are none."""

    def __init__(self, path: Path | None) -> None:
        """Reads it. Raises InputError for what is no such file, and where there is no place for one."""
        if path is not None:
            require_place("--append", path)
            if descriptor_of(path) is not None:
                raise InputError(
                    f"--append: found {path}, which is no file, expected one, or a place for one"
                )
        self._path = path
        self._sessions = _read(path) if path is not None and path.exists() else []
        self._kept = self._sessions
        """What is in the file, as far as is known."""
        self._is_last = False
        """Whether the last session of the file is this call's, or one that it goes on with."""

    @property
    def how(self) -> How | None:
        """That of the last session."""
        return self._sessions[-1].how if self._sessions else None

    def go_on(self, blocks: Blocks) -> str:
        """Count the last session's blocks; returns why they cannot be counted, if so."""
        if not self._sessions:
            return ""
        wrong = blocks.take_up(self._sessions[-1].records)
        self._is_last = not wrong
        return wrong

    def keep(self, blocks: Blocks, how: How) -> None:
        """Write all sessions, that of these blocks in the place of the one that it goes on with."""
        if self._path is None:
            return
        now = Session(how, blocks.records)
        there = _read(self._path) if self._path.exists() else []
        if there != self._kept:  # another call has written meanwhile: what it measured stays
            self._kept, self._is_last = there, False
        self._kept = [*(self._kept[:-1] if self._is_last else self._kept), now]
        self._is_last = True
        content = {
            "schema_version": SCHEMA_VERSION,
            "sessions": [{"how": asdict(one.how), "records": one.records} for one in self._kept],
        }
        with replacing(self._path) as part:
            part.write_text(json.dumps(content, ensure_ascii=False) + "\n", encoding="utf-8")


def _read(path: Path) -> list[Session]:
    if not path.is_file():
        raise InputError(
            f"--append: found {path}, which is no file, expected one of an earlier call, or none"
        )
    if not path.stat().st_size:
        return []  # as mktemp makes one
    match read_json(path):
        case {"schema_version": version, "sessions": [*sessions]} if version == SCHEMA_VERSION:
            return [_session(path, one) for one in sessions]
        case {"schema_version": version, "sessions": _}:
            raise InputError(
                f"--append: {path}: found schema version {version!r}, expected {SCHEMA_VERSION}; "
                "give another file, and measure again"
            )
    raise InputError(f"--append: {path}: is no file of an earlier call, expected one, or none")


def _session(path: Path, session: object) -> Session:
    match session:
        case {
            "how": {
                "rounds": [*rounds],
                "turns": bool() | None as turns,
                "left_out": [*left_out],
                "fixed_layout": bool() as is_fixed,
                "loaded": dict() as loaded,
            },
            "records": [*records],
        } if all(map(is_record, records)):
            return Session(How(tuple(rounds), turns, tuple(left_out), is_fixed, loaded), records)
    raise InputError(f"--append: {path}: is damaged, expected what an earlier call has written")


def _hash_of(path: Path) -> str | None:
    return sha256_of(path) if path.is_file() else None
