"""Speed against error, on records with a known order of convergence and a known Pareto front."""

import re
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from analysis.claims.entry import Evidence
from analysis.derived import accuracy
from analysis.derived.accuracy import MEASURES, Measure
from analysis.figures import draw_all, further
from analysis.figures.captions import caption
from analysis.figures.errors import front_of, run_label, speed_against_error
from analysis.figures.style import Drawing
from analysis.records.reading import load
from analysis.records.studies import Study, split
from analysis.report.parts import horizons
from analysis.tests.report.test_report import Page, text_of
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET, Noise, times_table
from analysis.tests.synthetic_points import SUBSTEPS
from analysis.tests.synthetic_study import data_in, page_of, study, tables_of, under

NAME = "speed_against_error"
BY_KEY = {measure.key: measure for measure in MEASURES}


def records(**more: Any) -> list[dict[str, Any]]:  # noqa: ANN401
    return study([NAME], blocks=6, noise=QUIET, seed=4, **more)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Evidence:
    return data_in(tmp_path_factory.mktemp("accuracy"), records())


@pytest.fixture(scope="module")
def measured(whole: Evidence) -> Study:
    return whole.study


@pytest.fixture(scope="module")
def changed(tmp_path_factory: pytest.TempPathFactory) -> Evidence:
    """Row is as fast as checkered, whose energy stays the same; paths of 64 substeps never part; the dense
    scene meets no wall; a second run of each point has other momenta.
    """
    first: dict[str, dict[str, Any]] = {}

    made = records()
    for record in made:
        tags, errors = record["tags"], record["errors"]
        if tags["series"] == "row":
            record["repetitions"][0]["steps_seconds"] /= 1.2
        if tags["block"] == 1:
            errors |= first[tags["point"]] | {"momentum_drift": 2e-15}
        if tags["series"] == "checkered":
            errors["energy_drift"] = 0.0
        if "trajectory" in errors and tags["x"] == 64:
            errors["time_to_tenth_radius"] = None
        if "trajectory" in errors and tags["scene_name"] == "dense":
            errors["pressure_reference"] = 0.0
        first.setdefault(tags["point"], errors)

    return data_in(tmp_path_factory.mktemp("changed"), made)


def drawing(data: Evidence, key: str) -> Drawing:
    drawn = speed_against_error(data, NAME, "Speed against error", BY_KEY[key])
    assert drawn is not None
    return drawn


def points(measured: Study, measure: Measure) -> Any:  # noqa: ANN401
    return accuracy.points(measured, NAME, measure)


def test_a_point_has_its_time_for_a_unit_of_time_and_its_error(measured: Study) -> None:
    table = points(measured, BY_KEY["path"]).set_index(["scene_name", "series", "x"])
    assert len(table) == 3 * 3 * len(SUBSTEPS)
    row = table.loc["medium", "checkered", 4]
    assert row["median"] == pytest.approx(4e-3 * 1.4, rel=0.05)
    assert row["low"] < row["median"] < row["high"]
    assert row["error"] == row["error_low"] == row["error_high"] == pytest.approx(0.2 * 0.4 / 4)
    assert list(dict.fromkeys(table.index.get_level_values("scene_name"))) == ["dilute", "medium", "dense"]


def test_measures_against_the_reference_are_relative(measured: Study) -> None:
    rate = points(measured, BY_KEY["collision_rate"]).set_index(["scene_name", "series", "x"])["error"]
    assert rate["dense", "row", 2] == pytest.approx(0.025)
    parting = points(measured, BY_KEY["parting"]).set_index(["scene_name", "series", "x"])["error"]
    assert (parting["dense", "row", 4], parting["dense", "row", 8]) == (1 / 2, 1 / 4)


def test_paths_that_never_part_are_better_than_any_that_do(changed: Evidence) -> None:
    table = points(changed.study, BY_KEY["parting"])
    assert table.loc[table["x"] == 64, "error"].tolist() == [0.0] * 9, "three series in three scenes"
    assert (table.loc[table["x"] < 64, "error"] > 0).all()


