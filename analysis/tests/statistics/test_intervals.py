import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from analysis.statistics.intervals import RANKS_FROM, centre, p_value
from analysis.statistics.looks import ERROR, share
from analysis.statistics.moderation import Prior


def test_few_blocks_use_the_t_interval_of_scipy() -> None:
    values = np.array([0.01, 0.03, -0.02, 0.05, 0.02])
    interval = centre(values)
    expected = stats.ttest_1samp(values, 0).confidence_interval(1 - ERROR * share(5))
    assert interval.low == pytest.approx(expected.low)
    assert interval.high == pytest.approx(expected.high)
    assert p_value(values, 0.01, "greater") == pytest.approx(
        stats.ttest_1samp(values, 0.01, alternative="greater").pvalue
    )


def test_many_blocks_use_the_exact_signed_ranks_of_scipy() -> None:
    values = np.random.default_rng(3).normal(0.01, 0.02, RANKS_FROM + 3)
    for alternative in ("less", "greater"):
        expected = stats.wilcoxon(values - 0.005, alternative=alternative, method="exact").pvalue
        assert p_value(values, 0.005, alternative) == pytest.approx(expected)


@given(st.integers(RANKS_FROM, 30), st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_the_rank_interval_holds_what_the_rank_test_does_not_reject(count: int, seed: int) -> None:
    values = np.random.default_rng(seed).normal(0, 1, count)
    interval = centre(values, 0.95)
    assert interval.low <= interval.estimate <= interval.high
    assert p_value(values, interval.low - 1e-9, "greater") <= 0.025
    assert p_value(values, interval.low + 1e-9, "greater") > 0.025
    assert p_value(values, interval.high + 1e-9, "less") <= 0.025
    assert p_value(values, interval.high - 1e-9, "less") > 0.025


@pytest.mark.parametrize("count", [5, 7, 16])
def test_the_interval_covers_the_truth_at_its_rate(count: int) -> None:
    generator = np.random.default_rng(count)
    intervals = [centre(generator.normal(0.03, 0.02, count), 0.95) for _ in range(1000)]
    covered = sum(interval.low <= 0.03 <= interval.high for interval in intervals)
    assert 930 <= covered <= 975


def test_one_burst_does_not_move_the_centre_of_many_blocks() -> None:
    values = np.random.default_rng(5).normal(0, 0.005, 16)
    values[4] = 0.5
    assert abs(centre(values).estimate) < 0.005
    assert centre(values).high < 0.01


def test_a_single_block_bounds_nothing() -> None:
    assert centre([0.1]).low == -np.inf
    assert p_value([0.1], 0, "greater") == 1
    assert np.isnan(centre([]).estimate)


def test_two_blocks_bound_nothing_unless_others_tell_their_noise() -> None:
    assert centre([0.1, 0.2]).high == np.inf
    assert 0.25 < centre([0.1, 0.2], prior=Prior(8, 0.05**2)).high < 0.35


def test_exact_counts_have_an_interval_of_no_width() -> None:
    interval = centre([0.25, 0.25, 0.25])
    assert (interval.low, interval.high) == (0.25, 0.25)
    assert p_value([0.25, 0.25, 0.25], 0.02, "greater") == 0
    assert p_value([0.25, 0.25, 0.25], 0.02, "less") == 1
