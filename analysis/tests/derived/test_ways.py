"""Ratios by turns beside those of separate processes."""

from pathlib import Path

import numpy as np
import pytest

from analysis.derived.ways import APART, TURNS, comparisons, overall
from analysis.figures import draw_all
from analysis.figures.comparisons import bias_sentence
from analysis.records.reading import load
from analysis.records.studies import Study, split
from analysis.tests.synthetic import turns_of, write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_points import TRUE_BIAS
from analysis.tests.synthetic_study import study


def measured(folder: Path, *names: str, blocks: int = 12) -> Study:
    write(folder, study(names, blocks=blocks, noise=QUIET, seed=3))
    return split(load(folder))[0]


def test_both_ways_are_paired_within_blocks(tmp_path: Path) -> None:
    large, small = comparisons(measured(tmp_path, "ways"), "ways")
    assert (large.name, small.name) == ("large: nine / published", "small: row / published")
    assert large.log_ratio(APART).estimate == pytest.approx(np.log(1.1), abs=0.01)
    assert large.log_ratio(TURNS).estimate == pytest.approx(np.log(1.1 * (1 + TRUE_BIAS)), abs=0.01)
    for one in (large.bias, small.bias, overall([large, small])):
        assert one.low < np.log1p(TRUE_BIAS) < one.high
    assert overall([large, small]).low > 0, "a bias of one per cent is seen in twelve quiet blocks"
    assert large.seconds[APART] == pytest.approx(2.14, rel=0.05)


def test_intervals_narrow_with_the_time_spent(tmp_path: Path) -> None:
    table = comparisons(measured(tmp_path, "ways"), "ways")[0].half_widths(TURNS)
    assert list(table["seconds"] / table["seconds"].iloc[0]) == pytest.approx([n / 6 for n in range(6, 13)])
    assert table["half"].iloc[-1] < table["half"].iloc[0]


def test_three_blocks_say_nothing(tmp_path: Path) -> None:
    few = measured(tmp_path, "ways", blocks=3)
    assert comparisons(few, "ways") == []
    assert bias_sentence(few) == ""


def test_the_bias_stands_beside_tables_of_what_took_turns_alone(tmp_path: Path) -> None:
    records = study(["ways", "neighbourhood", "self_contained_checkered"], blocks=6, noise=QUIET, seed=4)
    for record in records:
        if record["tags"]["experiment"] == "neighbourhood":
            seconds = [one["steps_seconds"] for one in record["repetitions"]]
            record["turns"] = turns_of(seconds, len(seconds))
    write(tmp_path, records)
    captions = {one.entry.experiment: one.caption for one in draw_all(tmp_path)}
    assert "2 ratios by turns came out +" in captions["neighbourhood"]
    assert "Measured by turns" not in captions["self_contained_checkered"]
