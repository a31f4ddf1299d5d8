"""The signed-rank statistic, the number of positive averages of two values each, where the centre is 0."""

from functools import lru_cache

import numpy as np

from analysis.support.values import Floats


def p_value(count: int, positive: float) -> float:
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
