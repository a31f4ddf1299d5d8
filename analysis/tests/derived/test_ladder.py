"""The ladder's table, figure and sentences, from synthetic records whose factors are known."""

import re
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from analysis.claims.entry import Evidence
from analysis.derived.ladder import claims, factors, headlines, named, rungs, speed_up, totals
from analysis.figures.profiles import waterfall
from analysis.figures.style import Drawing, styled
from analysis.records.studies import Study
from analysis.statistics.verdicts import Ratio
from analysis.support.wording import NO_INTERVAL
from analysis.tests.synthetic import failure, profile
from analysis.tests.synthetic_noise import QUIET, Noise
from analysis.tests.synthetic_points import LADDER
from analysis.tests.synthetic_study import SHARES, data_in, page_of, study, tables_of

FACTORS = [factor for factor, _ in LADDER.values()]


def ladder_records(noise: Noise = QUIET) -> list[dict[str, Any]]:
    return study(["ladder"], blocks=9, noise=noise)


def tables(one: Study) -> tuple[pd.DataFrame, pd.DataFrame]:
    return named(one.runs_of("ladder")), named(one.times_of("ladder"))


def drawn(data: Evidence) -> Drawing:
    with styled("ladder"):
        drawing = waterfall(data, "ladder", "the ladder")
    assert drawing is not None
    return drawing


def texts(drawing: Drawing) -> list[str]:
    return [text.get_text() for axes in drawing.figure.axes for text in axes.texts]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Evidence:
    """A whole ladder on both scenes."""
    return data_in(tmp_path_factory.mktemp("ladder"), ladder_records())


def test_each_rung_is_judged_against_the_one_before_on_its_scene(whole: Evidence) -> None:
    _, times = tables(whole.study)
    table = factors(times)
    assert len(table) == 2 * (len(LADDER) - 1)
    for row in table.itertuples():
        truth = FACTORS[int(row.series_number) - 1]
        assert 1 / row.ratio == pytest.approx(truth, rel=0.01)
        assert row.verdict == ("faster" if truth > 1 else "equivalent")
        assert row.blocks == 9
    assert list(totals(times)["scene_name"]) == ["dense", "sparse"]
    for row in totals(times).itertuples():
        assert 1 / row.ratio == pytest.approx(2.5, rel=0.01)
        assert row.low < 1 / 2.5 < row.high


def test_the_report_says_the_totals_where_there_are_any(tmp_path: Path, whole: Evidence) -> None:
    said = headlines(whole.study)
    assert said == claims(*tables(whole.study))
    assert len(said) == 2
    text = " ".join(page_of(whole.folder).split())
    for sentence in said:
        assert re.search(r"2\.5\d? × \[.*\] faster than the published best \(faster\)", sentence)
        assert " ".join(sentence.split()) in text
    assert headlines(data_in(tmp_path, study(["steps"], blocks=2)).study) == []


def test_a_rung_shows_its_time_its_work_and_the_policy_that_it_changes(whole: Evidence) -> None:
    table = rungs(*tables(whole.study), whole.study.counters)
    sparse = table[table["scene_name"] == "sparse"].sort_values("series_number")
    assert list(sparse["change"]) == ["published", "storage sorted", "order strips", "overlaps contacts"]
    assert list(sparse["passed"]) == list(sparse["records"]) == [9] * 4
    assert sparse["nanoseconds"].iloc[0] == pytest.approx(1e9 / (100_000 * 100), rel=0.05)
    assert (sparse["low"] <= sparse["nanoseconds"]).all()
    assert (sparse["resolves"] == 1.2).all()
    assert (sparse["sweeps"] == 4).all()
    assert sparse["instructions"].isna().all()


