"""What the files of a results folder hold, in short; each is read once (see `support.known_files`)."""

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.results.summary import Summary, packed, summary_of, unpacked
from support.files import of_json, read_json, to_json
from support.known_files import FOLDER, Stamp, files_below, is_worth_keeping, keep, kept, lasting

VERSION = 5


@dataclass(frozen=True, slots=True)
class _Row:
    stamp: Stamp | None
    """None of a file that cannot be looked at, or was changed too short a time ago."""
    summary: Summary | None


class Index:
    """Of one results folder."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._rows: dict[tuple[str, str], dict[str, _Row]] = {}

    def summaries(self, kind: str, experiment: str) -> dict[str, Summary | None]:
        """Return what each file below `records/EXPERIMENT` or `failures/EXPERIMENT` holds, by its path from
        there and in the order of these paths; None of a file that is no record.
        """
        folder = self._root / kind / experiment
        before = self._rows.get((kind, experiment))
        if before is None:
            before = self._kept(kind, experiment)
        rows: dict[str, _Row] = {}
        new = 0
        for name, stamp in files_below(folder):
            row = before.get(name)
            if row is None or stamp is None or row.stamp != stamp:
                row = _Row(lasting(stamp), summary_of(read_json(folder / name)))
                new += 1
            rows[name] = row
        self._rows[kind, experiment] = rows
        if is_worth_keeping(new + len(before.keys() - rows.keys()), len(rows)):
            keep(self._file(kind, experiment), _told(rows), VERSION)
        return {name: row.summary for name, row in rows.items()}

    def everything(self, kind: str) -> dict[Path, Summary | None]:
        """Return what each file below the folders of `records` or `failures` holds, by its path from the
        results.
        """
        folders = sorted(one.name for one in (self._root / kind).glob("*/"))
        return {
            Path(kind, folder, name): found
            for folder in folders
            for name, found in self.summaries(kind, folder).items()
        }

    def _file(self, kind: str, experiment: str) -> Path:
        return self._root / FOLDER / f"{kind}-{experiment.replace('/', '-')}.json"

    def _kept(self, kind: str, experiment: str) -> dict[str, _Row]:
        """What an earlier process has written; nothing of anything else."""
        body = kept(self._file(kind, experiment), VERSION)
        with contextlib.suppress(ValueError, TypeError, LookupError):
            return _rows(of_json(body)) if body is not None else {}
        return {}


def _told(rows: Mapping[str, _Row]) -> bytes:
    """All rows as JSON, each set of tags once."""
    places: dict[bytes, int] = {}
    told: dict[str, list[Any]] = {}
    for name, row in rows.items():
        if row.stamp is not None and row.summary is None:
            told[name] = [row.stamp, None, None]
        elif row.stamp is not None and row.summary is not None:
            place = places.setdefault(to_json(row.summary.tags), len(places))
            told[name] = [row.stamp, place, packed(row.summary)]
    return to_json({"tags": [of_json(tags) for tags in places], "rows": told})


def _rows(told: Any) -> dict[str, _Row]:  # noqa: ANN401 - read from a file
    tags = told["tags"]
    return {
        name: _Row(tuple(stamp), None if place is None else unpacked(row, tags[place]))
        for name, (stamp, place, row) in told["rows"].items()
    }
