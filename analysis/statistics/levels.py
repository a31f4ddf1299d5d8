"""Whether a machine has two speeds, or one that shifts: noise that no count of bursts shows."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analysis.statistics import quantiles
from analysis.support.values import Floats

FEWEST_TIMES = 8
FACTOR = 1.25
EXPLAINED = 0.94
"""The share of the variance of ln(time) between the two groups: 0.64 for a normal distribution cut at its
middle, more for few times by chance; this is exceeded in about 1 normal sample in 100."""


@dataclass(frozen=True)
class Levels:
    """Two levels of a time: the slower is `factor` times the faster, and has `slow` of `times` values; the
    machine changed between them `changes` times.
    """

    factor: float
    slow: int
    times: int
    changes: int


def levels(times: ArrayLike) -> Levels | None:
    """Return the two levels of times of the same thing, given in the order in which they were measured; None
    if it is not clear that they are two.

    The times are parted where the two groups differ most (Otsu, IEEE Trans. Syst. Man Cybern. 9, 1979). They
    are two levels if that explains at least `EXPLAINED` of the variance, each has two times or more, and the
    levels are a factor of `FACTOR` apart.
    """
    logs = np.log(np.asarray(times, dtype=float))
    if len(logs) < FEWEST_TIMES or np.ptp(logs) == 0:
        return None
    ordered = np.sort(logs)
    sizes = np.arange(2, len(logs) - 1)
    gaps = np.array([ordered[size:].mean() - ordered[:size].mean() for size in sizes])
    between = gaps**2 * sizes * (len(logs) - sizes) / len(logs) ** 2
    best = int(between.argmax())
    if between[best] < EXPLAINED * logs.var() or gaps[best] < np.log(FACTOR):
        return None
    slow = logs > (ordered[sizes[best] - 1] + ordered[sizes[best]]) / 2
    changes = int((slow[1:] != slow[:-1]).sum())
    return Levels(float(np.exp(gaps[best])), int(slow.sum()), len(logs), changes)


def shifting(times: ArrayLike) -> bool:
    """Tell whether times of the same thing, in the order in which they were measured, are of a speed that
    shifts: a factor of `FACTOR` apart, and neighbours more alike than chance would have it.

    That is von Neumann's ratio, of the mean square of successive differences to the variance, at 1 %, of
    ranks, so that bursts hardly count (Bartels, J. Am. Stat. Assoc. 77, 1982).
    """
    values = np.asarray(times, dtype=float)
    count = len(values)
    if count < FEWEST_TIMES or np.quantile(values, 0.9) < FACTOR * np.quantile(values, 0.1):
        return False
    ranks = pd.Series(values).rank().to_numpy()
    ratio = (np.diff(ranks) ** 2).mean() / ranks.var()
    deviation = np.sqrt(4 * (count - 2) / (count**2 - 1))
    return bool(ratio < 2 + quantiles.normal(0.01) * deviation)


def in_order(processes: pd.DataFrame) -> Floats:
    """Return the times of processes in the order in which they were measured."""
    ordered = processes.sort_values(["recorded_at", "block", "position"], kind="stable")
    return ordered["steps_seconds"].to_numpy(dtype=float)
