"""Huber's location: a mean that bursts of noise hardly move."""

import numpy as np

from analysis.support.values import Floats

BEND = 1.5
"""Robust standard deviations beyond which a value counts no more than one at that distance."""

_OF_NORMAL = 1.4826
"""Standard deviations of a normal distribution in its median absolute deviation."""
_CLOSE, _MOST_STEPS = 1e-6, 50


def spread(values: Floats) -> float:
    """Return the robust standard deviation of the values, by the median distance from their median."""
    return _OF_NORMAL * float(np.median(np.abs(values - np.median(values))))


def location(values: Floats) -> float:
    """Return Huber's location of the values: their mean, but that one further from it than 1.5 robust
    standard deviations counts no more than one at that distance (Ann. Math. Stat. 35, 1964).
    """
    found = float(np.median(values))
    reach = BEND * spread(values)
    for _ in range(_MOST_STEPS if reach > 0 else 0):
        step = float(np.clip(values - found, -reach, reach).mean())
        found += step
        if abs(step) < _CLOSE * reach:
            break
    return found
