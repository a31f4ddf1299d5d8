"""What is kept for the analysis: never another table than the files give, and no file read twice."""

import errno
import os
import random
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from analysis import claims, report
from analysis.records import known, published, reading
from analysis.records.reading import Records, load
from analysis.records.studies import split
from analysis.tests.synthetic import write
from analysis.tests.synthetic_study import failures, study
from support.known_files import FOLDER

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
    for file in tmp_path.rglob("*.json"):
        os.utime(file, (OLD, OLD))
    return tmp_path


def read(results: Path) -> Records:
    """As a new process reads it."""
    reading._KNOWN.clear()
    return load(results, lambda _: None)


def from_files(results: Path) -> Records:
    """As read from the files alone."""
    kept(results).unlink(missing_ok=True)
    return read(results)


def kept(results: Path) -> Path:
    return results / FOLDER / "tables.npz"


def in_full(table: pd.DataFrame) -> str:
    """All that a table holds, with the type of each column and of each cell."""
    cells = [[f"{type(cell).__name__} {cell!r}" for cell in row] for row in table.to_numpy(dtype=object)]
    return f"{list(table.columns)} {list(table.dtypes)} {cells}"


def assert_same(one: Records, other: Records) -> None:
    assert_tables_same(one, other)
    assert one.skipped == other.skipped


def test_a_second_process_reads_no_record_again(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = from_files(results)
    assert all(len(getattr(first, name)) for name in TABLES)
    assert len(first.skipped) == 2

    def refused(*_: object) -> None:
        raise AssertionError("a file was read again")

    monkeypatch.setattr(known.Known, "_read", refused)
    assert_same(read(results), first)


def test_a_changed_a_new_and_a_removed_record_are_noticed(results: Path) -> None:
    read(results)
    changed, removed, moved = sorted((results / "records").rglob("*.json"))[:3]
    text = changed.read_text(encoding="utf-8")
    changed.write_text(text.replace("Example CPU", "Elpmaxe CPU", 1), encoding="utf-8")
    os.utime(changed, (OLD + 1, OLD + 1))  # as large as before
    removed.unlink()
    moved.rename(moved.with_name("zzz-moved.json"))
    after = read(results)
    assert "Elpmaxe" in " ".join(after.runs["cpu_model"])
    assert_same(after, from_files(results))


def test_a_folder_that_grows_is_read_as_if_it_were_new(tmp_path: Path) -> None:
    """Each time with what was known the time before, in the same process and in another one."""
    records = study(OF_EVERY_KIND, blocks=3)
    for number in range(1, 6):
        write(tmp_path, records[: number * len(records) // 5])
        for file in tmp_path.rglob("*.json"):
            os.utime(file, (OLD, OLD))
        grown = load(tmp_path, lambda _: None)
        assert_same(grown, read(tmp_path))
        (tmp_path / FOLDER).rename(tmp_path / "aside")
        assert_same(grown, read(tmp_path))
        kept(tmp_path).unlink()
        kept(tmp_path).parent.rmdir()
        (tmp_path / "aside").rename(tmp_path / FOLDER)


@pytest.mark.parametrize("seed", range(10))
def test_an_index_that_is_damaged_is_made_again(results: Path, seed: int) -> None:
    told = from_files(results)
    content = kept(results).read_bytes()
    at = random.Random(seed).randrange(len(content))
    other = bytes([content[at] ^ 1])
    kept(results).write_bytes(content[:at] if seed % 2 else content[:at] + other + content[at + 1 :])
    assert_same(read(results), told)


def test_where_it_cannot_be_written_the_files_are_read(results: Path) -> None:
    told = from_files(results)
    kept(results).unlink()
    kept(results).parent.rmdir()
    (results / FOLDER).write_text("in the way", encoding="utf-8")
    assert_same(read(results), told)
    assert (results / FOLDER).read_text(encoding="utf-8") == "in the way"


def test_a_disk_that_is_full_leaves_nothing_of_it(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told = from_files(results)
    kept(results).unlink()
    whole = Path.write_bytes

    def half(path: Path, content: bytes) -> int:
        whole(path, content[: len(content) // 2])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", half)
    assert_same(read(results), told)
    assert list((results / FOLDER).iterdir()) == []


def test_processes_that_read_at_the_same_time_read_the_same(results: Path) -> None:
    told = from_files(results)
    kept(results).unlink()
    children = []
    for _ in range(4):
        child = os.fork()
        if child == 0:
            same = all(
                in_full(getattr(read(results), name)) == in_full(getattr(told, name)) for name in TABLES
            )
            os._exit(0 if same else 1)
        children.append(child)
    assert [os.waitpid(child, 0)[1] for child in children] == [0, 0, 0, 0]
    assert [file.name for file in (results / FOLDER).iterdir()] == [kept(results).name]
    assert_same(read(results), told)


def test_a_writer_that_is_killed_leaves_the_old_one(results: Path) -> None:
    """Killed at random moments, by a signal that no program can hear."""
    told = from_files(results)
    before = kept(results).read_bytes()
    for seed in range(8):
        for number in range(60):
            torn = results / "records" / f"more{seed}-{number}.json"
            torn.write_text("{", encoding="utf-8")
            os.utime(torn, (OLD, OLD))
        child = os.fork()
        if child == 0:
            _killed_while_writing(results, random.Random(seed).randrange(len(before)))
        assert os.WIFSIGNALED(os.waitpid(child, 0)[1])
        assert kept(results).read_bytes() == before
        again = read(results)
        assert len(again.skipped) == len(told.skipped) + 60 * (seed + 1)
        assert_tables_same(again, told)
        kept(results).write_bytes(before)


def _killed_while_writing(results: Path, at: int) -> None:
    whole = Path.write_bytes

    def part(path: Path, content: bytes) -> int:
        whole(path, content[:at])
        os.kill(os.getpid(), 9)
        return 0

    Path.write_bytes = part  # type: ignore[method-assign,assignment]
    read(results)
    os._exit(0)


def assert_tables_same(one: Records, other: Records) -> None:
    for name in TABLES:
        assert in_full(getattr(one, name)) == in_full(getattr(other, name)), name


def table_of_claims(results: Path) -> str:
    studies = split(read(results))
    table = claims.evaluate(studies[0], studies, published.load(), claims.load(results))
    reading._KNOWN.clear()
    return in_full(table)


@pytest.mark.parametrize(
    "told", [table_of_claims, pytest.param(report.render, marks=pytest.mark.slow)], ids=["claims", "report"]
)
def test_claims_and_the_report_are_the_same_with_it_and_without(
    tmp_path: Path, told: Callable[[Path], str]
) -> None:
    write(tmp_path, study(blocks=2))
    without = told(tmp_path)
    assert kept(tmp_path).exists()
    assert told(tmp_path) == without
