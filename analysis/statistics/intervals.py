"""Interval and test for the centre of paired differences, one rule for any number of them.

What is estimated is the pseudo-median: the middle of the averages of any two blocks' log ratios. Where the
noise is symmetric it is the mean; a burst of noise on one side hardly moves it. Its estimate is Hodges and
Lehmann's; its standard error is the distance of two quantiles of those averages, which few bursts cannot
reach either, over what that distance is in standard errors; the ratio of the two has Student's t for its
distribution, nearly (Lehmann, Ann. Math. Stat. 34, 1963; Hettmansperger and McKean, "Robust Nonparametric
Statistical Methods", 2nd edition, 2011, sections 1.5 and 1.12). Successive values may depend on each other,
so that the error is widened (see `dependence`).

By chance all values near the quantiles can be alike, as on a machine of two speeds, and the error is then far
too small. So no interval is shorter than that of the exact signed ranks, from `RANKS_FROM` values on, which
asks for symmetry alone (Hollander, Wolfe and Chicken, "Nonparametric Statistical Methods", 3rd edition, 2014,
chapter 3). Of fewer values ranks tell too little, and the error is no smaller than their deviation tells.

By default an interval is that of the last planned look (see `looks`): of the values up to it.

How much less successive blocks tell than independent ones is `widening`.

A machine of two speeds, on which a memory-bound and a computing program differ by one factor in one speed and
by another in the other, makes a block's ratio like that of the block before. Of a first-order autocorrelation
of 0.6 an interval for independent values, looked at six times, misses the truth in 4 of 10 studies. No
interval of few values can know that they are independent: the autocorrelation of six values has a standard
error of nearly 1. So each comparison starts from a correlation that the machine may well have, and its own
blocks tell the more, the more there are of them.

The variance of the mean of a first-order autoregression, and how far the sample variance falls short of its
own, are those of Law and Kelton, "Simulation Modeling and Analysis", section 4.4; the bias of the estimated
autocorrelation is Kendall's (Biometrika 41, 1954).
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from analysis.statistics.looks import ERROR, LOOKS, seen, share
from analysis.support.values import Floats, Interval

FEWEST = LOOKS[0]
"""Blocks below which nothing is decided: of fewer a single disturbed one makes any answer, and their
deviation is hardly known.
"""

_QUANTILE = 1.28
"""Standard errors from the centre to the quantiles whose distance gives the error. Chosen by simulation: with
1.0 an interval of six normal values is too short, with 1.645 one burst among nine makes it useless."""

RANKS_FROM = 14
"""With so many values exact ranks can give the levels that looks and corrections ask for."""

_ROUNDING = 1e-12
"""Log ratios of equal counts are equal up to this."""


@dataclass(frozen=True)
class Centre:
    """A centre with its standard `error`, known to so many degrees of `freedom`, and the sorted `averages` of
    which exact ranks are made, none where there are too few.
    """

    estimate: float
    error: float
    freedom: int
    averages: Floats | None = None

    def interval(self, level: float) -> Interval:
        """Return the two-sided interval."""
        if np.isnan(self.error):
            return Interval(self.estimate, -np.inf, np.inf)
        half = float(special.stdtrit(self.freedom, (1 + level) / 2)) * self.error if self.error else 0.0
        low, high = self.estimate - half, self.estimate + half
        if self.averages is None:
            return Interval(self.estimate, low, high)
        rank = interval_rank(self.freedom + 1, (1 - level) / 2)
        ends = (self.averages[rank - 1], self.averages[-rank]) if rank else (-np.inf, np.inf)
        return Interval(self.estimate, min(low, float(ends[0])), max(high, float(ends[1])))

    def p_value(self, bound: float, alternative: Literal["less", "greater"]) -> float:
        """Return the p-value of "the centre is not on the `alternative` side of `bound`", of one look alone;
        1 where nothing is known of the error.
        """
        beyond = self.estimate - bound if alternative == "greater" else bound - self.estimate
        if np.isnan(self.error):
            return 1.0
        if self.error == 0:
            return 0.0 if beyond > 0 else 1.0
        p = float(special.stdtr(self.freedom, -beyond / self.error))
        if self.averages is None:
            return p
        side = self.averages > bound if alternative == "greater" else self.averages < bound
        positive = side.sum() + (self.averages == bound).sum() / 2
        return max(p, rank_p_value(self.freedom + 1, positive))


def measure(differences: ArrayLike, *, independent: bool = False, factor: float = 1.0) -> Centre:
    """Return the centre of all the differences, which are in the order of time; its error is NaN of fewer
    than `FEWEST`.

    `independent`: nothing can make one depend on the one before, as where each has a seed of its own.
    `factor`: by how much the error is greater, as something else was estimated from the same values.
    """
    values = np.asarray(differences, dtype=float)
    count = len(values)
    if count == 0:
        return Centre(np.nan, np.nan, 0)
    # The averages of any two of the values, each with itself too (Walsh averages).
    first, second = np.triu_indices(len(values))
    averages = np.sort((values[first] + values[second]) / 2)
    estimate = float(np.median(averages))
    if np.ptp(values) <= _ROUNDING and count > 1:
        return Centre(estimate, 0.0, count - 1)
    if count < FEWEST:
        return Centre(estimate, np.nan, count - 1)
    deviation = float(values.std(ddof=1) / np.sqrt(count))
    has_ranks = count >= RANKS_FROM
    error = _error(averages, count) if has_ranks else max(_error(averages, count), deviation)
    error = error or deviation
    error *= factor * (1.0 if independent else widening(values, estimate, error * np.sqrt(count)))
    return Centre(estimate, error, count - 1, averages if has_ranks else None)


def centre(differences: ArrayLike, level: float | None = None, *, independent: bool = False) -> Interval:
    """Return the centre of the differences with its two-sided interval; NaN without any difference.

    Without a `level` they are those up to the last planned look, at the level of that look.
    """
    values = np.asarray(differences, dtype=float)
    if level is None:
        values = seen(values)
        level = 1 - ERROR * share(len(values))
    return measure(values, independent=independent).interval(level)


def _error(averages: Floats, count: int) -> float:
    """Return the standard error of the median of the averages, by the signed ranks' normal approximation."""
    deviation = np.sqrt(count * (count + 1) * (2 * count + 1) / 24)
    rank = max(len(averages) / 2 - _QUANTILE * deviation - 0.5, 0.0)
    places = [rank, len(averages) - 1 - rank]
    low, high = np.interp(places, np.arange(len(averages)), averages)
    return float(high - low) / (2 * _QUANTILE)


