"""The limits of the machine: measured once, before anything is compared with them, and never in vain."""

import os
from dataclasses import replace

import pytest

from experiments.run.machine_limits import FOLDER
from experiments.run.session import run
from experiments.tests.conftest import DAMAGES, PAIR, Workplace, damage

LIMITS = PAIR.replace('figure = "comparison"', 'figure = "limits"\nverb = "profile"\nthreads = 1')


@pytest.fixture
def place(empty_workplace: Workplace) -> Workplace:
    empty_workplace.question("close", LIMITS)
    return empty_workplace


def calls_of(place: Workplace, verb: str) -> list[list[str]]:
    return [call["words"] for call in place.calls() if call["words"][0] == verb]


def test_they_are_measured_once_before_the_first_profile_of_an_experiment_that_needs_them(
    place: Workplace,
) -> None:
    place.question("pair", PAIR)
    assert run(place.settings) == 0
    assert run(replace(place.settings, blocks=4)) == 0
    (words,) = calls_of(place, "limits")
    assert words[1:3] == ["--threads", "1"]
    environments = {call["words"][0]: call["openmp"] for call in place.calls()}
    assert environments["limits"] == environments["profile"], "bound alike"
    verbs = [*environments]
    assert verbs.index("limits") < verbs.index("profile")
    (record,) = place.records(FOLDER).values()
    assert record["kind"] == "limits"
    assert record["tags"]["experiment"] == FOLDER
    assert not (place.results / "timelines").exists()


def test_another_program_has_limits_of_its_own(place: Workplace) -> None:
    assert run(place.settings) == 0
    place.build(extra="# another one")
    assert run(place.settings) == 0
    assert len(place.files(FOLDER)) == 2


def test_without_limits_nothing_is_profiled_and_the_reason_is_kept(place: Workplace) -> None:
    place.behave(FAKE_LIMITS_FAIL="1")
    assert run(place.settings) == 2
    assert calls_of(place, "profile") == []
    assert {failure["reason"] for failure in place.failures()} == {
        "limits of the machine: --threads: found 2, but OpenMP grants 1"
    }


@pytest.mark.parametrize("kind", DAMAGES)
def test_damaged_ones_are_put_aside_and_measured_again(place: Workplace, kind: str) -> None:
    assert run(place.settings) == 0
    (path,) = place.results.glob(f"records/{FOLDER}/*.json")
    damage(path, kind)
    assert run(replace(place.settings, blocks=4)) == 0
    (record,) = place.records(FOLDER).values()
    assert record["kind"] == "limits"
    assert os.path.lexists(place.results / "stale" / "records" / FOLDER / path.name)
