"""Noise that is unkind to an interval, as studies x blocks of log ratios, and the rules that were used
before.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.signal import lfilter

Floats = NDArray[np.float64]
Rule = Callable[[Floats, float], tuple[float, float, float]]
"""Values and the error of a look -> the estimate and the ends of its interval."""


def dependent(generator: np.random.Generator, correlation: float, studies: int, blocks: int) -> Floats:
    """Return a first-order autoregression of standard deviation 1."""
    drawn = generator.standard_normal((studies, blocks + 100))
    values: Floats = lfilter([1], [1, -correlation], drawn, axis=1)[:, 100:] * np.sqrt(1 - correlation**2)
    return values


def two_speeds(generator: np.random.Generator, dwell: float, studies: int, blocks: int) -> Floats:
    """Return ratios that are three standard deviations higher while the machine is slow; it stays in one
    speed for `dwell` blocks on average. Their pseudo-median is 0.
    """
    changes = generator.random((studies, blocks)) < 1 / dwell
    slow = (np.cumsum(changes, axis=1) + generator.integers(0, 2, (studies, 1))) % 2
    values: Floats = generator.standard_normal((studies, blocks)) + 3 * slow - 1.5
    return values


def one_sided_bursts(generator: np.random.Generator, studies: int, blocks: int) -> Floats:
    """Return noise of 2 % with bursts of 50 % in a tenth of the candidate's blocks."""
    burst = generator.random((studies, blocks)) < 0.1
    values: Floats = generator.normal(0, 0.02, (studies, blocks)) + np.log(1.5) * burst
    return values


def student(values: Floats, error: float) -> tuple[float, float, float]:
    """Return the mean with Student's t interval: what was used for fewer than 14 blocks."""
    mean = float(values.mean())
    half = _quantile(error, len(values) - 1) * float(values.std(ddof=1)) / np.sqrt(len(values))
    return mean, mean - half, mean + half


def signed_ranks(values: Floats, error: float) -> tuple[float, float, float]:
    """Return the pseudo-median with the interval of exact signed ranks: what was used from 14 blocks on."""
    first, second = np.triu_indices(len(values))
    averages = np.sort((values[first] + values[second]) / 2)
    rank = _rank(len(values), error)
    return float(np.median(averages)), float(averages[rank - 1]), float(averages[-rank])


@lru_cache
def _rank(count: int, error: float) -> int:
    """Return which of the averages, from either end, ends the interval."""
    chance = np.ones(1)
    for rank in range(1, count + 1):
        chance = np.convolve(chance, np.r_[0.5, np.zeros(rank - 1), 0.5])
    return int((np.cumsum(chance) <= error / 2).sum())


@lru_cache
def _quantile(error: float, freedom: int) -> float:
    return float(stats.t.ppf(1 - error / 2, freedom))


def former(values: Floats, error: float) -> tuple[float, float, float]:
    """Return the interval of the former rule, which changed at 14 blocks what it estimates."""
    return (student if len(values) < 14 else signed_ranks)(values, error)


FORMER_LOOKS = (4, 6, 9, 14, 21, 32, 48)
FORMER_SHARE = 0.05 * 0.9 / len(FORMER_LOOKS)


def missed(rule: Rule, studies: Floats, truth: float = 0.0, looks: tuple[int, ...] = FORMER_LOOKS) -> float:
    """Return in which part of the studies any of the former looks' intervals misses the truth."""
    count = 0
    for values in studies:
        found = (rule(values[:look], FORMER_SHARE) for look in looks)
        count += any(not low <= truth <= high for _, low, high in found)
    return count / len(studies)
