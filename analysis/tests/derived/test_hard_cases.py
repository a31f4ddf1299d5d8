"""The table of the hard cases: verdicts that follow from the records and from nothing else."""

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from analysis.derived import hard_cases
from analysis.derived.hard_cases import AT_CONTACT, FAILS, HOLDS, LABELS, LIMIT, UNMEASURED, Expectation
from analysis.figures import draw_all
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.report.test_report import text_of
from analysis.tests.synthetic import failure, write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import page_of, study, tables_of

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


CELLS: dict[tuple[str, str], tuple[str, str | None]] = {
    ("cradle", "published"): (HOLDS, None),
    ("cradle", "float"): (FAILS, "expected at most 1e-09"),
    ("cradle", "row"): (FAILS, "step 3: left colliding"),
    ("fast", "row"): (LIMIT, "tunnels"),
    ("fast", "published"): (FAILS, "expected at least 0.5"),
    ("fast", "float"): (FAILS, "there is no relative error of the collision rate"),
    ("scaled_down", "published"): (HOLDS, None),
    ("scaled_down", "row"): (FAILS, "expected at most 0"),
    ("scaled_down", "float"): (FAILS, "expected at most 0"),
    ("at_rest", "row"): (HOLDS, None),
    ("drift", "row"): (HOLDS, None),
    ("drift", "float"): (UNMEASURED, None),
}
"""The verdict and the reason of a case and a variant, where the records are changed as below."""


def test_each_cell_is_held_to_what_is_expected_of_it(tmp_path: Path) -> None:
    made = records()
    change(made, "fast", "row", collision_rate=0.1)
    change(made, "fast", "float", collision_rate=None)
    change(made, "scaled_down", "row", energy_drift=2e-14 * (1 + 2**-52))
    change(made, "scaled_down", "float", time_to_tenth_radius=4, trajectory=None)
    change(made, "at_rest", "row", energy_drift=None)
    gone = {("cradle", "row"), ("drift", "float")}
    made = [one for one in made if (one["tags"]["scene_name"], one["tags"]["series"]) not in gone]
    made.append(failure("hard_cases", "row", "step 3: left colliding", scene_name="cradle"))
    table = evaluated(tmp_path, made)
    cases = {"cradle", "fast", "scaled_down", "at_rest", "scaled_up", "drift"}
    assert set(table.index) == {(case, series) for case in cases for series in ("published", "row", "float")}
    told = table[["verdict", "reason"]].astype(object).where(table[["verdict", "reason"]].notna(), None)
    assert {cell: tuple(told.loc[cell]) for cell in CELLS} == CELLS
    assert table.loc[("cradle", "published"), "value"] == pytest.approx(1e-5)
    assert 0 < table.loc[("scaled_down", "row"), "value"] < 1e-28, "equal to the last bit"
    assert table.loc[("scaled_down", "float"), "value"] == float("inf")


def test_without_the_scene_to_compare_with_nothing_is_claimed(tmp_path: Path) -> None:
    made = [record for record in records() if record["tags"]["scene_name"] != "scaled_up"]
    assert evaluated(tmp_path, made).loc[("scaled_down", "row"), "verdict"] == UNMEASURED


def test_the_report_has_verdict_and_number_of_every_cell(tmp_path: Path) -> None:
    write(tmp_path, records())
    (drawn,) = draw_all(tmp_path)
    cases = {title: len(rows) - 1 for title, rows in tables_of(drawn).items()}
    assert cases == dict.fromkeys(["In double precision:", "In float precision:"], 6)
    text = text_of(page_of(tmp_path))
    assert "cradle: right" in text
    assert "✓ 1.0e-05" in text
    assert "✗ 1.0e-05: expected at most 1e-09" in text
    assert "Of 18 cells" in drawn.caption


def test_variants_at_contact_are_held_to_what_is_expected_of_such_in_a_table_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = Expectation("cradle", "exact", measure="path_end", at_most={"double": 1e-6}, impact=AT_CONTACT)
    monkeypatch.setattr(hard_cases, "load", lambda: [EXPECTED[0], own, *EXPECTED[1:]])
    made = records()
    for record in made:
        if record["tags"]["series"] == "row":
            record["axes"]["impact"] = AT_CONTACT
    write(tmp_path, made)
    (drawn,) = draw_all(tmp_path)
    told = tables_of(drawn)
    assert {title: rows[0][2:] for title, rows in told.items()} == {
        "In double precision:": ["published"],
        "In double precision, collisions at contact:": ["row"],
        "In float precision:": ["float"],
    }
    cells = [rows[1] for rows in told.values()]
    failed = "✗ 1.0e-05: expected at most"
    assert cells == [
        ["cradle: right", LABELS["path_end"], "✓ 1.0e-05 [holds]"],
        ["cradle: exact", LABELS["path_end"], f"{failed} 1e-06 [fails]"],
        ["cradle: right", LABELS["path_end"], f"{failed} 1e-09 [fails]"],
    ]
    svg = drawn.files[0].read_text(encoding="utf-8")
    assert "cradle, at contact" in svg
    assert "fast, at contact" not in svg
    assert "<!-- RMS distance from the exact -->" in svg, "what the number of a row is"


def test_a_variant_that_only_failed_has_a_table_too(tmp_path: Path) -> None:
    made = [record for record in records() if record["tags"]["series"] == "row"]
    made.append(failure("hard_cases", "nine", "step 3: left colliding", scene_name="cradle"))
    write(tmp_path, made)
    (drawn,) = draw_all(tmp_path)
    told = tables_of(drawn)
    assert list(told) == ["Without any record:", "In double precision:"]
    assert told["Without any record:"][1][-1] == "✗: step 3: left colliding [fails]"


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
