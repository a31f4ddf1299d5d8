"""The break point of a curve that falls and rises."""

import numpy as np

from analysis.statistics.intervals import FEWEST, centre
from analysis.support.values import Floats, Interval

CANDIDATES = 202


def break_point(x: Floats, curves: Floats) -> Interval:
    """Return where the two lines through ln(time) over ln(x) meet, with its 95 % interval; NaN with fewer
    than four x.

    `curves` has a row a block. The line of two pieces (Muggeo, Stat. Med. 22, 2003) is fitted in each block,
    and the interval is over the blocks, within the range of x; fewer than `FEWEST` blocks give none.
    """
    if len(x) < 4 or len(curves) == 0 or x.min() <= 0:
        return Interval(np.nan, -np.inf, np.inf)
    found = centre(_breaks(np.log(x), np.log(curves)))
    if len(curves) < FEWEST:
        return Interval(float(np.exp(found.estimate)), -np.inf, np.inf)
    low, high = np.clip(np.exp([found.low, found.high]), x[0], x[-1])
    return Interval(float(np.exp(found.estimate)), float(low), float(high))


def _breaks(x: Floats, curves: Floats) -> Floats:
    """Return for each curve the break, on a fine grid inside x, of the two-piece line of least squares."""
    candidates = np.linspace(x[0], x[-1], CANDIDATES)[1:-1]
    designs = np.stack(
        [np.column_stack([np.ones_like(x), x, np.maximum(x - candidate, 0)]) for candidate in candidates]
    )
    fitted = designs @ (np.linalg.pinv(designs) @ curves.T)
    return candidates[((curves.T - fitted) ** 2).sum(axis=1).argmin(axis=0)]
