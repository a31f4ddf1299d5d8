"""How often a verdict errs where noise is unkind, in the worst comparison of a study. Seeds are fixed."""

import numpy as np
import pytest

from analysis.statistics.intervals import autocorrelation, centre, widening, widening_of_independent
from analysis.statistics.looks import ERROR, LOOKS, seen
from analysis.statistics.trends import Curves
from analysis.statistics.verdicts import MARGIN, holm, judge_one
from analysis.tests.statistics.unkind_noise import Floats, dependent, one_sided_bursts, two_speeds

STUDIES = 500
LAST = LOOKS[-1]
CHANCE = 0.017
"""1.7 standard errors of 5 % of so many studies."""


def missed_now(studies: Floats, truth: float = 0.0) -> float:
    """Return in which part of the studies the interval of any look misses the truth."""
    count = 0
    for values in studies:
        found = (centre(values[:look]) for look in LOOKS)
        count += any(not one.low <= truth <= one.high for one in found)
    return count / len(studies)


@pytest.mark.parametrize("correlation", [0.0, 0.2, 0.4, 0.6])
def test_blocks_that_depend_on_each_other(correlation: float) -> None:
    """The promise is for up to 0.3; beyond, it errs more often, as the page of the method says."""
    values = dependent(np.random.default_rng(1), correlation, STUDIES, LAST)
    assert missed_now(values) <= {0.4: 0.075, 0.6: 0.15}.get(correlation, ERROR)


@pytest.mark.parametrize("noise", ["dependent", "two speeds", "lognormal", "exponential"])
def test_an_interval_is_as_wide_as_its_promise_at_the_corners_of_its_class(noise: str) -> None:
    """Neither wrong more often than in 5 % of studies, nor so wide that time is thrown away."""
    generator, truth = np.random.default_rng(21), 0.0
    if noise == "dependent":
        values = dependent(generator, 0.3, 1500, LAST)
    elif noise == "two speeds":
        values = two_speeds(generator, 2.5, 1500, LAST)
    else:
        draw = getattr(generator, noise)
        values, long = draw(size=(1500, LAST)), draw(size=400_000)
        truth = float(np.median((long + np.roll(long, 1)) / 2))
    assert 0.02 <= missed_now(values, truth) <= ERROR


def test_a_machine_that_stays_in_one_of_two_speeds_for_a_moment() -> None:
    """Of a stay of five blocks the first looks may see one speed alone: nothing in the values can tell. That
    is why a study spreads the blocks of a comparison over its time.
    """
    brief, long = (two_speeds(np.random.default_rng(2), dwell, STUDIES, LAST) for dwell in (2.5, 5))
    assert missed_now(brief) <= ERROR + CHANCE
    assert missed_now(long) < 0.22


def test_one_estimand_for_any_number_of_blocks() -> None:
    bursts = one_sided_bursts(np.random.default_rng(4), 200, LAST)
    now = {look: np.median([centre(row[:look]).estimate for row in bursts]) for look in LOOKS}
    assert max(now.values()) - min(now.values()) < 0.006


def test_bursts_on_one_side_are_not_missed_and_leave_something_to_decide() -> None:
    bursts = one_sided_bursts(np.random.default_rng(5), STUDIES, LAST)
    long = one_sided_bursts(np.random.default_rng(6), 1, 4000)[0]
    truth = float(np.median((long + np.roll(long, 1)) / 2))
    assert missed_now(bursts, truth) <= ERROR
    widths = [centre(row).high - centre(row).low for row in bursts]
    assert np.median(widths) < 0.5 * np.median(4 * bursts.std(axis=1) / np.sqrt(LAST)), "of a mean"


@pytest.mark.parametrize("slow", [0.3, 0.5])
def test_a_table_of_equals_on_a_machine_of_two_speeds(slow: float) -> None:
    """Nineteen equals against one, anew in each block: the correction needs small p-values that hold."""
    generator = np.random.default_rng(12)
    wrong = 0
    for _ in range(20):
        logs = np.log(2.3) * (generator.random((20, LAST)) < slow) + generator.normal(0, 0.007, (20, LAST))
        rows = [[judge_one(one[:look] - logs[0, :look]) for one in logs[1:]] for look in LOOKS]
        wrong += any(
            corrected <= ERROR and row.verdict in ("faster", "slower")
            for table in rows
            for row, corrected in zip(table, holm([row.p for row in table]), strict=True)
        )
    assert wrong <= 1


def test_a_resumed_study_decides_as_one_that_was_not_stopped() -> None:
    values = 0.03 + 0.01 * np.random.default_rng(9).standard_normal(30)
    assert judge_one(values) == judge_one(values[:21])
    assert list(seen(values)) == list(values[:21])


@pytest.mark.parametrize("times", [3, 5])
def test_an_end_of_a_curve_noisier_than_its_other_points(times: float) -> None:
    """A curve of eight points, whose last one is noisier and a margin above the others, which is no rise."""
    curves = np.random.default_rng(10).normal(0, 0.02, (150, LOOKS[1], 8)) * np.r_[np.ones(7), times]
    curves[:, :, 7] += np.log1p(MARGIN)
    shapes = ([Curves(curve[:look]).shape(np.log1p(MARGIN)) for look in LOOKS[:2]] for curve in curves)
    said = sum(any(p <= ERROR and shape != "flat" for shape, p in found) for found in shapes)
    assert said <= ERROR * len(curves)


def test_the_autocorrelation_is_found_and_a_burst_does_not_hide_it() -> None:
    values = dependent(np.random.default_rng(11), 0.5, 400, LAST)
    assert np.mean([autocorrelation(row) for row in values]) == pytest.approx(0.5, abs=0.03)
    burst = values.copy()
    burst[:, 20] += 50
    disturbed, found = (np.mean([widening(row, 0, 1) for row in rows]) for rows in (burst, values))
    assert disturbed > 0.75 * found
    assert np.mean([autocorrelation(row) for row in burst]) < 0.1, "uncut"


def test_independent_blocks_are_widened_less_the_more_there_are() -> None:
    factors = [widening_of_independent(look) for look in LOOKS]
    assert factors == sorted(factors, reverse=True)
    assert 1.05 < factors[-1] < 1.2
    assert widening(np.ones(10), 1.0, 0.0) == 1
