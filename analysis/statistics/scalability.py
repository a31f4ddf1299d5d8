"""The universal scalability law, fitted to times over threads."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.optimize import nnls

from analysis.statistics.intervals import Interval
from analysis.statistics.pairs import PAIR

Floats = NDArray[np.float64]

REPLICATES = 1000
SEED = 20240229


@dataclass(frozen=True)
class ScalabilityLaw:
    """Speed-up n / (1 + contention (n - 1) + coherency n (n - 1)) over `seconds` on one thread, fitted to
    `points`.
    """

    seconds: float
    contention: Interval
    coherency: Interval
    points: int

    def speed_up(self, threads: Floats) -> Floats:
        """Return the speed-up over one thread that the law gives."""
        slowdown = (
            1 + self.contention.estimate * (threads - 1) + self.coherency.estimate * threads * (threads - 1)
        )
        return threads / slowdown


def fit(processes: pd.DataFrame, most_threads: int) -> ScalabilityLaw | None:
    """Fit the law to the thread counts up to `most_threads`; None with fewer than four of them or no whole
    block.

    Takes one row a process with `x` = threads. The law says nothing of more threads than the machine runs
    at once. It is linear in its coefficients once multiplied out, n t(n) = t(1) (1 + contention (n - 1) +
    coherency n (n - 1)), and solved under its own condition that none is negative; the intervals are
    percentiles over bootstrap draws of the blocks. Source: Gunther, "Guerrilla Capacity Planning", 2007,
    chapters 4 to 6.
    """
    chosen = processes[processes["x"] <= most_threads]
    curves = chosen.pivot_table(index=PAIR, columns="x", values="steps_seconds", aggfunc="median").dropna()
    threads = curves.columns.to_numpy(dtype=float)
    if len(threads) < 4 or len(curves) == 0:
        return None
    generator = np.random.default_rng(SEED)
    blocks = curves.to_numpy()
    drawn = blocks[generator.integers(len(blocks), size=(REPLICATES, len(blocks)))].mean(axis=1)
    seconds, contention, coherency = _coefficients(threads, blocks.mean(axis=0))
    replicates = np.array([_coefficients(threads, curve) for curve in drawn])
    low, high = np.quantile(replicates, [0.025, 0.975], axis=0)
    return ScalabilityLaw(
        seconds=seconds,
        contention=Interval(contention, float(low[1]), float(high[1])),
        coherency=Interval(coherency, float(low[2]), float(high[2])),
        points=len(threads),
    )


def _coefficients(threads: Floats, seconds: Floats) -> tuple[float, float, float]:
    """Return t(1), contention and coherency that fit with the least relative error."""
    design = np.column_stack([np.ones_like(threads), threads - 1, threads * (threads - 1)])
    work = threads * seconds
    (single, contention, coherency), _ = nnls(design / work[:, None], np.ones_like(work))
    return float(single), float(contention / single), float(coherency / single)
