import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from analysis.statistics.intervals import FEWEST, RANKS_FROM, centre, measure, rank_p_value
from analysis.statistics.looks import ERROR, share


def test_the_estimate_is_the_middle_of_the_averages_of_any_two() -> None:
    values = [0.0, 0.1, 0.2, 0.3, 0.4, 1.0]
    averages = [(one + other) / 2 for k, one in enumerate(values) for other in values[k:]]
    assert centre(values).estimate == pytest.approx(np.median(averages))


@given(st.integers(FEWEST, 30), st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_the_interval_holds_what_the_test_does_not_reject(count: int, seed: int) -> None:
    found = measure(np.random.default_rng(seed).normal(0, 1, count))
    interval = found.interval(0.95)
    assert interval.low <= interval.estimate <= interval.high
    assert found.p_value(interval.low - 1e-9, "greater") <= 0.025 + 1e-6
    assert found.p_value(interval.low + 1e-9, "greater") >= 0.025 - 1e-6
    assert found.p_value(interval.high + 1e-9, "less") <= 0.025 + 1e-6
    assert found.p_value(interval.high - 1e-9, "less") >= 0.025 - 1e-6


@pytest.mark.parametrize("count", [6, 9, 16])
def test_the_interval_of_independent_values_covers_the_truth_at_its_rate(count: int) -> None:
    generator = np.random.default_rng(count)
    rows = generator.normal(0.03, 0.02, (1000, count))
    covered = [0, 0]
    for row in rows:
        for number, independent in enumerate((True, False)):
            interval = centre(row, 0.95, independent=independent)
            covered[number] += interval.low <= 0.03 <= interval.high
    assert 930 <= covered[0] <= 980
    assert covered[1] >= 970, "nobody said that they are independent"


def test_one_burst_moves_neither_the_centre_nor_its_error_far() -> None:
    values = np.random.default_rng(5).normal(0, 0.005, 32)
    values[4] = 0.5
    assert abs(centre(values).estimate) < 0.005
    assert centre(values).high < 0.02


def test_fewer_blocks_than_the_first_look_bound_nothing() -> None:
    assert centre(np.linspace(0, 0.1, FEWEST - 1)).low == -np.inf
    assert measure([0.1]).p_value(0, "greater") == 1
    assert np.isnan(centre([]).estimate)


def test_an_interval_is_that_of_the_last_planned_look() -> None:
    values = np.random.default_rng(6).normal(0, 0.01, 13)
    assert centre(values) == centre(values[:9]) == measure(values[:9]).interval(1 - ERROR * share(9))
    assert centre(values, 0.95) != centre(values[:9], 0.95), "with a level of its own it is of all"


def test_exact_counts_have_an_interval_of_no_width() -> None:
    interval = centre([0.25, 0.25, 0.25])
    assert (interval.low, interval.high) == (0.25, 0.25)
    found = measure([0.25, 0.25, 0.25])
    assert found.p_value(0.02, "greater") == 0
    assert found.p_value(0.02, "less") == 1


def test_values_of_which_most_are_equal_have_an_error() -> None:
    assert measure([0.1] * 8 + [0.5]).error > 0


def test_the_ranks_are_those_of_scipy() -> None:
    values = np.random.default_rng(3).normal(0.2, 1, RANKS_FROM + 3)
    first, second = np.triu_indices(len(values))
    positive = ((values[first] + values[second]) > 0).sum()
    expected = stats.wilcoxon(values, alternative="greater", method="exact").pvalue
    assert rank_p_value(len(values), positive) == pytest.approx(expected)


def test_no_error_is_smaller_than_what_ranks_tell() -> None:
    values = np.r_[np.full(17, 0.8), np.zeros(3)] + np.random.default_rng(4).normal(0, 1e-4, 20)
    found = measure(values, independent=True)
    assert found.error < 0.01
    assert found.interval(0.95).low < 0.5
