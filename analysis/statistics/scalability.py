"""Speed-ups over threads, and the universal scalability law fitted to their times."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.optimize import nnls

from analysis.statistics.intervals import FEWEST, centre
from analysis.statistics.pairs import PAIR, log_ratios, narrow
from analysis.statistics.verdicts import judge
from analysis.support.values import Floats, Interval
from analysis.support.wording import number


@dataclass(frozen=True)
class ScalabilityLaw:
    """Speed-up n / (1 + contention (n - 1) + coherency n (n - 1)) over `seconds`, fitted to `points`."""

    seconds: float
    contention: Interval
    coherency: Interval
    points: int

    def speed_up(self, threads: Floats) -> Floats:
        """Return the speed-up over one thread that the law gives."""
        contention, coherency = self.contention.estimate, self.coherency.estimate
        return threads / (1 + contention * (threads - 1) + coherency * threads * (threads - 1))


def speed_up(processes: pd.DataFrame) -> pd.DataFrame:
    """Return `x`, `speed_up`, `low`, `high` over the smallest thread count, from ratios within blocks."""
    reference = processes[processes["x"] == processes["x"].min()]
    table = judge(log_ratios(narrow(reference), narrow(processes, "x"), by=("x",)), ["x"])
    # Below, a time ratio becomes a speed-up: its ends change places. Its own reference has no interval.
    return pd.DataFrame(
        {"x": table["x"], "speed_up": 1 / table["ratio"], "low": 1 / table["high"], "high": 1 / table["low"]}
    ).replace([0, np.inf], np.nan)


def fit(processes: pd.DataFrame, most_threads: int) -> ScalabilityLaw | None:
    """Fit the law to the thread counts up to `most_threads`; None with fewer than four of them or no whole
    block.

    Takes one row a process with `x` = threads. The law says nothing of more threads than the machine runs
    at once. It is linear in its coefficients once multiplied out, n t(n) = t(1) (1 + contention (n - 1) +
    coherency n (n - 1)), and solved under its own condition that none is negative. The intervals are
    Student's t over the blocks, each fitted without that condition, which would press them against 0: where
    one lies below 0, the law does not hold. Fewer than `FEWEST` blocks give no interval. Source: Gunther,
    "Guerrilla Capacity Planning", 2007, chapters 4 to 6.
    """
    chosen = processes[processes["x"] <= most_threads]
    curves = chosen.pivot_table(index=PAIR, columns="x", values="steps_seconds", aggfunc="median").dropna()
    threads = curves.columns.to_numpy(dtype=float)
    if len(threads) < 4 or len(curves) == 0:
        return None
    blocks = curves.to_numpy()
    seconds, *estimates = _coefficients(threads, blocks.mean(axis=0))
    free = np.array([_coefficients(threads, curve, condition=False)[1:] for curve in blocks])
    contention, coherency = map(_interval, estimates, free.T)
    return ScalabilityLaw(seconds, contention, coherency, len(threads))


def _interval(estimate: float, each: Floats) -> Interval:
    if len(each) < FEWEST:
        return Interval(estimate, -np.inf, np.inf)
    found = centre(each)
    return Interval(estimate, min(found.low, estimate), max(found.high, estimate))


def _coefficients(threads: Floats, seconds: Floats, condition: bool = True) -> tuple[float, float, float]:
    """Return t(1), contention and coherency of the least relative error; by the condition none negative."""
    design = np.column_stack([np.ones_like(threads), threads - 1, threads * (threads - 1)])
    work = threads * seconds
    scaled, ones = design / work[:, None], np.ones_like(work)
    solution = nnls(scaled, ones)[0] if condition else np.linalg.lstsq(scaled, ones)[0]
    single, contention, coherency = (float(one) for one in solution)
    return single, contention / single, coherency / single


def doubt(speed_up: float, most: float) -> str:
    """Return a word of doubt on a speed-up above `most`, which the cores give; nothing else."""
    if not speed_up > most:
        return ""
    return (
        f"a speed-up of {number(speed_up)} is doubtful, the cores give {number(most)} at most: the caches "
        "of more cores hold more, or the machine was slower while one end was measured"
    )
