"""Merging results folders: by content, never twice, and nothing of another schema."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from experiments.results.collect import collect
from experiments.run.session import run
from experiments.tests.conftest import PAIR, Workplace
from support.errors import InputError

HOST = os.uname().nodename


@pytest.fixture
def source(empty_workplace: Workplace) -> Path:
    """A results folder with two records of two points each."""
    empty_workplace.question("pair", PAIR)
    assert run(empty_workplace.settings) == 0
    return empty_workplace.results


def change(file: Path, edit: Callable[[dict[str, Any]], None]) -> None:
    content = json.loads(file.read_text())
    edit(content)
    file.write_text(json.dumps(content))


def collected(folder: Path) -> list[Path]:
    return sorted(folder.glob("records/collected/*/*/*/*.json"))


def failed(folder: Path) -> list[Path]:
    """Those in which something failed."""
    return [
        path for path in collected(folder) if '"reason"' in path.read_text().replace('"reason": null', "")
    ]


def first(source: Path) -> Path:
    return min(source.glob("records/pair/*/*.json"))


def test_records_come_in_once(source: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "all"
    collect([source], target)
    names = [path.name for path in collected(target)]
    assert names == sorted(path.name for path in source.glob("records/pair/*/*.json"))
    assert {path.parent.parent.relative_to(target).as_posix() for path in collected(target)} == {
        f"records/collected/{HOST}/pair"
    }
    change(first(source), lambda _: None)  # the same in other words
    collect([source], target)
    assert not (target / "stale").exists()
    collect([target], tmp_path / "further")
    assert [path.name for path in collected(tmp_path / "further")] == names
    lines = capsys.readouterr().out.splitlines()
    assert lines[-3].startswith("2 of 2 files are new; 0 were here already: ")
    assert lines[-2].startswith("0 of 2 files are new; 2 were here already: ")
    assert not list(target.glob(".running/*"))


def test_what_was_measured_here_is_not_taken_in_from_a_copy(source: Path, tmp_path: Path) -> None:
    collect([source], tmp_path / "copy")
    collect([tmp_path / "copy"], source)
    assert not collected(source)


@pytest.mark.parametrize("moment", ["2025-01-01T00:00:00Z", "2023-01-01T00:00:00Z"])
def test_of_two_records_of_one_process_the_later_stays(source: Path, tmp_path: Path, moment: str) -> None:
    target = tmp_path / "all"
    collect([source], target)
    change(first(source), lambda record: record.update(recorded_at=moment))
    for _ in range(2):
        collect([source], target)
    assert len(collected(target)) == 2
    kept = next(path for path in collected(target) if path.name == first(source).name)
    assert json.loads(kept.read_text())["recorded_at"] == max(moment, "2024-01-01T00:00:00Z")
    assert len(list(target.glob("stale/**/*.json"))) == (1 if moment > "2024" else 0)


@pytest.mark.parametrize(
    ("edit", "line"),
    {
        "version": (
            lambda record: record.update(schema_version=1),
            "schema version 1, expected 2: measure it again, or read it with the release of Carom that wrote "
            "it",
        ),
        "field": (
            lambda record: record["contenders"][0]["scene"].pop("sha256"),
            "does not match record.schema.json",
        ),
    }.values(),
)
def test_another_schema_is_refused_and_nothing_taken_in(
    source: Path, tmp_path: Path, edit: Callable[[dict[str, Any]], None], line: str
) -> None:
    file = max(source.glob("records/pair/*/*.json"))
    change(file, edit)
    with pytest.raises(InputError) as refused:
        collect([source], tmp_path / "all")
    assert str(refused.value) == f"{file}: {line}; nothing was collected"
    assert not (tmp_path / "all").exists()


def test_torn_and_missing_sources_are_refused(source: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere: is not a folder; expected one with records/ in it"):
        collect([tmp_path / "nowhere"], tmp_path / "all")
    with pytest.raises(InputError, match="is the folder to collect into; expected another one"):
        collect([source], source)
    first(source).write_text("{")
    with pytest.raises(InputError, match=r"not a Carom record .no schema_version.; nothing was collected"):
        collect([source], tmp_path / "all")


def test_failures_come_in_until_they_are_answered(workplace: Workplace, tmp_path: Path) -> None:
    target = tmp_path / "all"
    workplace.behave(FAKE_BENCH_CRASHES="nine")
    run(workplace.settings)
    for _ in range(2):
        collect([workplace.results], target)
    (failure,) = failed(target)
    assert "killed by SIGABRT: out of memory" in failure.read_text()
    workplace.behave(FAKE_BENCH_CRASHES="", FAKE_NOW="2024-01-01T00:00:01Z")
    run(workplace.settings)
    collect([workplace.results], target)
    assert not failed(target)
    assert {path.name for path in workplace.files()} <= {path.name for path in collected(target)}


def test_hosts_with_the_same_processor_keep_failures_of_their_own(
    workplace: Workplace, tmp_path: Path
) -> None:
    target, folder = tmp_path / "all", workplace.results
    collect_of = {}
    for host, crashes in (("one", "nine"), ("../other host", "nine"), ("three", "none")):
        workplace.behave(FAKE_BENCH_CRASHES=crashes)
        run(workplace.settings)
        for file in folder.glob("records/pair/*/*.json"):
            change(file, lambda record, host=host: record["provenance"].update(host=host))  # type: ignore[misc]
        collect([folder], target)
        collect_of[host] = len(failed(target))
    assert collect_of == {"one": 1, "../other host": 2, "three": 2}, (
        "what one host measured the others did not"
    )
    owners = {path.parts[-4] for path in failed(target)}
    assert owners == {"one", "-other-host"}


def test_a_run_leaves_collected_records_alone(source: Path, tmp_path: Path, workplace: Workplace) -> None:
    collect([source], tmp_path / "all")
    (tmp_path / "all" / "records" / "collected").rename(source / "records" / "collected")
    workplace.build(extra="# another program")
    run(workplace.settings)
    assert len(collected(source)) == 2
