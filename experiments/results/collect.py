"""Merge the records of other results folders into one: by content, and never twice."""

import hashlib
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.results.store import Store, new_session
from support.errors import InputError
from support.files import locked, read_json, write_json
from support.record_schema import SCHEMA_FILE, is_record

COLLECTED = "collected"
"""The folder below `records/` and `failures/`; what a run here measures or retires stands beside it."""


@dataclass(frozen=True)
class _Found:
    """One file of a source folder, and its path below the results: equal paths are the same process."""

    file: Path
    content: Any
    path: Path

    @property
    def sha256(self) -> str:
        """Of the content: how the file is written does not matter."""
        return _sha256(self.content)


def collect(sources: Sequence[Path], results: Path) -> int:
    """Take in every record and failure below the sources. Returns the exit code, 0.

    Of two records of one process (a task that ran twice) the later one stays; the earlier one goes to
    `stale/`. Raises InputError, with nothing taken in, for a folder that is not there and for a record of
    another schema.
    """
    found = [one for source in sources for one in _read(source, results)]
    with locked(results):
        store = Store(results, new_session())
        with store.shared():
            taken = _take(store, found)
    print(f"{taken} of {len(found)} files are new; {len(found) - taken} were here already: {results}")
    return 0


def _read(source: Path, results: Path) -> Iterator[_Found]:
    if not source.is_dir():
        raise InputError(f"{source}: is not a folder; expected one with records/ in it")
    if source.resolve() == results.resolve():
        raise InputError(f"{source}: is the folder to collect into; expected another one")
    for file in _files(source):
        content = read_json(file)
        _require_schema(file, content)
        kind = file.relative_to(source).parts[0]
        experiment = _word(content["tags"].get("experiment"))
        yield _Found(file, content, Path(kind, COLLECTED, _owner(content), experiment, file.name))


def _require_schema(file: Path, content: Any) -> None:  # noqa: ANN401 - read from a file
    if not isinstance(content, dict):
        raise InputError(f"{file}: is not a record; nothing was collected")
    expected = json.loads(SCHEMA_FILE.read_text(encoding="utf-8"))["properties"]["schema_version"]["const"]
    version = content.get("schema_version")
    if version != expected:
        raise InputError(
            f"{file}: schema_version: found {json.dumps(version)}, expected {expected}; nothing was collected"
        )
    if not is_record(content):
        raise InputError(f"{file}: does not match {SCHEMA_FILE.name}; nothing was collected")


def _owner(content: dict[str, Any]) -> str:
    """The machine that a record is of, in one word: the partition under Slurm, else the host.

    A failure has them among its tags; an old one knows its site only.
    """
    provenance, tags = content.get("provenance", {}), content["tags"]
    slurm = provenance.get("slurm") or {}
    host = provenance.get("host") or tags.get("host") or tags.get("site", "unknown")
    return _word(slurm.get("SLURM_JOB_PARTITION") or tags.get("partition") or host)


def _word(text: object) -> str:
    """A folder's name: a record from elsewhere must not choose any other one."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", str(text)).lstrip(".") or "unknown"


def _take(store: Store, found: Sequence[_Found]) -> int:
    """How many were new."""
    here = [(file, read_json(file)) for file in _files(store.root)]
    known = {_sha256(content) for _, content in here}
    measured = _measured([*here, *((one.file, one.content) for one in found)])
    taken = 0
    for one in found:
        if one.sha256 in known or _is_answered(one.file, one.content, measured):
            continue
        target = store.root / one.path
        there = read_json(target)
        if is_record(there) and there["recorded_at"] >= one.content["recorded_at"]:
            continue
        if target.exists():
            store.retire(target)
        write_json(target, one.content, store.temporary)
        known.add(one.sha256)
        taken += 1
    for file in sorted((store.root / "failures" / COLLECTED).rglob("*.json")):
        if _is_answered(file, read_json(file), measured):
            store.retire(file)
    return taken


def _measured(files: Iterable[tuple[Path, Any]]) -> set[tuple[str, str]]:
    """Owner and file name of every process that left a record, and the name alone with an empty owner."""
    names = set()
    for file, content in files:
        if _kind(content) not in (None, "failure"):
            names |= {(_owner(content), file.name), ("", file.name)}
    return names


def _is_answered(file: Path, content: Any, measured: set[tuple[str, str]]) -> bool:  # noqa: ANN401 - read from a file
    """Whether a failure is one of a process that has been measured since, on the same machine if it tells
    which: hosts with the same processor give their processes the same names.
    """
    if _kind(content) != "failure":
        return False
    owner = _owner(content) if "host" in content["tags"] else ""
    return (owner, file.name) in measured


def _kind(content: Any) -> str | None:  # noqa: ANN401 - read from a file
    """The kind that a record says it is of; None for what is none at all."""
    is_one = isinstance(content, dict) and isinstance(content.get("tags"), dict)
    return str(content["kind"]) if is_one and "kind" in content else None


def _files(folder: Path) -> Iterator[Path]:
    for kind in ("records", "failures"):
        yield from sorted((folder / kind).rglob("*.json"))


def _sha256(content: object) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
