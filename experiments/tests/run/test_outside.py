"""A general engine beside the variants: once a block for each scene and substeps, where it is built in."""

from dataclasses import replace

import pytest

from experiments.run.beside import BESIDE
from experiments.run.session import run
from experiments.tests.conftest import DAMAGES, ERRORS, PAIR, Workplace, damage

FOLDER = BESIDE["speed_against_error"].folder


@pytest.fixture
def place(empty_workplace: Workplace) -> Workplace:
    empty_workplace.question("errors", ERRORS)
    return empty_workplace


def calls(place: Workplace) -> list[list[str]]:
    return [call["words"] for call in place.calls() if call["words"][0] == "outside"]


def test_it_is_measured_once_a_block_for_each_scene_and_number_of_substeps(place: Workplace) -> None:
    place.behave(FAKE_OUTSIDE="measure")
    assert run(replace(place.settings, blocks=3)) == 0
    assert len(calls(place)) == 3 * 2 * 2
    assert run(replace(place.settings, blocks=3)) == 0
    assert len(calls(place)) == 3 * 2 * 2, "what is there is not measured again"
    records = place.records(FOLDER).values()
    assert len(records) == 3 * 2 * 2
    assert {record["kind"] for record in records} == {"outside"}
    found = {(record["tags"]["block"], record["axes"]["substeps"]) for record in records}
    assert found == {(block, substeps) for block in range(3) for substeps in (1, 2)}
    assert {record["tags"]["experiment"] for record in records} == {"errors"}


def test_a_program_built_without_it_is_asked_once(
    place: Workplace, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(place.settings) == 0
    assert len(calls(place)) == 1
    assert place.records(FOLDER) == {}
    assert "outside" not in capsys.readouterr().err


def test_that_it_fails_is_said_and_fails_no_point(
    place: Workplace, capsys: pytest.CaptureFixture[str]
) -> None:
    place.behave(FAKE_OUTSIDE="out of memory")
    assert run(place.settings) == 0
    assert place.failures() == []
    assert "outside engine: not measured: out of memory" in capsys.readouterr().err


def test_other_figures_do_not_pay_for_it(empty_workplace: Workplace) -> None:
    empty_workplace.question("pair", PAIR)
    empty_workplace.behave(FAKE_OUTSIDE="measure")
    assert run(empty_workplace.settings) == 0
    assert calls(empty_workplace) == []


@pytest.mark.parametrize("kind", DAMAGES)
def test_a_damaged_record_is_put_aside_and_measured_again(place: Workplace, kind: str) -> None:
    place.behave(FAKE_OUTSIDE="measure")
    assert run(place.settings) == 0
    damaged = sorted(place.results.glob(f"records/{FOLDER}/*.json"))[0]
    damage(damaged, kind)
    for path in place.results.glob("records/errors/*/*.json"):
        path.unlink()
    assert run(place.settings) == 0
    assert {record["kind"] for record in place.records(FOLDER).values()} == {"outside"}
    assert (place.results / "stale" / "records" / FOLDER / damaged.name).exists()
