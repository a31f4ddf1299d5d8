"""What is kept of records beside them: never another answer than the files give, and no file read twice."""

import json
import os
import random
from pathlib import Path
from typing import Any

import pytest

from experiments.results import index
from experiments.results.index import Index
from experiments.results.summary import Summary
from experiments.run.session import run
from experiments.run.study import Study
from experiments.tests.conftest import PAIR, Workplace
from support.known_files import FOLDER

OLD = 1_000_000_000
"""Seconds: a time of files long ago."""


@pytest.fixture
def results(empty_workplace: Workplace) -> Path:
    """Thirty records of a question, all old, and a file that is none."""
    empty_workplace.question("pair", PAIR)
    assert run(empty_workplace.settings) == 0
    folder = empty_workplace.results / "records" / "pair"
    first = min(folder.rglob("*.json"))
    for number in range(100, 130):
        copy = first.parent / f"{first.name.split('-b')[0]}-b{number}.json"
        copy.write_bytes(first.read_bytes())
    (folder / "torn.json").write_text("{", encoding="utf-8")
    for file in folder.rglob("*.json"):
        os.utime(file, (OLD, OLD))
    return empty_workplace.results


def summaries(results: Path) -> dict[str, Summary | None]:
    return Index(results).summaries("records", "pair")


def without(results: Path) -> dict[str, Summary | None]:
    """As read from the files alone."""
    for file in (results / FOLDER).glob("*"):
        file.unlink()
    return summaries(results)


def kept(results: Path) -> Path:
    return results / FOLDER / "records-pair.json"


def count_reads(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The files that are read from now on."""
    read: list[Path] = []

    def reading(path: Path) -> Any:  # noqa: ANN401 - JSON is any value
        read.append(path)
        return (
            json.loads(path.read_text(encoding="utf-8"))
            if path.exists() and path.stat().st_size > 1
            else None
        )

    monkeypatch.setattr(index, "read_json", reading)
    return read


def test_a_second_process_reads_no_record_again(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = summaries(results)
    read = count_reads(monkeypatch)
    assert summaries(results) == first
    assert read == []
    assert first["torn.json"] is None
    assert sum(one is not None for one in first.values()) == len(first) - 1


def test_a_changed_a_new_and_a_removed_record_are_noticed(results: Path) -> None:
    before = summaries(results)
    names = [name for name, one in before.items() if one is not None]
    folder = results / "records" / "pair"
    changed, removed, new = names[0], names[1], "new.json"
    text = (folder / changed).read_text(encoding="utf-8")
    (folder / changed).write_text(text.replace('"pair"', '"riap"', 1), encoding="utf-8")
    os.utime(folder / changed, (OLD + 1, OLD + 1))  # as large as before
    (folder / removed).unlink()
    (folder / new).write_text(text, encoding="utf-8")
    after = summaries(results)
    assert after.keys() == (before.keys() - {removed}) | {new}
    assert after[changed] != before[changed]
    assert after == without(results)


def test_a_file_that_was_just_changed_is_not_kept(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It could change once more without another time or size."""
    young = results / "records" / "pair" / "young.json"
    young.write_text("{", encoding="utf-8")
    summaries(results)
    read = count_reads(monkeypatch)
    summaries(results)
    assert read == [young]


def test_an_index_that_is_damaged_or_of_another_kind_is_made_again(results: Path) -> None:
    told = summaries(results)
    content = kept(results).read_bytes()
    places = [random.Random(seed).randrange(len(content)) for seed in range(20)]
    torn = [content[:at] for at in places[::2]]
    changed = [content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :] for at in places[1::2]]
    for damaged in (*torn, *changed, b"", b"null", b"[]", b"1 a b\n{}"):
        kept(results).write_bytes(damaged)
        assert summaries(results) == told
        assert kept(results).read_bytes() != damaged


def test_where_it_cannot_be_written_the_files_are_read(results: Path) -> None:
    told = without(results)
    for file in (results / FOLDER).iterdir():
        file.unlink()
    (results / FOLDER).rmdir()
    (results / FOLDER).write_text("in the way", encoding="utf-8")
    assert summaries(results) == told
    assert (results / FOLDER).read_text(encoding="utf-8") == "in the way"


def test_a_writer_that_is_killed_leaves_the_old_one(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    summaries(results)
    before = kept(results).read_bytes()
    for name in range(40):
        (results / "records" / "pair" / f"more{name}.json").write_text("{", encoding="utf-8")

    def killed(_: object) -> bytes:
        raise KeyboardInterrupt

    monkeypatch.setattr(index, "to_json", killed)
    with pytest.raises(KeyboardInterrupt):
        summaries(results)
    assert kept(results).read_bytes() == before
    assert [file.name for file in (results / FOLDER).iterdir()] == [kept(results).name]


@pytest.mark.usefixtures("results")
def test_a_block_is_found_by_its_own_names_alone(
    empty_workplace: Workplace, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study(empty_workplace.settings)
    [experiment] = study.experiments
    of_all = study.store.find(experiment)

    def refused(*_: object) -> None:
        raise AssertionError("a folder was listed")

    monkeypatch.setattr(os, "scandir", refused)
    monkeypatch.setattr(os, "listdir", refused)
    found = study.store.find_block(experiment, 0)
    assert found.seconds == {key: seconds for key, seconds in of_all.seconds.items() if key[1] == 0}
    assert list(found.sessions.values())
    assert len(found.seconds) == len(experiment.points)
