"""Interval and test for the centre of paired differences: Student's t for few blocks, signed ranks for many.

The rule is by the number of blocks alone, never by the look of the data:

* fewer than `RANKS_FROM` blocks: the t interval, the only one of the two that can reach what the looks and
  Holm's correction leave of 5 %; its variance is moderated by that of other comparisons where a `Prior` is
  given;
* from `RANKS_FROM` blocks: the exact interval of the Wilcoxon signed-rank test around the Hodges-Lehmann
  estimate. The difference of two exchangeable processes is symmetric, which is all it assumes, and no
  single burst can move it far, so that nothing has to be dropped.

By default the level is that of the look at so many blocks (see `looks`).

Source: Hollander, Wolfe and Chicken, "Nonparametric Statistical Methods", 3rd edition, 2014, chapter 3.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from analysis.statistics.looks import ERROR, LOOKS, share
from analysis.statistics.moderation import NOTHING_KNOWN, Prior

Floats = NDArray[np.float64]

RANKS_FROM = 14
FEWEST = LOOKS[0]
"""Blocks below which nothing is decided: of two or three a single disturbed one makes any answer, and their
deviation is hardly known.
"""


_ROUNDING = 1e-12
"""Log ratios of equal counts are equal up to this."""


@dataclass(frozen=True)
class Interval:
    """An estimate with its interval; infinite ends where too few samples allow none."""

    estimate: float
    low: float
    high: float


def centre(differences: ArrayLike, level: float | None = None, prior: Prior = NOTHING_KNOWN) -> Interval:
    """Return the centre of the differences with its two-sided interval; NaN without any difference.

    Of fewer than `FEWEST` differences there is an interval only if a prior makes up for what is missing.
    """
    values = np.asarray(differences, dtype=float)
    if level is None:
        level = 1 - ERROR * share(len(values))
    if len(values) == 0:
        return Interval(np.nan, -np.inf, np.inf)
    if len(values) == 1:
        return Interval(float(values[0]), -np.inf, np.inf)
    if len(values) < RANKS_FROM:
        return _student(values, level, prior)
    return _signed_rank(values, level)


def p_value(
    differences: ArrayLike,
    bound: float,
    alternative: Literal["less", "greater"],
    prior: Prior = NOTHING_KNOWN,
) -> float:
    """Return the p-value of "the centre is not on the `alternative` side of `bound`", of one look alone; 1
    with fewer than two values.
    """
    values = np.asarray(differences, dtype=float) - bound
    if len(values) < 2:
        return 1.0
    if alternative == "less":
        values = -values
    if len(values) >= RANKS_FROM:
        statistic = int(np.floor(_positive_ranks(values)))
        return float(_null_distribution(len(values))[statistic:].sum())
    spread, freedom = _standard_error(values, prior)
    if spread == 0:
        return 0.0 if values.mean() > 0 else 1.0
    return float(stats.t.sf(values.mean() / spread, freedom))


def _student(values: Floats, level: float, prior: Prior) -> Interval:
    mean = float(values.mean())
    spread, freedom = _standard_error(values, prior)
    if spread > _ROUNDING and freedom < FEWEST - 1:
        return Interval(mean, -np.inf, np.inf)
    half = float(stats.t.ppf((1 + level) / 2, freedom)) * spread
    return Interval(mean, mean - half, mean + half)


def _standard_error(values: Floats, prior: Prior) -> tuple[float, float]:
    variance, freedom = prior.moderated(float(values.var(ddof=1)), len(values) - 1)
    return float(np.sqrt(variance / len(values))), freedom


def _signed_rank(values: Floats, level: float) -> Interval:
    walsh = _walsh_averages(values)
    below = np.cumsum(_null_distribution(len(values))) <= (1 - level) / 2
    rank = int(below.sum())
    return Interval(float(np.median(walsh)), float(walsh[rank - 1]), float(walsh[-rank]))


def _walsh_averages(values: Floats) -> Floats:
    first, second = np.triu_indices(len(values))
    averages: Floats = np.sort((values[first] + values[second]) / 2)
    return averages


def _positive_ranks(values: Floats) -> float:
    """Return the signed-rank statistic, the number of positive Walsh averages; a tie with zero counts
    half.
    """
    walsh = _walsh_averages(values)
    return float((walsh > 0).sum() + (walsh == 0).sum() / 2)


@lru_cache
def _null_distribution(count: int) -> Floats:
    """Return the probabilities of the signed-rank statistic 0 ... count (count + 1) / 2 under symmetry
    about 0.
    """
    probabilities = np.ones(1)
    for rank in range(1, count + 1):
        probabilities = np.convolve(probabilities, np.r_[0.5, np.zeros(rank - 1), 0.5])
    return probabilities