def test_equal_choices_are_both_named(changed: Evidence) -> None:
    table = points(changed.study, BY_KEY["path"])
    double = table[
        (table["precision"] == "double") & (table["scene_name"] == "dense") & (table["error"] < 0.01)
    ]
    choice = accuracy.cheapest(double, accuracy.races(changed.study, NAME)["dense"])
    assert choice is not None
    assert {choice.series, *(series for series, _ in choice.others)} == {"checkered", "row"}
    assert {x for _, x in choice.others} == {16}


def test_errors_that_differ_between_runs_have_a_range(changed: Evidence) -> None:
    assert "Bars across are the range of the errors" in drawing(changed, "momentum").caption
    row = points(changed.study, BY_KEY["momentum"]).iloc[0]
    assert row["error_high"] == 2 * row["error_low"]


def test_zero_has_a_place_on_the_axis(changed: Evidence) -> None:
    drawn = drawing(changed, "energy")
    drawn.figure.draw_without_rendering()
    assert "Errors of exactly 0 stand at the left edge" in drawn.caption
    assert drawn.figure.axes[0].get_xticklabels()[0].get_text() == "0"


def test_where_the_reference_is_0_there_is_no_relative_error(changed: Evidence) -> None:
    assert set(points(changed.study, BY_KEY["pressure"])["scene_name"]) == {"dilute", "medium"}
    assert "dense" not in drawing(changed, "pressure").caption


def test_the_known_order_is_found_and_float_has_less(measured: Study) -> None:
    found = accuracy.orders(points(measured, BY_KEY["path"])).set_index(["scene_name", "series"])["order"]
    assert found["dilute", "checkered"].estimate == pytest.approx(1)
    assert found["dense", "row"].estimate == pytest.approx(1)
    assert found["dilute", "float"].estimate < 0.8


def test_the_known_front_is_found(measured: Study) -> None:
    table = points(measured, BY_KEY["path"])
    for scene, part in table.groupby("scene_name"):
        on_front = part[part["on_front"]]
        floats = on_front[on_front["series"] == "float"]["x"]
        exact_enough = {step for step in SUBSTEPS if 0.2 * part["area_fraction"].iloc[0] / step > 1e-3}
        assert set(floats) - {min(set(SUBSTEPS) - exact_enough, default=0)} == exact_enough, scene
        assert "row" not in set(on_front["series"])


def test_advice_is_the_cheapest_below_each_bound(measured: Study) -> None:
    table = points(measured, BY_KEY["path"])
    advice = dict(accuracy.advice(table, accuracy.races(measured, NAME)))
    assert list(advice) == sorted(advice, reverse=True)
    choice = advice[0.01]["dense"]
    assert choice is not None
    assert (choice.series, choice.substeps) == ("float", 16)
    assert choice.seconds.estimate == pytest.approx(16 * 0.5e-3 * 1.65, rel=0.05)
    assert choice.others == [], "everything else is slower by more than the margin"
    assert accuracy.cheapest(table[table["error"] < 1e-9], accuracy.races(measured, NAME)["dense"]) is None
    tightest = advice[0.001]["dilute"]
    assert tightest is not None
    assert tightest.series == "float", "1e-3 is the floor of float, and not above the bound"
    energy = accuracy.advice(points(measured, BY_KEY["energy"]), accuracy.races(measured, NAME))
    assert [bound for bound, _ in energy] == [1e-6, 1e-13], "bounds with the same choices are one"


def test_the_time_of_the_least_of_equals_is_within_its_interval() -> None:
    noise = Noise(process=0.1, repetition=0.0, burst_rate=0.0, drift=0.0)
    missed = 0
    for seed in range(100):
        timed = times_table(dict.fromkeys("abcdefghijklmnopqrst", 1.0), 9, 1, noise, seed)
        timed = timed.rename(columns={"steps_seconds": "seconds"})
        least = timed.groupby("series")["seconds"].median().idxmin()
        found = accuracy.seconds_of(accuracy.Race(timed), (least, 0.0))
        missed += not found.low < 1 < found.high
    assert missed <= 5


