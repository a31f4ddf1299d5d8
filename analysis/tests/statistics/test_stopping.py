"""Programs in slices of two lengths: the ratio that is told is that of programs which nobody stops."""

import numpy as np
import pytest

from analysis.statistics.looks import LOOKS
from analysis.statistics.turns import unstopped
from analysis.statistics.verdicts import judge_one
from analysis.support.values import Floats

STUDIES = 400


def stops_of(blocks: int) -> Floats:
    """A program of 0.2 s in slices of 10 ms, and of 2 ms in every third block."""
    return np.where(np.arange(blocks) % 3 == 1, 100.0, 20.0)


def test_what_each_stop_costs_is_taken_out() -> None:
    stops = stops_of(9)
    found, factor = unstopped(0.05 + 0.0004 * stops, stops)
    assert found == pytest.approx(np.full(9, 0.05))
    assert 1.5 < factor < 1.8, "of the intercept of a line through a third and two thirds of the values"


@pytest.mark.parametrize("stops", [np.full(9, 20.0), np.zeros(9), np.full(9, np.nan), np.linspace(20, 30, 9)])
def test_alike_stops_tell_nothing_of_what_one_costs(stops: Floats) -> None:
    values = np.linspace(0.0, 0.1, 9)
    found, factor = unstopped(values, stops)
    assert found.tolist() == values.tolist()
    assert factor == 1


def test_equal_programs_of_which_one_needs_its_caches_are_not_called_slower() -> None:
    random = np.random.default_rng(3)
    stops = stops_of(21)
    values = 0.0008 * stops + 0.003 * random.standard_normal(21)
    assert judge_one(values).verdict == "inconclusive", "from 1.6 % to 8 % by the length of the slices"
    row = judge_one(values, stops=stops)
    assert row.low < 1 < row.high
    assert row.verdict == "equivalent"


@pytest.mark.parametrize("noise", ["normal", "lognormal"])
def test_the_interval_of_all_looks_misses_as_seldom_as_it_says(noise: str) -> None:
    random = np.random.default_rng(11)

    def draw(size: int) -> Floats:
        values = random.standard_normal(size)
        return values if noise == "normal" else np.exp(0.7 * values)

    many = draw(20_000)
    centre = np.median((many + random.permutation(many)) / 2)
    stops, missed = stops_of(LOOKS[-1]), 0
    for _ in range(STUDIES):
        values = 0.02 * (draw(LOOKS[-1]) - centre) + 0.0004 * stops
        rows = [judge_one(values[:look], stops=stops[:look]) for look in LOOKS]
        missed += any(not row.low <= 1 <= row.high for row in rows)
    assert 0 < missed <= 0.055 * STUDIES
