"""The order in which an error falls with the time step."""

import numpy as np
from numpy.typing import ArrayLike

from analysis.statistics import quantiles
from analysis.support.values import Interval

FEWEST = 3
"""Points that a fitted order needs: two always lie on a line and tell nothing of its error."""


def order(step: ArrayLike, error: ArrayLike, ceiling: float) -> Interval:
    """Return p of error = c step^p, the slope of ln(error) on ln(step), with its 95 % interval.

    Only errors above 0 and below `ceiling` count, a rule fixed beforehand: above it the error is no longer
    small and cannot follow its leading term. The interval is Student's t from the scatter about the line. NaN
    with unbounded ends below `FEWEST` points.
    """
    dt, value = np.asarray(step, dtype=float), np.asarray(error, dtype=float)
    fitted = (value > 0) & (value < ceiling)
    if fitted.sum() < FEWEST or len(np.unique(dt[fitted])) < FEWEST:
        return Interval(np.nan, -np.inf, np.inf)
    x, y = np.log(dt[fitted]), np.log(value[fitted])
    slope, intercept = np.polyfit(x, y, 1)
    freedom = len(x) - 2
    scatter = np.sum((y - intercept - slope * x) ** 2) / freedom
    half = float(quantiles.student(0.975, freedom) * np.sqrt(scatter / np.sum((x - x.mean()) ** 2)))
    return Interval(float(slope), float(slope) - half, float(slope) + half)
