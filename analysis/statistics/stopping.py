"""What programs that are stopped now and then would take without a stop.

Coming back to caches that others have filled takes a program of large data longer than one of small data, the
more often the more. So blocks have slices of two lengths, and the ratio is taken to grow in proportion to the
number of stops: the line through both lengths is followed to none.
"""

import numpy as np

from analysis.statistics.location import location
from analysis.support.values import Floats

_LEAST = 2.0
"""So many times as many stops in blocks of short slices, or they tell too little of what a stop costs."""


def unstopped(log_ratios: Floats, stops: Floats) -> tuple[Floats, float]:
    """Return the log ratios less what the stops of their blocks cost, and the factor by which the error of
    their centre is greater because that cost was estimated from them; 1 where nothing can be told of it.

    The factor is that of the intercept of a straight line, of values that vary alike.
    """
    often = stops > np.sqrt(stops.min() * stops.max())
    if not often.any() or stops[often].mean() < _LEAST * stops[~often].mean():
        return log_ratios, 1.0
    between = float(stops[often].mean() - stops[~often].mean())
    cost = (location(log_ratios[often]) - location(log_ratios[~often])) / between
    share = often.mean()
    spread = share * (1 - share) * between**2
    return log_ratios - cost * stops, float(np.sqrt(1 + stops.mean() ** 2 / spread))
