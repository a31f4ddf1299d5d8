"""Experiments that this package has never heard of: drawn and reported by the tags of their records."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.derived.comparisons import differences
from analysis.figures import KINDS, OF_ERRORS, Drawn, draw_all
from analysis.records.reading import load
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import figure_of, study, under
from support.vocabulary import PAUSES

LIKE = [
    "threads", "radius", "row", "neighbourhood", "sequential_orders", "control", "schedule_find", "machine",
    "phases", "ladder", "limits", "ways",
]  # fmt: skip
"""Experiments of every kind, whose records name it."""

NAMING = ("ladder", "limits", "ways")
"""The kinds that name the published variant, which is a series of their synthetic records."""


def unknown(known: str, name: str = "small_chunks", **tags: str) -> list[dict[str, Any]]:
    return under(name, study([known], blocks=6, noise=QUIET, seed=2), **tags)


def drawn_of(folder: Path, records: list[dict[str, Any]]) -> Drawn:
    write(folder, records)
    (drawn,) = draw_all(folder, [records[0]["tags"]["experiment"]])
    return drawn


def test_every_kind_is_tried() -> None:
    # That of pauses needs labels which no other kind has, those of errors have several figures: their tests
    # in `derived` draw them.
    assert set(map(figure_of, LIKE)) == set(KINDS) - {PAUSES, *OF_ERRORS}


@pytest.mark.parametrize("known", LIKE)
def test_every_kind_is_drawn_without_a_published_series(tmp_path: Path, known: str) -> None:
    drawn = drawn_of(tmp_path, unknown(known))
    assert drawn.entry.title == "small_chunks"
    assert [path.name for path in drawn.files] == ["small_chunks.svg"]
    assert drawn.caption.lower().startswith("small_chunks")
    assert "nan" not in drawn.caption
    if known not in NAMING:
        assert "ublished" not in drawn.caption
        assert "<!-- published" not in drawn.files[0].read_text(encoding="utf-8")


def test_a_trend_has_a_curve_and_a_sentence_a_series(tmp_path: Path) -> None:
    drawn = drawn_of(tmp_path, unknown("row"))
    assert "checkered: The time grows" in drawn.caption
    assert "row: The time grows" in drawn.caption


@pytest.mark.parametrize(("tag", "names"), [("series", ("one", "other")), ("scene_name", ("small", "large"))])
def test_scaling_draws_a_curve_a_series_and_scene(tmp_path: Path, tag: str, names: tuple[str, str]) -> None:
    records = []
    for name in names:
        for record in unknown("threads", **{tag: name}):
            records.append(record | {"tags": record["tags"] | {"point": f"{record['tags']['point']}-{name}"}})
    caption = drawn_of(tmp_path, records).caption
    assert all(f"Greatest speed-up of {name}" in caption for name in names)
    assert "scalability" not in caption


def test_a_name_that_is_a_file_of_another_figure_takes_nothing_away(tmp_path: Path) -> None:
    write(tmp_path, study(["phases"], blocks=2))
    drawn = drawn_of(tmp_path, unknown("radius", name="counters_software"))
    assert drawn.files[0].name == "experiment-counters_software.svg"
    assert drawn_of(tmp_path, unknown("radius", name="a b")).files[0].name == "a_b.svg"


def test_differences_are_those_within_the_same_x(tmp_path: Path) -> None:
    write(tmp_path, unknown("row", figure="comparison"))
    table = differences(load(tmp_path).times, "checkered").set_index("x")
    for x, row in table.iterrows():
        assert row["series"] == "row"
        assert row["ratio"] == pytest.approx(1.1 - 0.08 * np.log10(float(str(x)) / 1000), rel=0.01)
    assert table.loc[1_000, "verdict"] == "slower"
    assert table.loc[200_000, "verdict"] == "faster"
