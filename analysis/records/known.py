"""What the files of a results folder hold, each of them read once as long as it stays as it is."""

import hashlib
import math
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.records import tables
from analysis.records.checking import checked
from support.known_files import Stamp, files_below, lasting

Rows = list[tuple[Any, ...]]

_KIND = {"limits": "limits", "failures": "failure"}
"""The kind of record that each table of its own is of."""


@dataclass(frozen=True, slots=True)
class File:
    """A file: what it was like when it was read, the sum of its content, and its rows of each table, which
    begin with what all of them have, the `context`; or the `problem` why it is not counted.
    """

    stamp: Stamp | None
    problem: str | None = None
    digest: str = ""
    context: tuple[Any, ...] = ()
    rows: Mapping[str, Rows] = field(default_factory=dict)


def read(results: Path, before: Mapping[str, File]) -> dict[str, File]:
    """Return the files of a folder by their paths from there, in the order of these; those that are as they
    were `before` are not read again.
    """
    there = {
        f"{folder}/{name}": stamp
        for folder in ("records", "failures")
        for name, stamp in files_below(results / folder)
    }
    return {
        name: before[name]
        if name in before and before[name].stamp is not None and before[name].stamp == stamp
        else _read(results / name, name, stamp)
        for name, stamp in there.items()
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
        rows = [one.context + row for one in counted for row in one.rows.get(table, ())]
        floats = dict.fromkeys(tables.FLOATS.get(table, ()), float)
        found[table] = pd.DataFrame(rows, columns=names).astype(floats)
    return found


def _read(path: Path, name: str, stamp: Stamp | None) -> File:
    try:
        content = path.read_bytes()
    except OSError as error:
        return File(None, error.strerror)
    problem, record = checked(content, failures=name.startswith("failures/"))
    context, rows = ((), {}) if problem else _rows_of(name, record)
    return File(lasting(stamp), problem, hashlib.sha256(content).hexdigest(), context, rows)


def _rows_of(name: str, record: tables.Record) -> tuple[tuple[Any, ...], dict[str, Rows]]:
    """Return what all rows of a record begin with, and its rows of each table."""
    for table, columns in tables.ALONE.items():
        if record["kind"] == _KIND[table]:
            return (), {table: _tuples(getattr(tables, table)(name, record), columns)}
    [context] = _tuples([tables.context(name, record)], tables.CONTEXT)
    parts = {table: _tuples(getattr(tables, table)(record), own) for table, own in tables.OF_PARTS.items()}
    return context, parts


def _tuples(rows: Iterable[Mapping[str, Any]], columns: Sequence[str]) -> Rows:
    """Return the rows as tuples, NaN for what a row lacks. Equal texts are one in memory: of a hundred
    thousand records nearly all have the same processor, scene and compiler.
    """
    return [tuple(_shared(row.get(name, math.nan)) for name in columns) for row in rows]


def _shared(value: Any) -> Any:  # noqa: ANN401 - a cell is any value
    return sys.intern(value) if isinstance(value, str) else value
