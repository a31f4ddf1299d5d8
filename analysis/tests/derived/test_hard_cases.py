"""The table of the hard cases: verdicts that follow from the records and from nothing else."""

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from analysis import report
from analysis.derived import hard_cases
from analysis.derived.hard_cases import AT_CONTACT, FAILS, HOLDS, LABELS, LIMIT, UNMEASURED, Expectation
from analysis.figures.studies import draw_all
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.report.test_report import text_of
from analysis.tests.synthetic import failure, write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import study

EXPECTED = [
    Expectation("cradle", "right", measure="path_end", at_most={"double": 1e-3, "float": 1e-9}),
    Expectation(
        "fast", "wrong", measure="collision_rate", at_least={"double": 0.5, "float": 0.5}, limit="tunnels"
    ),
    Expectation("scaled_down", "the same", equals="scaled_up", at_most={"double": 0, "float": 0}),
    Expectation("at_rest", "nothing moves", measure="energy"),
]


def records() -> list[dict[str, Any]]:
    return study(["hard_cases"], blocks=1, noise=QUIET)


@pytest.fixture(autouse=True)
def _known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hard_cases, "load", lambda: EXPECTED)


def evaluated(folder: Path, made: list[dict[str, Any]]) -> pd.DataFrame:
    write(folder, made)
    (one,) = split(load(folder))
    return hard_cases.evaluate(one, "hard_cases").set_index(["case", "series"])


def change(made: list[dict[str, Any]], case: str, series: str, **errors: Any) -> None:  # noqa: ANN401
    for record in made:
        if (record["tags"]["scene_name"], record["tags"]["series"]) == (case, series):
            record["errors"] |= errors


def test_every_series_has_a_cell_in_every_case(tmp_path: Path) -> None:
    table = evaluated(tmp_path, records())
    cases = {"cradle", "fast", "scaled_down", "at_rest", "scaled_up", "drift"}
    assert set(table.index) == {(case, series) for case in cases for series in ("published", "row", "float")}


def test_a_measure_is_held_to_the_bound_of_its_precision(tmp_path: Path) -> None:
    table = evaluated(tmp_path, records())
    assert table.loc[("cradle", "published"), "verdict"] == HOLDS
    assert table.loc[("cradle", "published"), "value"] == pytest.approx(1e-5)
    assert table.loc[("cradle", "float"), "verdict"] == FAILS
    assert table.loc[("cradle", "float"), "reason"] == "expected at most 1e-09"


def test_a_limit_of_the_method_must_show(tmp_path: Path) -> None:
    made = records()
    change(made, "fast", "row", collision_rate=0.1)
    table = evaluated(tmp_path, made)
    assert table.loc[("fast", "row"), ["verdict", "reason"]].to_list() == [LIMIT, "tunnels"]
    assert table.loc[("fast", "published"), ["verdict", "reason"]].to_list() == [
        FAILS,
        "expected at least 0.5",
    ]


def test_equal_scenes_are_compared_to_the_last_bit(tmp_path: Path) -> None:
    made = records()
    change(made, "scaled_down", "row", energy_drift=2e-14 * (1 + 2**-52))
    change(made, "scaled_down", "float", time_to_tenth_radius=4, trajectory=None)
    table = evaluated(tmp_path, made)
    assert table.loc[("scaled_down", "published"), "verdict"] == HOLDS
    assert table.loc[("scaled_down", "row"), "verdict"] == FAILS
    assert 0 < table.loc[("scaled_down", "row"), "value"] < 1e-28
    assert table.loc[("scaled_down", "float"), "value"] == float("inf")


def test_without_the_scene_to_compare_with_nothing_is_claimed(tmp_path: Path) -> None:
    made = [record for record in records() if record["tags"]["scene_name"] != "scaled_up"]
    assert evaluated(tmp_path, made).loc[("scaled_down", "row"), "verdict"] == UNMEASURED


def test_a_failure_is_a_cell_with_its_reason(tmp_path: Path) -> None:
    made = [record for record in records() if record["tags"]["scene_name"] != "cradle"]
    made.append(failure("hard_cases", "row", "step 3: left colliding", scene_name="cradle"))
    table = evaluated(tmp_path, made)
    assert table.loc[("cradle", "row"), ["verdict", "reason"]].to_list() == [FAILS, "step 3: left colliding"]
    assert table.loc[("cradle", "published"), "verdict"] == UNMEASURED


