"""Noise that is unkind to an interval, as studies x blocks of log ratios."""

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

Floats = NDArray[np.float64]


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
