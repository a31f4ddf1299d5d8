"""What a question states of its verdicts, read from records of today and from those of before."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.commands.open_questions import open_questions
from analysis.derived.comparisons import USUAL, Stated, differences, differences_from, reference, stated
from analysis.figures import draw_all
from analysis.records.reading import load
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET, Noise
from analysis.tests.synthetic_study import study

PACE = {"old": 1.0, "new": 1.03}


def measured(folder: Path, blocks: int = 9, **tags: object) -> pd.DataFrame:
    """The times of `old`, the first of the file, and `new`, which takes 3 % longer, with these tags."""
    records = study(["neighbourhood"], blocks=blocks, noise=QUIET)
    for record in records:
        name = {"four": "new", "nine": "old"}[record["tags"]["series"]]
        number = list(PACE).index(name) + 1
        record["axes"]["variant"] = "nine"
        record["tags"] |= {"experiment": "mine", "series": name, "series_number": number, **tags}
        wobble = 1 + 0.002 * np.sin(7 * record["tags"]["block"] + number)
        record["repetitions"] = [{"steps_seconds": PACE[name] * wobble, "cpu_seconds": 1.0}]
    write(folder, records)
    return load(folder).times


def test_without_a_word_the_first_of_the_file_is_the_reference(tmp_path: Path) -> None:
    times = measured(tmp_path)
    assert reference(times) == "old", "not the first by alphabet"
    assert stated(times) == USUAL
    assert reference(times.assign(series_number=None)) == "new", "records that do not tell the order"
    published = ["published" if one == "new" else "x" for one in times["series"]]
    assert reference(times.assign(variant=published)) == "new", "the only one of the published variant"


def test_the_reference_is_the_one_that_is_stated(tmp_path: Path) -> None:
    times = measured(tmp_path, reference="new")
    assert reference(times) == "new"
    assert (
        reference(times.assign(variant=["published" if one == "old" else "x" for one in times["series"]]))
        == "new"
    )
    assert reference(times[times["series"] == "old"]) == "old", "it was not measured"


def test_the_latest_record_counts(tmp_path: Path) -> None:
    times = measured(tmp_path, margin=0.02).sort_values("recorded_at", kind="stable")
    times.loc[times.index[-1], "margin"] = 0.1
    assert stated(times) == Stated(0.1)


@pytest.mark.parametrize("found", ["wide", 0, -1, 3, None])
def test_what_is_no_margin_is_the_usual_one(tmp_path: Path, found: object) -> None:
    assert stated(measured(tmp_path).assign(margin=found)) == USUAL


@pytest.mark.parametrize(("margin", "verdict"), [(0.02, "slower"), (0.05, "equivalent")])
def test_a_difference_is_judged_by_the_margin_that_is_stated(
    tmp_path: Path, margin: float, verdict: str
) -> None:
    times = measured(tmp_path, margin=margin)
    both = differences(times, "old"), differences_from(times, times["series"] == "old")
    assert [list(table["verdict"]) for table in both] == [[verdict]] * 2


def test_an_error_that_is_stated_decides_and_is_that_of_the_interval(tmp_path: Path) -> None:
    [usual], [strict], [lax] = (
        differences(measured(tmp_path / str(error), error=error), "old").to_dict("records")
        for error in (0.05, 1e-9, 0.5)
    )
    assert [one["verdict"] for one in (usual, strict, lax)] == ["slower", "inconclusive", "slower"]
    assert strict["low"] < 1.02 < usual["low"] < lax["low"], "the interval that decides is the one shown"
    assert usual["p"] == strict["p"] == lax["p"]


def test_the_figure_and_the_running_study_judge_by_it(tmp_path: Path) -> None:
    measured(tmp_path, margin=0.05, error=0.01, reference="new", figure="comparison", title="Mine")
    [drawn] = draw_all(tmp_path, ["mine"])
    assert drawn.verdicts is not None
    assert drawn.verdicts["name"].to_list() == ["old against new"]
    assert (
        "equivalent with a margin of 5 % (shaded; the bar is the 99 % interval, which decides)"
        in drawn.caption
    )
    answer = open_questions(tmp_path)
    assert answer["settled"] == ["mine"]
    assert answer["said"]["mine: old against new"].startswith("equivalent")


def test_a_stricter_error_asks_for_more_blocks(tmp_path: Path) -> None:
    needed = []
    for error in (0.05, 1e-5):
        folder = tmp_path / str(error)
        noise = Noise(process=0.025, repetition=0, burst_rate=0, drift=0)
        records = study(["neighbourhood"], blocks=9, noise=noise, seed=2)
        for record in records:
            record["tags"] |= {"experiment": "mine", "error": error}
        write(folder, records)
        needed.append(open_questions(folder)["open"]["mine"]["needed"])
    assert needed[0] < needed[1]


@pytest.mark.parametrize(("kind", "compared"), [("comparison", True), ("trend", False), (None, True)])
def test_the_kind_says_whether_each_difference_has_a_verdict_and_not_the_figure(
    tmp_path: Path, kind: str | None, compared: bool
) -> None:
    drawn = {"comparison": "trend", "trend": "comparison", None: "comparison"}[kind]
    if kind is None:
        measured(tmp_path, figure=drawn)
    else:
        measured(tmp_path, figure=drawn, kind=kind)
    assert open_questions(tmp_path)["settled"] == (["mine"] if compared else [])