def test_the_figure_says_what_the_error_means_and_how_it_falls(whole: Evidence) -> None:
    drawn = drawing(whole, "path")
    assert len(drawn.figure.axes) == 3
    assert BY_KEY["path"].meaning in drawn.caption
    assert "the same in every run, to the last bit, and has no interval" in drawn.caption
    assert "378 timed runs" in drawn.caption.replace("\u00a0", " ")
    (orders,) = (rows for title, rows in tables_of(drawn).items() if "Order of convergence" in title)
    (checkered,) = (row[1:] for row in orders if row[0] == "checkered")
    assert [cell.split()[0] for cell in checkered] == ["1.00"] * 3
    (advice,) = tables_of(drawing(whole, "energy")).values()
    assert [row[0] for row in advice[1:]] == ["10⁻⁶", "10⁻¹³"], "rounding does not converge"
    assert run_label("row", 1) == "row, dt\u00a0=\u00a01"


def test_the_report_says_how_far_paths_go_and_what_to_use(whole: Evidence) -> None:
    page = page_of(whole.folder)
    text = text_of(page)
    assert "Hard discs are chaotic" in text
    assert "dense by time 2 with 1 and by time 4 with 64 substeps (0.40 collisions per disc" in text
    assert "Zero in every run, and so without a figure: unresolved collisions." in text
    assert re.search(r"0\.01 float, dt.=.1/4: 2\.\d+.ms \[2\.\d+, 2\.\d+\]", text)
    assert len(Page(page).ids) == len(set(Page(page).ids))


def test_an_experiment_of_another_name_is_drawn_alike(tmp_path: Path) -> None:
    entries = further(data_in(tmp_path, under("my_errors", records(), title="Mine")).study)
    assert [entry.name for entry in entries] == [f"my_errors-{key}" for key in BY_KEY]
    assert {entry.experiment for entry in entries} == {"my_errors"}
    assert "Mine: pressure" in [entry.title for entry in entries]


def test_records_without_errors_draw_nothing(tmp_path: Path, data: Evidence) -> None:
    write(tmp_path, [record for record in records() if record["tags"]["block"] > 0])
    assert draw_all(tmp_path) == []
    assert horizons(split(load(tmp_path))[0], NAME) == ""
    assert horizons(data.study, "steps") == ""


def exact_ones(records: list[dict[str, Any]], share: float) -> list[dict[str, Any]]:
    """Return records of the event-driven simulation, which takes `share` of the time of the largest steps."""
    found = []
    for record in records:
        if (record["tags"]["series"], record["tags"]["x"]) != ("checkered", 1):
            continue
        exact = deepcopy(record)
        exact["tags"] |= {"series": "event-driven", "point": f"exact {record['tags']['scene_name']}"}
        exact["axes"] |= {"variant": "event_driven", "impact": "event_driven", "neighbourhood": None}
        for repetition in exact["repetitions"]:
            repetition["steps_seconds"] *= share
        if "trajectory" in exact["errors"]:
            for at in exact["errors"]["trajectory"]:
                at["rms_distance"] = 3e-14
        found.append(exact)
    return found


def test_the_event_driven_simulation_is_on_the_front_without_steps(tmp_path: Path) -> None:
    stepped = records()
    data = data_in(tmp_path, [*stepped, *exact_ones(stepped, 3.0)])
    found = data.study
    table = points(found, BY_KEY["path"])
    exact = table[table["series"] == "event-driven"]
    assert exact[["x", "substeps", "on_front"]].to_numpy().tolist() == [[0, 0, True]] * 3
    assert exact["error"].tolist() == [3e-14] * 3
    dilute = table[table["scene_name"] == "dilute"]
    assert caption("front", runs=front_of(dilute)) == "float with 1, 2 and 4 substeps, then event-driven"
    advice = dict(accuracy.advice(table, accuracy.races(found, NAME)))
    tight = advice[min(advice)]["dense"]
    assert tight is not None
    assert run_label(tight.series, tight.substeps) == "event-driven"
    assert tight.seconds.estimate == pytest.approx(3e-3 * 1.65, rel=0.05)
    assert "event-driven" not in set(accuracy.orders(table)["series"])
    drawn = drawing(data, "path")
    assert "event-driven: without steps" in drawn.caption
    assert "against the same in long double" in drawn.caption
    (told,) = (rows for title, rows in tables_of(drawn).items() if "cheapest" in title)
    assert "event-driven: " in told[-1][1]
