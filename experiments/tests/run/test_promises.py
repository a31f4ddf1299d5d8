"""Promises of errors: seen once on each scene of their question, and never in vain."""

from dataclasses import replace

import pytest

from experiments.run.beside import BESIDE
from experiments.run.session import run
from experiments.tests.conftest import PAIR, ROOT, Workplace

FOLDER = BESIDE["promises"].folder
PROMISES = PAIR.replace('figure = "comparison"\nclaim = "four_boxes"', 'figure = "promises"\nthreads = 1')


@pytest.fixture
def place(empty_workplace: Workplace) -> Workplace:
    empty_workplace.question("word", PROMISES)
    return empty_workplace


def calls(place: Workplace) -> list[list[str]]:
    return [call["words"] for call in place.calls() if call["words"][0] == "promises"]


def test_they_are_seen_once_on_each_scene(place: Workplace) -> None:
    assert run(place.settings) == 0
    assert run(replace(place.settings, blocks=4)) == 0
    (words,) = calls(place)
    assert words[2:4] == ["--threads", "1"]
    (record,) = place.records(FOLDER).values()
    assert record["kind"] == "promises"
    assert record["tags"]["experiment"] == "word"


def test_they_may_take_longer_than_a_process(place: Workplace) -> None:
    """They run the scene many times."""
    site = (ROOT / "experiments" / "sites" / "local.toml").read_text(encoding="utf-8")
    impatient = place.root / "impatient.toml"
    impatient.write_text(
        site.replace("time_limit_seconds = 600", "time_limit_seconds = 0.5"), encoding="utf-8"
    )
    place.behave(FAKE_PROMISES_SECONDS="1")
    assert run(replace(place.settings, site=str(impatient))) == 0
    assert len(place.records(FOLDER)) == 1


def test_another_program_has_promises_of_its_own(place: Workplace) -> None:
    assert run(place.settings) == 0
    place.build(extra="# another one")
    assert run(place.settings) == 0
    assert len(place.records(FOLDER)) == 2


def test_other_figures_do_not_pay_for_them(workplace: Workplace) -> None:
    assert run(workplace.settings) == 0
    assert calls(workplace) == []


def test_without_them_nothing_is_measured_and_the_reason_is_kept(place: Workplace) -> None:
    place.behave(FAKE_PROMISES_FAIL="1")
    assert run(place.settings) == 2
    assert {failure["reason"] for failure in place.failures()} == {
        "promises: no exact run to measure an error by"
    }
