"""Merge the records of other results folders into one: by content, and never twice."""

import hashlib
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.results.store import Store, new_session
from experiments.support.errors import InputError
from experiments.support.files import locked, read_json, write_json
from experiments.support.schema import RECORD_SCHEMA, is_record

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
    expected = json.loads(RECORD_SCHEMA.read_text(encoding="utf-8"))["properties"]["schema_version"]["const"]
    version = content.get("schema_version")
    if version != expected:
        raise InputError(
            f"{file}: schema_version: found {json.dumps(version)}, expected {expected}; nothing was collected"
        )
    if not is_record(content):
        raise InputError(f"{file}: does not match {RECORD_SCHEMA.name}; nothing was collected")


def _owner(content: dict[str, Any]) -> str:
    """The machine that a record is of, in one word: the partition under Slurm, else the host.

    A failure knows its site only.
    """
    provenance = content.get("provenance", {})
    slurm = provenance.get("slurm") or {}
    owner = (
        slurm.get("SLURM_JOB_PARTITION") or provenance.get("host") or content["tags"].get("site", "unknown")
    )
    return _word(owner)


def _word(text: object) -> str:
    """A folder's name: a record from elsewhere must not choose any other one."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", str(text)).lstrip(".") or "unknown"


def _take(store: Store, found: Sequence[_Found]) -> int:
    """How many were new."""
    known = {_sha256(read_json(file)) for file in _files(store.root)}
    measured = {one.file.name for one in found if one.content["kind"] != "failure"}
    measured |= {file.name for file in (store.root / "records").rglob("*.json")}
    taken = 0
    for one in found:
        # A process that has been measured since has not failed.
        if one.sha256 in known or (one.content["kind"] == "failure" and one.file.name in measured):
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
        if file.name in measured:
            store.retire(file)
    return taken


def _files(folder: Path) -> Iterator[Path]:
    for kind in ("records", "failures"):
        yield from sorted((folder / kind).rglob("*.json"))


def _sha256(content: object) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
