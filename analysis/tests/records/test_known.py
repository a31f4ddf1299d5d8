"""A folder that is loaded again: never another table than the files give, and no file read twice."""

import os
from pathlib import Path

import pytest

from analysis.records import known, reading
from analysis.records.reading import Records, load
from analysis.tests.synthetic import write
from analysis.tests.synthetic_study import failures, study

OLD = 1_000_000_000
"""Seconds: a time of files long ago."""
TABLES = [*reading.MEASURED, "limits", "failures"]
OF_EVERY_KIND = ["steps", "phases", "hard_cases", "limits"]
"""Experiments whose records fill every table."""


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Records of every kind, failures, a copy and a torn file, all old."""
    write(tmp_path, study(OF_EVERY_KIND, blocks=3))
    write(tmp_path, failures())
    first = min((tmp_path / "records").rglob("*.json"))
    (first.parent / "zz-copy.json").write_bytes(first.read_bytes())
    (first.parent / "zz-torn.json").write_text("{", encoding="utf-8")
    age(tmp_path)
    return tmp_path


def age(folder: Path) -> None:
    for file in folder.rglob("*.json"):
        os.utime(file, (OLD, OLD))


def again(results: Path) -> Records:
    """As this process reads it, with what it knows."""
    return load(results, lambda _: None)


def anew(results: Path) -> Records:
    """As another process reads it."""
    reading._KNOWN.clear()
    return again(results)


def in_full(records: Records) -> list[str]:
    """All that the tables hold, with the type of each column and of each cell, and what was skipped."""
    told = [*records.skipped]
    for table in (getattr(records, name) for name in TABLES):
        cells = [[f"{type(cell).__name__} {cell!r}" for cell in row] for row in table.to_numpy(dtype=object)]
        told.append(f"{list(table.columns)} {list(table.dtypes)} {cells}")
    return told


def test_no_record_is_read_again(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = anew(results)
    assert all(len(getattr(first, name)) for name in TABLES)
    assert len(first.skipped) == 2

    def refused(*_: object) -> None:
        raise AssertionError("a file was read again")

    monkeypatch.setattr(known, "_read", refused)
    assert in_full(again(results)) == in_full(first)


def test_a_changed_a_new_and_a_removed_record_are_noticed(results: Path) -> None:
    anew(results)
    changed, removed, moved = sorted((results / "records" / "steps").rglob("*.json"))[:3]
    text = changed.read_text(encoding="utf-8")
    changed.write_text(text.replace("Example CPU", "Elpmaxe CPU", 1), encoding="utf-8")
    os.utime(changed, (OLD + 1, OLD + 1))  # as large as before
    removed.unlink()
    moved.rename(moved.with_name("zzz-moved.json"))
    after = again(results)
    assert "Elpmaxe" in " ".join(after.runs["cpu_model"])
    assert in_full(after) == in_full(anew(results))