ASSUMED, ASSUMED_BLOCKS = 0.35, 24
"""The autocorrelation that is assumed before any block is seen, as firmly as so many blocks would tell it.
Chosen by simulation: all planned looks together miss in no more than 5 % of studies at an autocorrelation of
0.3, with noise that is normal, skewed, with bursts, or of two speeds that last 2.5 blocks, and the intervals
of six blocks are the shortest. Blocks of one comparison that come a second apart depend less here."""

MOST = 0.9
"""Beyond this a study is one long moment, of which nothing can be said at all."""

_BURST = 3.0
"""Standard deviations at which a value is cut before it is correlated: a burst is independent of all else and
would hide how the others depend."""


def widening(values: Floats, centre: float, deviation: float) -> float:
    """Return the factor by which the standard error of the centre of independent values is multiplied.

    `values` are in the order of time, about their `centre`, with a robust standard deviation.
    """
    if deviation <= 0:
        return 1.0
    cut = np.clip(values, centre - _BURST * deviation, centre + _BURST * deviation)
    return _factor(autocorrelation(cut), len(cut))


def widening_of_independent(count: int, chance: float = 0.0) -> float:
    """Return the factor that so many independent values get; by `chance` their autocorrelation seems to be so
    many standard errors above 0.
    """
    return _factor(chance / np.sqrt(count), count)


def autocorrelation(values: Floats) -> float:
    """Return the first-order autocorrelation of the values, corrected for its bias; 0 of fewer than four."""
    centred, count = values - values.mean(), len(values)
    square = float((centred**2).sum())
    if count < 4 or square == 0:
        return 0.0
    return float(((centred[1:] * centred[:-1]).sum() / square + 1 / count) / (1 - 3 / count))


def _factor(seen: float, count: int) -> float:
    correlation = (count * seen + ASSUMED_BLOCKS * ASSUMED) / (count + ASSUMED_BLOCKS)
    lag = np.arange(1, count)
    correlations = float(np.clip(correlation, 0.0, MOST)) ** lag
    of_the_mean = 1 + 2 * float(((1 - lag / count) * correlations).sum())
    of_a_value = 1 - 2 * float(((count - lag) * correlations).sum()) / (count * (count - 1))
    return float(np.sqrt(of_the_mean / of_a_value))


def rank_p_value(count: int, positive: float) -> float:
    """Return the probability of at least so many positive averages of `count` values; halves are cut off."""
    return float(_at_least(count)[int(np.floor(positive))])


def interval_rank(count: int, tail: float) -> int:
    """Return which of the sorted averages, from either end, begins the interval that leaves out so much of
    the probability on either side; 0 if none does.
    """
    # The distribution is symmetric: at most r averages is as likely as at least all but r.
    return int((_at_least(count)[::-1] <= tail).sum())


@lru_cache(maxsize=64)
def _at_least(count: int) -> Floats:
    """Return the probability of at least 0, 1 ... count (count + 1) / 2, exactly: each rank is positive or
    negative with equal chances.
    """
    chances = np.zeros(count * (count + 1) // 2 + 1)
    chances[0] = 1.0
    for rank in range(1, count + 1):
        chances[rank:] = (chances[rank:] + chances[:-rank]) / 2
        chances[:rank] /= 2
    return np.minimum(np.cumsum(chances[::-1])[::-1], 1.0)