def test_instructions_are_those_of_profiled_runs_of_the_variant_on_such_a_scene(tmp_path: Path) -> None:
    records = ladder_records()
    counted = {"name": "instructions", "thread": None, "source": "cachegrind", "reason": None, "remedy": None}
    first = next(record for record in records if record["axes"]["variant"] == "sorted")
    elsewhere = first | {"tags": first["tags"] | {"experiment": "profiled", "point": "p1"}}
    records.append(profile(elsewhere, SHARES, [counted | {"value": 7 * 100_000 * 100}]))
    data = data_in(tmp_path, records)
    table = rungs(*tables(data.study), data.study.counters).set_index(["scene_name", "variant"])[
        "instructions"
    ]
    assert table["sparse", "sorted"] == 7
    assert table.drop(("sparse", "sorted")).isna().all()
    assert "Instructions per disc and step (cachegrind): storage sorted 7" in drawn(data).caption


def test_the_figure_says_every_factor_and_the_caption_the_totals(whole: Evidence) -> None:
    drawing = drawn(whole)
    said = texts(drawing)
    assert sum(text.startswith("× 1.2") or text.startswith("× 1.25") for text in said) == 2
    assert said.count("✓") == 2 * len(LADDER) + 2, "a mark for each rung, and the headings"
    assert "✗" not in said
    assert "100\u00a0000 discs at area fraction 0.80: 2.5" in drawing.caption
    assert "all 72\u00a0results passed" in drawing.caption
    assert "were not counted" in drawing.caption
    (table,) = tables_of(drawing).values()
    assert table[2] == ["sorted", "storage sorted", "sorted"]
    assert drawing.verdicts is not None
    assert list(drawing.verdicts["name"].str.contains("storage sorted")).count(True) == 2


def test_a_rung_that_fails_its_check_is_shown_as_wrong_and_has_no_time(tmp_path: Path) -> None:
    records = ladder_records()
    for record in records:
        if record["axes"]["variant"] == "strips-sorted":
            record["repetitions"] = []
            record["check"] |= {"verdict": "failed", "reason": "step 3: two discs left colliding"}
    drawing = drawn(data_in(tmp_path, records))
    assert texts(drawing).count("✗") == 2
    assert texts(drawing).count("none") == 2
    assert "18 of 72\N{NO-BREAK SPACE}results failed" in drawing.caption


def test_a_rung_without_a_result_is_named_and_lends_its_place_to_no_other(tmp_path: Path) -> None:
    records = ladder_records()
    first, third = (list(LADDER)[index] for index in (0, 2))
    lacking = {"dense": first, "sparse": third}
    kept = [
        record for record in records if lacking[str(record["tags"]["scene_name"])] != record["tags"]["series"]
    ]
    assert len(kept) == len(records) - 18
    failed = failure("ladder", third, "step 3: two discs left colliding", scene_name="sparse")
    data = data_in(tmp_path, [*kept, failed])
    runs, times = tables(data.study)
    assert list(totals(times)["scene_name"]) == ["sparse"], "without its first rung a scene has no total"
    steps = factors(times).groupby("scene_name")["series_number"].agg(set)
    assert steps["dense"] == set(range(3, len(LADDER) + 1))
    assert steps["sparse"] == set(range(2, len(LADDER) + 1)) - {3, 4}
    drawing = drawn(data)
    assert texts(drawing).count("no result") == 2
    assert sum("faster than the published best" in sentence for sentence in claims(runs, times)) == 1
    assert "1 of 55\N{NO-BREAK SPACE}results failed" in drawing.caption


def test_noise_leaves_a_small_factor_inconclusive(tmp_path: Path) -> None:
    _, times = tables(data_in(tmp_path, ladder_records(Noise(process=0.1))).study)
    equal = factors(times).query("series_number == 3")
    assert set(equal["verdict"]) == {"inconclusive"}


def test_a_factor_without_an_interval_says_so() -> None:
    assert speed_up(Ratio(ratio=0.25)) == f"4.00 × {NO_INTERVAL}"
    assert speed_up(Ratio(ratio=0.5, low=0.4, high=0.625)) == "2.00 × [1.60, 2.50]"
