"""How much less successive blocks tell than independent ones, and by what an interval is widened for it.

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

import numpy as np

from analysis.support.values import Floats

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
