"""Promised against delivered errors: what is kept, what it costs, and what is not known."""

from pathlib import Path
from typing import Any

import pytest

from analysis.figures.promises import promises
from analysis.figures.style import Data, Drawing
from analysis.records import published
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests import synthetic_promises as synthetic
from analysis.tests.synthetic import write
from analysis.tests.synthetic_study import study


@pytest.fixture
def runs() -> list[dict[str, Any]]:
    return [record for record in study(["promises"], blocks=1) if record["kind"] == "bench"]


def drawn(folder: Path, records: list[dict[str, Any]]) -> Drawing | None:
    write(folder, records)
    studies = split(load(folder))
    return promises(Data(studies[0], studies, published.load(), folder), "promises", "Promises")


def test_the_caption_counts_what_is_kept_and_what_it_costs(
    tmp_path: Path, runs: list[dict[str, Any]]
) -> None:
    first, second = runs
    drawing = drawn(
        tmp_path, [*runs, synthetic.promises(first), synthetic.promises(second, broken="pressure")]
    )
    assert drawing is not None
    assert "on 2\u00a0scenes" in drawing.caption
    assert "Kept: paths 6 of 6; collision rate 6 of 6; pressure 3 of 6." in drawing.caption
    assert "at most 1.50 in 12 of 18, ×2.00 in the worst" in drawing.caption
    (table,) = drawing.tables
    marks = [row[3].mark for row in table.rows]
    assert marks.count("fails") == 3
    assert marks.count("holds") == 15
    assert [row[4].mark for row in table.rows].count("open") == 6


def test_what_an_earlier_revision_promised_is_not_shown_beside(
    tmp_path: Path, runs: list[dict[str, Any]]
) -> None:
    earlier = synthetic.promises(runs[1], broken="path")
    earlier["provenance"] = earlier["provenance"] | {"commit": "0" * 40}
    drawing = drawn(tmp_path, [*runs, synthetic.promises(runs[0]), earlier])
    assert drawing is not None
    assert "Kept: paths 3 of 3; collision rate 3 of 3; pressure 3 of 3." in drawing.caption


def test_a_bound_for_which_no_method_is_known_is_neither_kept_nor_drawn(
    tmp_path: Path, runs: list[dict[str, Any]]
) -> None:
    record = synthetic.promises(runs[0])
    nothing = dict.fromkeys(("promised", "trial_seconds", "methods", "chosen", "cheapest"))
    record["promises"][0] |= nothing
    drawing = drawn(tmp_path, [*runs, record])
    assert drawing is not None
    assert "paths 2 of 2" in drawing.caption
    assert "For 1\u00a0bound no method was known to do." in drawing.caption
    assert len(drawing.tables[0].rows) == 8


def test_an_error_that_cannot_be_told_is_no_promise_kept(tmp_path: Path, runs: list[dict[str, Any]]) -> None:
    record = synthetic.promises(runs[0])
    record["promises"][0]["chosen"]["error"] = None
    drawing = drawn(tmp_path, [*runs, record])
    assert drawing is not None
    assert "paths 2 of 3" in drawing.caption


def test_without_records_nothing_is_drawn(tmp_path: Path, runs: list[dict[str, Any]]) -> None:
    assert drawn(tmp_path, runs) is None