def test_a_measure_that_is_missing_fails_unless_none_is_asked_for(tmp_path: Path) -> None:
    made = records()
    change(made, "at_rest", "row", energy_drift=None)
    change(made, "fast", "row", collision_rate=None)
    table = evaluated(tmp_path, made)
    assert table.loc[("at_rest", "row"), "verdict"] == HOLDS
    assert table.loc[("fast", "row"), "verdict"] == FAILS


def test_the_report_has_verdict_and_number_of_every_cell(tmp_path: Path) -> None:
    write(tmp_path, records())
    (drawn,) = draw_all(tmp_path)
    assert [table.title for table in drawn.tables] == ["In double precision:", "In float precision:"]
    assert all(len(table.rows) == 6 for table in drawn.tables)
    text = text_of(report.render(tmp_path))
    assert "cradle: right" in text
    assert "✓ 1.0e-05" in text
    assert "✗ 1.0e-05: expected at most 1e-09" in text
    assert "Of 18 cells" in drawn.caption


def at_contact(made: list[dict[str, Any]], series: str) -> None:
    for record in made:
        if record["tags"]["series"] == series:
            record["axes"]["impact"] = AT_CONTACT


def test_a_variant_at_contact_is_held_to_what_is_expected_of_such(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = Expectation("cradle", "exact", measure="path_end", at_most={"double": 1e-6}, impact=AT_CONTACT)
    monkeypatch.setattr(hard_cases, "load", lambda: [*EXPECTED, own])
    made = records()
    at_contact(made, "row")
    table = evaluated(tmp_path, made)
    assert table.loc[("cradle", "row"), ["title", "verdict", "bound"]].to_list() == [
        "cradle, at_contact", FAILS, 1e-6,
    ]  # fmt: skip
    assert table.loc[("cradle", "published"), ["title", "verdict", "bound"]].to_list() == [
        "cradle", HOLDS, 1e-3,
    ]  # fmt: skip
    assert table.loc[("fast", "row"), "title"] == "fast"


def test_variants_at_contact_have_a_table_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = Expectation("cradle", "exact", measure="energy", at_most={"double": 1e-6}, impact=AT_CONTACT)
    monkeypatch.setattr(hard_cases, "load", lambda: [EXPECTED[0], own, *EXPECTED[1:]])
    made = records()
    at_contact(made, "row")
    write(tmp_path, made)
    (drawn,) = draw_all(tmp_path)
    assert [(table.title, list(table.columns[2:])) for table in drawn.tables] == [
        ("In double precision:", ["published"]),
        ("In double precision, collisions at contact:", ["row"]),
        ("In float precision:", ["float"]),
    ]
    cells = [[cell.text for cell in table.rows[0][:2]] for table in drawn.tables[:2]]
    assert cells == [["cradle: right", LABELS["path_end"]], ["cradle: exact", LABELS["energy"]]]


def test_a_variant_that_only_failed_has_a_table_too(tmp_path: Path) -> None:
    made = [record for record in records() if record["tags"]["series"] == "row"]
    made.append(failure("hard_cases", "nine", "step 3: left colliding", scene_name="cradle"))
    write(tmp_path, made)
    (drawn,) = draw_all(tmp_path)
    assert [table.title for table in drawn.tables] == ["Without any record:", "In double precision:"]
    assert [cell.text for cell in drawn.tables[0].rows[0]][-1] == "✗: step 3: left colliding"


def test_the_shipped_expectations_name_measures_that_exist(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    shipped = hard_cases.load()
    names = [one.name for one in shipped]
    titles = [one.title for one in shipped]
    assert len(titles) == len(set(titles))
    assert {one.impact for one in shipped} == {"", AT_CONTACT}
    for one in shipped:
        assert one.expects
        assert one.measure in LABELS or one.equals in names or not one.measure
        assert bool(one.limit) == bool(one.at_least)
        assert not one.at_least.keys() & one.at_most.keys()
        assert bool(one.at_most or one.at_least) == bool(one.measure or one.equals)
