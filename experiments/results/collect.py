"""Merge the records of other results folders into one: by content, and never twice."""

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.results.index import Index
from experiments.results.store import Store, new_session, place_of
from experiments.results.summary import Summary
from support.errors import InputError
from support.files import locked, read_json, write_json
from support.record_schema import SCHEMA_FILE

COLLECTED = "collected"
"""The folder below `records/` and `failures/`; what a run here measures or retires stands beside it."""


@dataclass(frozen=True)
class _Found:
    """One file of a source folder, and its path below the results: equal paths are the same process."""

    file: Path
    summary: Summary
    path: Path


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
    index = Index(source)
    for path, summary in (index.everything("records") | index.everything("failures")).items():
        if summary is None:
            raise InputError(f"{source / path}: {_fault(read_json(source / path))}; nothing was collected")
        experiment = _word(summary.tags.get("experiment"))
        folder = Path(path.parts[0], COLLECTED, _word(summary.owner), experiment)
        yield _Found(source / path, summary, place_of(folder, path.name))


def _fault(content: Any) -> str:  # noqa: ANN401 - read from a file
    """Why it is no record."""
    if not isinstance(content, dict):
        return "is not a record"
    expected = json.loads(SCHEMA_FILE.read_text(encoding="utf-8"))["properties"]["schema_version"]["const"]
    version = content.get("schema_version")
    if version != expected:
        return f"schema_version: found {json.dumps(version)}, expected {expected}"
    return f"does not match {SCHEMA_FILE.name}"


def _word(text: object) -> str:
    """A folder's name: a record from elsewhere must not choose any other one."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", str(text)).lstrip(".") or "unknown"


def _take(store: Store, found: Sequence[_Found]) -> int:
    """How many were new."""
    index = Index(store.root)
    here = index.everything("records") | index.everything("failures")
    there = {path: _Found(store.root / path, one, path) for path, one in here.items() if one}
    known = {one.summary.digest for one in there.values()}
    measured = _measured([*there.values(), *found])
    taken = 0
    for one in found:
        if one.summary.digest in known or _is_answered(one, measured):
            continue
        earlier, target = there.get(one.path), store.root / one.path
        if earlier is not None and earlier.summary.recorded_at >= one.summary.recorded_at:
            continue
        if target.exists():
            store.retire(target)
        write_json(target, read_json(one.file), store.temporary)
        there[one.path] = _Found(target, one.summary, one.path)
        known.add(one.summary.digest)
        taken += 1
    for one in there.values():
        if one.path.parts[:2] == ("failures", COLLECTED) and _is_answered(one, measured):
            store.retire(one.file)
    return taken


def _measured(found: Iterable[_Found]) -> set[tuple[str, str]]:
    """Owner and file name of every process that left a record, and the name alone with an empty owner."""
    names = set()
    for one in found:
        if one.summary.kind != "failure":
            names |= {(one.summary.owner, one.file.name), ("", one.file.name)}
    return names


def _is_answered(one: _Found, measured: set[tuple[str, str]]) -> bool:
    """Whether a failure is one of a process that has been measured since, on the same machine if it tells
    which: hosts with the same processor give their processes the same names.
    """
    owner = one.summary.owner if "host" in one.summary.tags else ""
    return one.summary.kind == "failure" and (owner, one.file.name) in measured
