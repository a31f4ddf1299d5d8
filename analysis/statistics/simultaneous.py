"""The differences between all points of a curve, with intervals that hold together."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from analysis.statistics.intervals import Interval
from analysis.statistics.looks import ERROR, share

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Differences:
    """The `means` of a curve's points over `blocks`, and the `error` of a mean, with `freedom` degrees."""

    means: Floats
    blocks: int
    error: float
    freedom: int

    def interval(self, one: int, other: int) -> Interval:
        """Return point `one` less point `other`; the intervals of all pairs, and of all looks, hold together
        in 95 % of studies.
        """
        difference = float(self.means[one] - self.means[other])
        if one == other:
            return Interval(0.0, 0.0, 0.0)
        if not self.freedom:
            return Interval(difference, -np.inf, np.inf)
        level = 1 - ERROR * share(self.blocks)
        half = _studentized_range(level, len(self.means), self.freedom) * self.error
        return Interval(difference, difference - half, difference + half)

    def p_value(self, slack: float) -> float:
        """Return the p-value of a statement about differences that could be off by `slack` and still be
        true, over all looks.
        """
        if not self.freedom or slack <= 0:
            return 1.0
        if self.error == 0:
            return 0.0
        p = stats.studentized_range.sf(slack / self.error, len(self.means), self.freedom)
        return float(p) / share(self.blocks)


def differences(curves: Floats) -> Differences:
    """Return the differences between the columns of a table of blocks x points.

    What a block suffers cancels, and the noise is pooled over the points: it is the residual of the two-way
    layout, with (blocks - 1) (points - 1) degrees of freedom. The intervals are Tukey's, of the studentized
    range, so that points may be picked by looking, as the least one is (Hsu, "Multiple Comparisons", 1996,
    chapter 5).
    """
    blocks, points = curves.shape
    means = curves.mean(axis=0)
    freedom = (blocks - 1) * (points - 1)
    residuals = curves - means - curves.mean(axis=1, keepdims=True) + curves.mean()
    error = float(np.sqrt((residuals**2).sum() / freedom / blocks)) if freedom else np.nan
    return Differences(means, blocks, error, freedom)


@lru_cache
def _studentized_range(level: float, points: int, freedom: int) -> float:
    return float(stats.studentized_range.ppf(level, points, freedom))
