"""What the files of a results folder hold, each of them read once as long as it stays as it is."""

import contextlib
import hashlib
import math
import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.records import tables
from analysis.records.checking import checked

Rows = list[tuple[Any, ...]]

Stamp = tuple[int, int, int]
"""Of a file: its size, its time in nanoseconds, its number on the disk. A record comes by a rename: another
one has another number.
"""


@dataclass(frozen=True, slots=True)
class File:
    """A file: what it was like when it was read, the sum of its content, and its rows of each table; or the
    `problem` why it is not counted.
    """

    stamp: Stamp | None
    problem: str | None = None
    digest: str = ""
    rows: Mapping[str, Rows] = field(default_factory=dict)


def read(results: Path, before: Mapping[str, File]) -> dict[str, File]:
    """Return the files of a folder by their paths from there, in the order of these; those that are as they
    were `before` are not read again.
    """
    there = sorted(_walk(os.fspath(results / "records"), "records/"), key=lambda one: one[0].split("/"))
    return {
        name: before[name]
        if name in before and before[name].stamp is not None and before[name].stamp == stamp
        else _read(results / name, name, stamp)
        for name, stamp in there
    }


def told(files: Mapping[str, File]) -> Iterator[tuple[str, str | None]]:
    """Yield the name of each file with the reason why it does not count; a copy counts once."""
    seen: dict[str, str] = {}
    for name, one in files.items():
        why = one.problem
        if why is None and one.digest in seen:
            why = f"the same record as {seen[one.digest]}"
        elif why is None:
            seen[one.digest] = name
        yield name, why


def frames(files: Mapping[str, File]) -> dict[str, pd.DataFrame]:
    """Return the tables of the files that count, in their order."""
    counted = [files[name] for name, why in told(files) if why is None]
    columns = {name: [*tables.CONTEXT, *own] for name, own in tables.OF_PARTS.items()} | tables.ALONE
    found = {}
    for table, names in columns.items():
        rows = [row for one in counted for row in one.rows.get(table, ())]
        floats = dict.fromkeys(tables.FLOATS.get(table, ()), float)
        found[table] = pd.DataFrame(rows, columns=names).astype(floats)
    return found


def _read(path: Path, name: str, stamp: Stamp | None) -> File:
    try:
        content = path.read_bytes()
    except OSError as error:
        return File(None, error.strerror)
    problem, record = checked(content)
    rows = {} if problem else _rows_of(name, record)
    return File(stamp, problem, hashlib.sha256(content).hexdigest(), rows)


def _walk(folder: str, prefix: str) -> Iterator[tuple[str, Stamp | None]]:
    """The JSON files below a folder by their paths; the stamp is None where one cannot be looked at."""
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


def _rows_of(name: str, record: tables.Record) -> dict[str, Rows]:
    """Return the rows of a record in each table."""
    rows: dict[str, Rows] = {}
    for own, one in tables.contenders(name, record):
        if table := tables.TABLE_OF.get(one["kind"]):
            rows.setdefault(table, []).extend(_tuples(getattr(tables, table)(own, one), tables.ALONE[table]))
            continue
        [context] = _tuples([tables.context(own, one)], tables.CONTEXT)
        for table, columns in tables.OF_PARTS.items():
            parts = _tuples(getattr(tables, table)(one), columns)
            rows.setdefault(table, []).extend(context + part for part in parts)
    return rows


def _tuples(rows: Iterable[Mapping[str, Any]], columns: Sequence[str]) -> Rows:
    """Return the rows as tuples, NaN for what a row lacks. Equal texts are one in memory: of a hundred
    thousand records nearly all have the same processor, scene and compiler.
    """
    return [tuple(_shared(row.get(name, math.nan)) for name in columns) for row in rows]


def _shared(value: Any) -> Any:  # noqa: ANN401 - a cell is any value
    return sys.intern(value) if isinstance(value, str) else value
