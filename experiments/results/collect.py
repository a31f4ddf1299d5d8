"""Merge the records of other results folders into one: by content, and never twice."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.results.record import owner_of
from experiments.results.store import Store, new_session, place_of
from support.errors import InputError
from support.files import digest_of, locked, read_json, write_json
from support.record_schema import SCHEMA_FILE, is_record, refusal

COLLECTED = "collected"
"""The folder below `records/`; what a run here measures or retires stands beside it."""


@dataclass(frozen=True)
class _Found:
    """A file with a record, and its path below the results: equal paths are the same process."""

    file: Path
    path: Path
    digest: str
    """Of the content: how the file is written does not matter."""
    recorded_at: str


def collect(sources: Sequence[Path], results: Path) -> int:
    """Take in every record below the sources. Returns the exit code, 0.

    Of two records of one process (a task that ran twice, one that failed at first) the later one stays; the
    earlier one goes to `stale/`. Raises InputError, with nothing taken in, for a folder that is not there and
    for a record of another schema.
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
    for file in sorted((source / "records").rglob("*.json")):
        record = read_json(file)
        if not is_record(record):
            wrong = refusal(record) or f"does not match {SCHEMA_FILE.name}"
            raise InputError(f"{file}: {wrong}; nothing was collected")
        experiment = _word(record["contenders"][0]["tags"].get("experiment"))
        folder = Path("records", COLLECTED, _word(owner_of(record)), experiment)
        yield _Found(file, place_of(folder, file.name), digest_of(record), record["recorded_at"])


def _word(text: object) -> str:
    """A folder's name: a record from elsewhere must not choose any other one."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", str(text)).lstrip(".") or "unknown"


def _take(store: Store, found: Sequence[_Found]) -> int:
    """How many were new."""
    here = ((file, read_json(file)) for file in (store.root / "records").rglob("*.json"))
    known = {digest_of(record) for _, record in here if is_record(record)}
    taken = 0
    for one in found:
        target = store.root / one.path
        earlier = read_json(target)
        if one.digest in known or (is_record(earlier) and earlier["recorded_at"] >= one.recorded_at):
            continue
        if target.exists():
            store.retire(target)
        write_json(target, read_json(one.file), store.temporary)
        known.add(one.digest)
        taken += 1
    return taken
