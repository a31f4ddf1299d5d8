"""No folder holds all files of an experiment."""

from pathlib import Path

from experiments.run.session import run
from experiments.tests.conftest import PAIR, Workplace


def files(results: Path) -> list[Path]:
    return sorted((results / "records").rglob("*.json"))


def test_a_record_stands_below_the_first_letters_of_its_points_id(empty_workplace: Workplace) -> None:
    empty_workplace.question("pair", PAIR)
    assert run(empty_workplace.settings) == 0
    assert files(empty_workplace.results)
    assert {file.parent.name for file in files(empty_workplace.results)} == {
        file.name[:3] for file in files(empty_workplace.results)
    }
