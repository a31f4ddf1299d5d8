"""A whole study with a fake program: complete, resumed, stale; what is there is never lost."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.run.session import run
from experiments.run.study import Study
from experiments.tests.conftest import ERRORS, PAIR, Workplace
from support.errors import InputError
from support.record_schema import is_record


def test_a_study_leaves_a_record_for_every_point_and_block(workplace: Workplace) -> None:
    assert run(workplace.settings) == 0
    assert {name: len(workplace.records(name)) for name in ("chunks", "control", "pair")} == {
        "chunks": 6,
        "control": 6,
        "pair": 4,
    }
    for file in workplace.files():
        assert is_record(json.loads(file.read_bytes()))
        assert file.stem.endswith(f"-{file.parent.name}"), "no folder holds all of an experiment"
    assert len(workplace.files()) == 2 + 2 + 3, "one a process"
    assert not (workplace.results / ".running").exists()
    assert not workplace.failures()


def test_a_record_remembers_its_place_in_the_plan(workplace: Workplace) -> None:
    run(workplace.settings)
    for name, record in workplace.records("chunks").items():
        tags = record["tags"]
        assert name == f"{tags['point']}-b{tags['block']}"
        assert (tags["experiment"], tags["x_name"], tags["series"]) == ("chunks", "chunk", "guided")
        assert record["axes"]["find_chunk"] == tags["x"]
        assert (tags["points_planned"], tags["blocks_planned"]) == (3, 2)
        assert tags["scale"] == "paper"
        assert (tags["site"], tags["title"]) == ("local", "Chunks")
    places = {(one["tags"]["block"], one["tags"]["position"]) for one in workplace.records("chunks").values()}
    assert places == {(block, position) for block in range(2) for position in range(3)}
    labels = [one["tags"]["label"] for one in workplace.records("control").values()]
    assert sorted(labels) == ["A"] * 3 + ["A-again"] * 3
    assert {one["tags"]["claim"] for one in workplace.records("pair").values()} == {"four_boxes"}


def test_the_control_is_spread_over_the_study(workplace: Workplace) -> None:
    run(workplace.settings)
    tags = [call["words"] for call in workplace.calls() if "--tag" in call["words"]]
    order = [next(word for word in words if word.startswith("experiment=")) for words in tags]
    places = [place for place, name in enumerate(order) if name == "experiment=control"]
    assert places[0] < len(order) / 3
    assert places[-1] > len(order) * 2 / 3


def test_openmp_is_told_what_the_site_says_and_nothing_else(workplace: Workplace) -> None:
    workplace.behave(OMP_SCHEDULE="static,7", OMP_NUM_THREADS="13")
    run(workplace.settings)
    for call in workplace.calls():
        if "--threads" in call["words"]:
            threads = call["words"][call["words"].index("--threads") + 1]
            assert call["openmp"]["OMP_NUM_THREADS"] == threads
            waiting = {"GOMP_SPINCOUNT", "KMP_BLOCKTIME"}
            binding = {"OMP_DYNAMIC", "OMP_NUM_THREADS", "OMP_PLACES", "OMP_PROC_BIND"}
            assert call["openmp"].keys() == waiting | binding


def test_a_variant_is_verified_once_before_it_is_timed(workplace: Workplace) -> None:
    run(workplace.settings)
    verbs = [(call["words"][0], "--tag" in call["words"]) for call in workplace.calls()]
    checks = [call["words"] for call in workplace.calls() if call["words"][0] == "check"]
    checked = [(words[words.index("--variant") + 1], words[-1]) for words in checks]
    assert sorted(checked) == [("nine", "published"), ("published", "published"), ("published", "relative")]
    assert verbs.index(("check", False)) < verbs.index(("bench", True))
    assert ("limits", True) not in verbs, "which nothing is compared with here"


def test_errors_are_measured_once_a_point_on_scenes_that_are_checked_each(empty_workplace: Workplace) -> None:
    workplace = empty_workplace
    workplace.question("errors", ERRORS)
    assert run(workplace.settings) == 0
    records = workplace.records("errors").values()
    assert len(records) == 16
    checks = [call["words"] for call in workplace.calls() if call["words"][0] == "check"]
    scenes = sorted(Path(words[1]).name.split("-")[0] for words in checks if "nine" in words)
    assert scenes == ["100", "case"]
    assert all((record["tags"]["block"] == 0) == ("trajectory" in record["errors"]) for record in records)
    assert {record["tags"]["scene_name"] for record in records} == {"dilute", "cradle"}


def test_cachegrind_counts_once_a_point(workplace: Workplace) -> None:
    text = PAIR.replace("[scene]", 'verb = "profile"\nsimulated = 3\n\n[scene]', 1)
    workplace.question("pair", text)
    assert run(workplace.settings) == 0
    assert run(replace(workplace.settings, scale="quick", results=workplace.root / "quick")) == 0
    counted = [call["words"] for call in workplace.calls() if "--simulated" in call["words"]]
    assert len(counted) == 2, "each point once, and only at paper scale"
    assert all(words[words.index("--simulated-steps") + 1] == "3" for words in counted)


def test_a_record_without_the_errors_asked_for_is_measured_again(workplace: Workplace) -> None:
    workplace.question("errors", ERRORS)
    run(workplace.settings)
    path = workplace.files("errors", "0")[0]
    record = json.loads(path.read_text())
    del record["contenders"][0]["errors"]["trajectory"]
    path.write_text(json.dumps(record))
    assert workplace.rows()["errors"].stale == 1
    assert run(workplace.settings) == 0
    assert "trajectory" in json.loads(path.read_text())["contenders"][0]["errors"]


def test_only_what_is_missing_is_run(workplace: Workplace) -> None:
    run(workplace.settings)
    lost = workplace.files(block="1")
    for path in lost:
        path.unlink()
    done = workplace.measured()
    assert run(workplace.settings) == 0
    assert workplace.measured() - done == 3 + 2 + 2
    assert all(path.exists() for path in lost)


def test_a_renamed_series_is_measured_again(workplace: Workplace) -> None:
    run(workplace.settings)
    workplace.question("pair", PAIR.replace('name = "four"', 'name = "4"'.replace("4", "quadrant")))
    assert workplace.rows()["pair"].stale == 4, "whole processes"
    run(workplace.settings)
    assert {one["tags"]["series"] for one in workplace.records("pair").values()} == {"quadrant", "nine"}


def test_a_damaged_scene_is_generated_again(workplace: Workplace) -> None:
    run(workplace.settings)
    scene = next(workplace.results.glob("scenes/100-*.in"))
    content = scene.read_text()
    scene.write_text(content + "1\n")
    for path in workplace.files("pair"):
        path.unlink()
    run(workplace.settings)
    assert scene.read_text() == content


def test_more_blocks_keep_those_that_are_there(workplace: Workplace) -> None:
    run(workplace.settings)
    before = workplace.records("pair")
    run(replace(workplace.settings, blocks=4))
    assert len(workplace.records("pair")) == 8
    assert before.items() <= workplace.records("pair").items()
    row = workplace.rows()["pair"]
    assert (row.blocks, row.done, row.missing) == (4, 8, 0), "more than the question asks for"


def test_a_program_that_changes_under_the_study_stops_it(
    workplace: Workplace, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study(workplace.settings)
    workplace.build(extra="# built anew")
    monkeypatch.setattr("experiments.run.session.Study", lambda _: study)
    with pytest.raises(InputError, match="was built anew while the study ran"):
        run(workplace.settings)
    assert not workplace.records()
    assert not workplace.failures()


def test_a_part_of_the_study_leaves_the_rest_alone(workplace: Workplace) -> None:
    run(workplace.settings)
    chunks = workplace.records("chunks")
    workplace.build(extra="# a change")
    run(replace(workplace.settings, study=("pair",)))
    assert workplace.records("chunks") == chunks
