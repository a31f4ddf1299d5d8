import json
import re
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pandas as pd
import pytest

from analysis import figures
from analysis.claims import evidence_of
from analysis.claims.entry import Evidence
from analysis.figures import FIGURES, Entry, draw_all
from analysis.figures.comparisons import ratio_panel
from analysis.figures.labels import label_ends, spread
from analysis.figures.style import Point, new_figure, styled
from analysis.figures.sweeps import level_of
from analysis.statistics.verdicts import Ratio
from analysis.tests.claims.judging import verdicts_of
from analysis.tests.synthetic import turns_of, write
from analysis.tests.synthetic_noise import Noise
from analysis.tests.synthetic_points import EXPERIMENTS
from analysis.tests.synthetic_study import study, trace

UNCOUNTED = ["counters_hardware", "counters_simulated", "speed_against_error-unresolved"]
DRAWN = [entry for entry in FIGURES if entry.name not in UNCOUNTED]
WORDS = ("label", "known", "source", "measure")


def way_of(entry: Entry) -> str:
    """How a figure is drawn: its kind, and what that is told but words."""
    told = {key: key if key == "names" else value for key, value in entry.more.items() if key not in WORDS}
    return f"{entry.kind} {told}"


ONE_OF_EACH_WAY = list({way_of(entry): entry for entry in reversed(DRAWN)}.values())
WITHOUT_POINTS = ("phases", "counters", "timeline")
QUESTIONS = Path(__file__).parents[3] / "experiments" / "questions"


@pytest.mark.parametrize("entry", FIGURES, ids=lambda entry: entry.name)
def test_every_figure_is_drawn_with_labels_units_a_caption_and_points_that_tell(
    data: Evidence, entry: Entry
) -> None:
    with styled(entry.name):
        drawing = entry.draw(data)
    if entry.name in UNCOUNTED:
        assert drawing is None
        return
    assert drawing is not None
    axes = drawing.figure.axes
    labels = [label for one in axes for label in (one.get_xlabel(), one.get_ylabel(), one.get_title("left"))]
    assert any(re.search(r", [nm]?s$|%$|relative| per |radii$", label) for label in labels)
    assert re.search(r"\d", drawing.caption)
    assert "nan" not in drawing.caption.lower()
    points = [one for one in drawing.figure.findobj(Point) if isinstance(one, Point)]
    assert all(re.search(r"\d", " ".join(one.told)) for one in points)
    assert (not points) == (entry.kind in WITHOUT_POINTS)


def test_every_experiment_has_a_figure_and_every_kind_its_experiment() -> None:
    assert set(figures.titles()) == set(EXPERIMENTS)
    assert {entry.kind for entry in FIGURES} >= set(figures.OF_ONE_QUESTION)


def test_a_pair_has_the_names_of_the_series_of_its_question() -> None:
    paired = {entry.experiment: entry.more["names"] for entry in FIGURES if "names" in entry.more}
    assert {"control", "neighbourhood", "reverse", "compiler"} <= set(paired)
    for experiment, names in paired.items():
        question = tomllib.loads((QUESTIONS / f"{experiment}.toml").read_text(encoding="utf-8"))
        series = {str(one.get("name", one.get("variant"))) for one in question["series"]}
        assert set(names) <= series


def part(records: list[dict[str, Any]], kept: str) -> list[dict[str, Any]]:
    if kept == "one block":
        return [record for record in records if record["tags"]["block"] == 0]
    if kept == "one point":
        return [record for record in records if record["tags"]["point"] == records[0]["tags"]["point"]]
    if kept == "both ends":
        x = [float(record["tags"].get("x", 0)) for record in records]
        return [record for record, one in zip(records, x, strict=True) if one in (min(x), max(x))]
    return records[::2]


@pytest.mark.parametrize("entry", ONE_OF_EACH_WAY, ids=lambda entry: entry.name)
@pytest.mark.parametrize("kept", ["one point", "half", "one block", "both ends"])
def test_partial_data_are_drawn_or_left_out_but_never_fail(tmp_path: Path, entry: Entry, kept: str) -> None:
    write(tmp_path, part(study([entry.experiment], blocks=3, noise=Noise(), seed=3), kept))
    with styled(entry.name):
        drawing = entry.draw(evidence_of(tmp_path)[0])
        if drawing is not None:
            drawing.figure.draw_without_rendering()


def test_a_block_that_was_left_has_another_in_its_place(tmp_path: Path) -> None:
    records = study(["steps"], blocks=5)
    for record in records:
        record["tags"]["blocks_planned"] = 4
    left = [record for record in records if record["tags"]["block"] != 1 or record["tags"]["x"] < 100]
    assert len(left) < 50
    write(tmp_path, left)
    assert "artial" not in draw_all(tmp_path)[0].caption
    for path in tmp_path.glob("records/steps/b4/*.json"):
        path.unlink()
    missing = 50 - len(left)
    assert draw_all(tmp_path)[0].caption.endswith(f"Partial: {40 - missing} of 40 runs.")


