"""All that a results folder's files hold, as tables that are brought up to date by what is new.

Kept in memory and beside the files (`support.known_files`): a report of a growing study reads what is new.
"""

import contextlib
import hashlib
import io
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
import pandas as pd

from analysis.records import tables
from analysis.records.checking import checked
from analysis.records.columns import Integers, Rows
from analysis.statistics.pairs import rounds_of, runs_of
from analysis.support.values import Floats
from support.files import of_json, to_json
from support.known_files import FOLDER, Stamp, files_below, is_worth_keeping, keep, kept, lasting

VERSION = 4
_CONTEXTS = "contexts"
_OF_RECORD = {name: getattr(tables, name) for name in tables.OF_PARTS}
_ALONE = {name: getattr(tables, name) for name in tables.ALONE}
_COLUMNS = {
    _CONTEXTS: tables.CONTEXT,
    **{name: ["file", *columns] for name, columns in tables.OF_PARTS.items()},
    **tables.ALONE,
}
_KIND = {"limits": "limits", "failures": "failure"}
"""The kind of record that each table of its own is of."""


@dataclass(frozen=True, slots=True)
class _File:
    stamp: Stamp | None
    problem: str | None
    """Why it is not counted."""
    digest: str
    """Of its content: a copy counts once."""


class Known:
    """Of one results folder."""

    def __init__(self) -> None:
        self._files: dict[str, _File] = {}
        self._rows = {name: Rows(columns) for name, columns in _COLUMNS.items()}
        self._runs: dict[str, Floats] = {}
        """The seconds of each timed run, by the file's name."""
        self._rounds: dict[str, Floats] = {}
        """The seconds of each turn, by the file's name."""

    def bring_up_to_date(self, results: Path) -> None:
        """Read what is new or changed, forget what is gone, and keep what is known if that is worth it."""
        there = {
            f"{folder}/{name}": stamp
            for folder in ("records", "failures")
            for name, stamp in files_below(results / folder)
        }
        old = {name for name, one in self._files.items() if one.stamp is None or there.get(name) != one.stamp}
        self._forget(old)
        new = [name for name in there if name not in self._files]
        for name in new:
            self._read(results / name, name, there[name])
        self._files = {name: self._files[name] for name in there}
        if is_worth_keeping(len(old.union(new)), len(there)):
            self._keep(results)

    def problems(self, results: Path) -> list[str]:
        """Return a line for each file that does not count."""
        return [f"{results / name}: skipped: {why}" for name, why in self._told() if why is not None]

    def frames(self) -> dict[str, pd.DataFrame]:
        """Return the tables, in the order of the files' paths."""
        places = {name: place for place, (name, why) in enumerate(self._told()) if why is None}
        contexts = self._rows[_CONTEXTS]
        row_of = {name: row for row, name in enumerate(contexts.column("file"))}
        found = {}
        for table, rows in self._rows.items():
            files = rows.column("file")
            chosen = _in_order([places.get(name, -1) for name in files])
            if table == _CONTEXTS:
                continue
            series = rows.at(chosen, [one for one in _COLUMNS[table] if one != "file" or table in _ALONE])
            if table in _OF_RECORD:
                at = np.array([row_of[files[row]] for row in chosen], dtype=np.intp)
                series = contexts.at(at, tables.CONTEXT) | series
            if table == "times":
                series |= self._times(list(series["file"]))
            found[table] = pd.DataFrame(series).astype(dict.fromkeys(tables.FLOATS.get(table, ()), float))
        return found

    def _times(self, files: list[str]) -> dict[str, Any]:
        runs = pd.Series([self._runs[name] for name in files], dtype=object)
        rounds = pd.Series([self._rounds[name] for name in files], dtype=object)
        medians = runs.map(np.median).astype(float)
        return {"steps_seconds": medians, runs_of("steps_seconds"): runs, rounds_of("steps_seconds"): rounds}

    def _told(self) -> Iterator[tuple[str, str | None]]:
        """Each file with the reason why it does not count."""
        seen: dict[str, str] = {}
        for name, one in self._files.items():
            why = one.problem
            if why is None and one.digest in seen:
                why = f"the same record as {seen[one.digest]}"
            elif why is None:
                seen[one.digest] = name
            yield name, why

    def _read(self, path: Path, name: str, stamp: Stamp | None) -> None:
        try:
            content = path.read_bytes()
        except OSError as error:
            self._files[name] = _File(None, error.strerror, "")
            return
        problem, record = checked(content, failures=name.startswith("failures/"))
        self._files[name] = _File(lasting(stamp), problem, hashlib.sha256(content).hexdigest())
        if problem is None:
            self._take(name, record)

    def _take(self, name: str, record: tables.Record) -> None:
        for table, rows_of in _ALONE.items():
            if record["kind"] == _KIND[table]:
                self._rows[table].extend(rows_of(name, record))
                return
        self._rows[_CONTEXTS].extend([tables.context(name, record)])
        self._runs[name] = tables.seconds_of_runs(record)
        self._rounds[name] = tables.seconds_of_rounds(record)
        for table, parts_of in _OF_RECORD.items():
            self._rows[table].extend({**part, "file": name} for part in parts_of(record))

    def _forget(self, names: Collection[str]) -> None:
        if not names:
            return
        for name in names:
            self._files.pop(name)
            self._runs.pop(name, None)
            self._rounds.pop(name, None)
        for rows in self._rows.values():
            rows.keep(np.array([file not in names for file in rows.column("file")], dtype=bool))

    def _keep(self, results: Path) -> None:
        """Write arrays, and as one of them all that JSON can hold."""
        arrays: dict[str, Any] = {
            **_packed("runs", self._runs),
            **_packed("rounds", self._rounds),
        }
        values: dict[str, Any] = {}
        for table, rows in self._rows.items():
            packed = rows.packed()
            values[table] = {name: one["values"] for name, one in packed.items()}
            arrays |= {f"{table} {name}": one["rows"] for name, one in packed.items()}
        files = {name: [one.stamp, one.problem, one.digest] for name, one in self._files.items()}
        told = to_json({"files": files, "runs": list(self._runs), "values": values})
        body = io.BytesIO()
        np.savez(body, told=np.frombuffer(told, dtype=np.uint8), **arrays)
        keep(_file(results), body.getvalue(), VERSION)

    @classmethod
    def kept(cls, results: Path) -> Self:
        """Return what an earlier process has kept; nothing of anything else."""
        body = kept(_file(results), VERSION)
        if body is not None:
            with contextlib.suppress(ValueError, KeyError, TypeError, OSError):
                return cls._unpacked(body)
        return cls()

    @classmethod
    def _unpacked(cls, body: bytes) -> Self:
        arrays = np.load(io.BytesIO(body), allow_pickle=False)
        told = of_json(arrays["told"].tobytes())
        found = cls()
        found._files = {
            name: _File(tuple(one[0]) if one[0] else None, *one[1:]) for name, one in told["files"].items()
        }
        found._runs = _unpacked("runs", told["runs"], arrays)
        found._rounds = _unpacked("rounds", told["runs"], arrays)
        for table, columns in _COLUMNS.items():
            values = told["values"][table]
            packed = {name: {"values": values[name], "rows": arrays[f"{table} {name}"]} for name in columns}
            found._rows[table] = Rows.unpacked(columns, packed)
        return found


def _packed(name: str, values: Mapping[str, Floats]) -> dict[str, Any]:
    """The values as one array, and how many each file has."""
    lengths = np.array([len(one) for one in values.values()], dtype=np.intp)
    return {name: np.concatenate(list(values.values()) or [np.empty(0)]), f"{name} lengths": lengths}


def _unpacked(name: str, files: list[str], arrays: Mapping[str, Any]) -> dict[str, Floats]:
    ends = np.cumsum(arrays[f"{name} lengths"])[:-1]
    return dict(zip(files, np.split(arrays[name], ends), strict=False))


def _in_order(places: list[int]) -> Integers:
    """The rows whose place is not negative, in the order of their places."""
    at = np.array(places, dtype=np.intp)
    order: Integers = np.argsort(at, kind="stable")
    return order[at[order] >= 0]


def _file(results: Path) -> Path:
    return results / FOLDER / "tables.npz"
