"""No folder holds all files of an experiment; folders from before that was so are read as they are."""

from pathlib import Path

import pytest

from experiments.results.collect import collect
from experiments.run.session import run
from experiments.run.study import Study
from experiments.tests.conftest import PAIR, Workplace


@pytest.fixture
def before(empty_workplace: Workplace) -> Workplace:
    """A study whose records stand as they did before there were levels."""
    empty_workplace.question("pair", PAIR)
    assert run(empty_workplace.settings) == 0
    flatten(empty_workplace.results)
    return empty_workplace


def flatten(results: Path) -> None:
    for file in files(results):
        file.rename(file.parent.parent / file.name)
        if not list(file.parent.iterdir()):
            file.parent.rmdir()


def files(results: Path) -> list[Path]:
    return sorted((results / "records").rglob("*.json"))


def test_a_record_stands_below_the_first_letters_of_its_points_id(empty_workplace: Workplace) -> None:
    empty_workplace.question("pair", PAIR)
    assert run(empty_workplace.settings) == 0
    assert files(empty_workplace.results)
    assert {file.parent.name for file in files(empty_workplace.results)} == {
        file.name[:3] for file in files(empty_workplace.results)
    }


def test_an_old_folder_counts(before: Workplace) -> None:
    there = files(before.results)
    assert all(file.parent.name == "pair" for file in there)
    assert run(before.settings) == 0
    assert files(before.results) == there
    study = Study(before.settings)
    [experiment] = study.experiments
    found = study.store.find(experiment)
    assert (len(found.seconds), found.stale) == (len(there), [])
    assert len(study.store.find_block(experiment, 0).seconds) == len(experiment.points)
    assert study.store.has(experiment.points[0], 0)


def test_a_process_that_is_measured_again_leaves_no_second_record(before: Workplace, tmp_path: Path) -> None:
    study = Study(before.settings)
    [experiment] = study.experiments
    point = experiment.points[0]
    old = before.results / "records" / "pair" / f"{point.id}-b0.json"
    scratch = tmp_path / "scratch.json"
    scratch.write_bytes(old.read_bytes())
    study.store.keep_record(point, 0, scratch)
    assert not old.exists()
    assert study.store.record_path(point, 0).exists()
    assert (before.results / "stale" / "records" / "pair" / old.name).exists()


def test_what_was_collected_before_is_not_taken_in_again(
    before: Workplace, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "all"
    collect([before.results], target)
    there = files(target)
    flatten(target)
    collect([before.results], target)
    assert "0 of " in capsys.readouterr().out.splitlines()[-1]
    assert [file.name for file in files(target)] == [file.name for file in there]