def test_what_is_planned_is_what_the_runner_wrote_down_last(tmp_path: Path) -> None:
    """Records of a question of ten values, of which two were taken out."""
    records = [record for record in study(["steps"], blocks=4) if record["tags"]["x"] <= 160]
    write(tmp_path, records)
    assert draw_all(tmp_path)[0].caption.endswith("Partial: 32 of 40 runs.")
    points = sorted({record["tags"]["point"] for record in records})
    plan: dict[str, Any] = {"paper": {"steps": {"runs": 32, "points": points}}}
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    assert "artial" not in draw_all(tmp_path)[0].caption
    plan["paper"]["steps"]["runs"] = 39
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    assert draw_all(tmp_path)[0].caption.endswith("Partial: 32 of 39 runs.")
    for other in ({"paper": {"steps": {"runs": 32, "points": points[1:]}}}, {"paper": {"steps": 3}}, {}, 7):
        (tmp_path / "plan.json").write_text(json.dumps(other))
        assert draw_all(tmp_path)[0].caption.endswith("Partial: 32 of 40 runs."), (
            "it is not the plan of these"
        )


def test_a_timeline_calls_its_scene_as_the_phases_do(tmp_path: Path) -> None:
    write(tmp_path, study(["phases"], blocks=2))
    (tmp_path / "timelines").mkdir()
    for number, name in enumerate(("scene.in", "unknown.in")):
        text = json.dumps(trace(f"find_static, {name}, 2 threads", 3))
        (tmp_path / "timelines" / f"{number}.json").write_text(text)
    drawn = {one.entry.name: one.caption.replace("\u00a0", " ") for one in draw_all(tmp_path)}
    assert "(100 000 discs at area fraction 0.80, 2 threads)" in drawn["phases"]
    caption = drawn["timeline"]
    assert "find_static, 100 000 discs at area fraction 0.80, 2 threads: " in caption
    assert "find_static, unknown.in, 2 threads: " in caption


def test_a_figure_and_the_claim_about_it_tell_one_ratio(tmp_path: Path) -> None:
    """A burst in one turn of each second process: ratios of sums, or of processes, would be others."""
    for number, one in enumerate(study(["neighbourhood"], blocks=6)):
        for run in one["repetitions"]:
            run["steps_seconds"] = 1.0
        each = [0.1 + 0.01 * (number % 5) + 0.001 * turn for turn in range(8)]
        each[3] *= 1 + 20 * (number % 2)
        seconds = each * len(one["repetitions"])
        one["turns"] = turns_of(seconds, 8)
        write(tmp_path, [one])
    (drawn,) = draw_all(tmp_path, ["neighbourhood"])
    measured = str(verdicts_of(tmp_path).loc["four_boxes", "measured"])
    ratio = measured.removeprefix("four against nine: ").partition(" of time")[0]
    assert f"{ratio} against nine boxes" in drawn.caption


def test_svg_and_pdf_are_written_whole_and_the_same_again(tmp_path: Path) -> None:
    write(tmp_path, study(["neighbourhood"], blocks=3))
    (drawn,) = draw_all(tmp_path, ["neighbourhood"], pdf=True)
    assert [path.suffix for path in drawn.files] == [".svg", ".pdf"]
    svg, pdf = drawn.files
    assert ElementTree.parse(svg).getroot().tag.endswith("svg")
    assert pdf.read_bytes().startswith(b"%PDF")
    first = svg.read_bytes()
    draw_all(tmp_path, ["neighbourhood"])
    assert not pdf.exists(), "it would be outdated"
    assert svg.read_bytes() == first
    assert {path.name for path in (tmp_path / "figures").iterdir()} == {"neighbourhood.svg"}


def test_labels_are_moved_apart_as_little_as_needed() -> None:
    assert spread([0, 100, 200], 9) == [0, 100, 200]
    assert spread([50, 50], 10) == [45, 55]
    moved = spread([10, 12, 11, 40], 10)
    ordered = sorted(moved)
    assert all(upper - lower >= 10 - 1e-9 for lower, upper in pairwise(ordered))
    assert moved[3] == 40
    assert moved[0] < moved[2] < moved[1]


def test_labels_of_two_lines_do_not_cover_each_other() -> None:
    figure, (axes,) = new_figure(2)
    label_ends(axes, [("g++\nactive", 0.50, "black"), ("clang++\nactive", 0.51, "black")])
    figure.draw_without_rendering()
    lower, upper = (text.get_window_extent() for text in axes.texts)
    assert lower.y1 < upper.y0


@pytest.mark.parametrize(("xs", "level"), [([1, 2, 4, 8], 4), ([1, 2, 8], 1), ([4, 5], 4), ([0.1, 4], 0.1)])
def test_the_level_is_where_the_published_time_is_least_if_the_sweeps_are_alike(
    xs: list[float], level: float
) -> None:
    published_sweep = pd.DataFrame({"x": [1, 2, 4, 8], "seconds": [4.0, 3.0, 1.0, 2.0]})
    assert level_of(pd.DataFrame({"x": xs}), published_sweep) == level


def test_a_ratio_without_an_interval_does_not_stretch_the_axis() -> None:
    _, (axes,) = new_figure(2)
    known = Ratio(ratio=0.95, low=0.93, high=0.97, verdict="faster", blocks=9)
    ratio_panel(axes, known, Ratio(ratio=0.96, blocks=5), ("one", "other"))
    low, high = axes.get_xlim()
    assert -15 < low < -7
    assert high < 15
