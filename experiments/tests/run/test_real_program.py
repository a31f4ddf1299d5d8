"""The real program under the real runner, on scenes so small that it takes seconds."""

import json
from dataclasses import replace
from itertools import pairwise

import pytest

from experiments.plan.question import FOLDER, load_question
from experiments.run.session import run
from experiments.run.study import Settings, Study
from experiments.support import process
from experiments.tests.conftest import ERRORS, PAIR, ROOT, Workplace
from support.record_schema import is_record

BUILD = ROOT / "build"

pytestmark = pytest.mark.skipif(
    not (BUILD / "gcc" / "carom").is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)

FASTEST = "nine-wavefront-self_contained_off-resolve_dynamic-sorted-snug-contacts-filtered-active"
"""What is called `fastest` for short."""

PHASES = PAIR.replace('figure = "comparison"', 'figure = "phases"\nverb = "profile"')


@pytest.mark.parametrize("scale", ["paper", "quick"])
def test_every_shipped_question_can_be_planned(workplace: Workplace, scale: str) -> None:
    settings = Settings(scale=scale, results=workplace.results, build=BUILD, questions=FOLDER)
    assert len(Study(settings).experiments) == len(list(FOLDER.glob("*.toml")))


def test_each_rung_of_the_ladder_changes_one_policy_of_the_one_before() -> None:
    done = process.run([str(BUILD / "gcc" / "carom"), "list", "--json"], time_limit=60)
    policies = {one["name"]: one["policies"] for one in json.loads(done.output)}
    policies["fastest"] = policies[FASTEST]
    rungs = [policies[series.variant] for series in load_question(FOLDER / "ladder.toml").series]
    for before, after in pairwise(rungs):
        meaningful = [name for name in after if None not in (before[name], after[name])]
        assert len([name for name in meaningful if before[name] != after[name]]) == 1


def test_a_small_study_end_to_end(workplace: Workplace) -> None:
    workplace.question("phases", PHASES)
    workplace.question("errors", ERRORS)
    assert run(replace(workplace.settings, build=BUILD)) == 0
    assert all(is_record(json.loads(path.read_bytes())) for path in workplace.files())
    for record in workplace.records().values():
        assert record["check"]["verdict"] == "passed"
        if record["tags"].get("scene_name") != "cradle":
            assert record["scene"]["particles"] == 100
            assert record["scene"]["steps"] == 10
        assert record["provenance"]["openmp"]["environment"]["OMP_DYNAMIC"] == "false"
    chunks = workplace.records("chunks").values()
    assert {(one["tags"]["x"], one["axes"]["find_chunk"]) for one in chunks} == {(1, 1), (2, 2), (3, 3)}
    assert {one["kind"] for one in workplace.records("phases").values()} == {"profile"}
    series = {
        one["tags"]["series"]: one["axes"]["neighbourhood"] for one in workplace.records("pair").values()
    }
    assert series == {"four": "four", "nine": "nine"}
    errors = [one for one in workplace.records("errors").values() if one["tags"]["block"] == 0]
    assert len(errors) == 8
    for record in errors:
        assert record["errors"]["trajectory"][0]["rms_distance"] >= 0


def test_every_hard_case_is_asked_about() -> None:
    done = process.run([str(BUILD / "gcc" / "carom"), "generate", "--cases", "--json"])
    cases = [case["name"] for case in json.loads(done.output)]
    question = load_question(FOLDER / "hard_cases.toml")
    assert [place.name for place in question.scenes] == cases
