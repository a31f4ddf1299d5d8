"""Trends over a swept parameter: the growth exponent, linearity, and the point where a curve turns from
falling to rising. Each takes one row a process (see `pairs.process_medians`) of a single series with its
column `x`.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from analysis.statistics.intervals import Interval, centre
from analysis.statistics.pairs import PAIR, log_ratios
from analysis.statistics.verdicts import MARGIN, holm, judge_one

Floats = NDArray[np.float64]

REPLICATES = 1000
SEED = 20240229
LINEAR_WITHIN = (0.9, 1.1)
EXPONENTS = (0.3, 2.5, 441)


@dataclass(frozen=True)
class Growth:
    """How a time grows with x: `exponent` of x, `change` from the first x to the last (a row of
    `judge_one`).
    """

    exponent: Interval
    change: dict[str, Any]
    first: float
    last: float
    verdict: str


@dataclass(frozen=True)
class Linearity:
    """The exponent of x over a fixed cost, and whether that is a straight line."""

    exponent: Interval
    verdict: str


@dataclass(frozen=True)
class Minimum:
    """A fall to a break point and a rise from it; `fall` and `rise` are rows of `judge_one` against the
    lowest x.
    """

    break_point: Interval
    lowest: float
    fall: dict[str, Any]
    rise: dict[str, Any]
    verdict: str


def growth(processes: pd.DataFrame, margin: float = MARGIN) -> Growth:
    """Tell whether the time grows or falls with x, or is flat (the change over the whole range within the
    margin).

    The exponent is the slope of ln(time) on ln(x), fitted in each block, with the interval over the blocks;
    it must have the same sign as the change from the first to the last x, and exclude 0. `inconclusive`
    otherwise.
    """
    first, last = float(processes["x"].min()), float(processes["x"].max())
    change = judge_one(_ratio(processes, first, last), margin)
    exponent = centre(_block_exponents(processes))
    verdict = "inconclusive"
    if change["verdict"] == "slower" and exponent.low > 0:
        verdict = "grows"
    elif change["verdict"] == "faster" and exponent.high < 0:
        verdict = "falls"
    elif change["verdict"] == "equivalent":
        verdict = "flat"
    return Growth(exponent, change, first, last, verdict)


def linearity(processes: pd.DataFrame, within: tuple[float, float] = LINEAR_WITHIN) -> Linearity:
    """Tell whether the time is a straight line over x, with whatever fixed cost.

    Fits time = a + b x^exponent with the least relative error in each block (variable projection: a and b are
    linear, the exponent is searched on a fine grid); the interval is over the blocks. `linear` if it lies
    within the bounds, `not linear` if outside, else `inconclusive`; NaN with fewer than four x.
    """
    curves = processes.pivot_table(index=PAIR, columns="x", values="steps_seconds", aggfunc="median").dropna()
    x = curves.columns.to_numpy(dtype=float)
    if len(x) < 4 or len(curves) == 0:
        return Linearity(Interval(np.nan, -np.inf, np.inf), "inconclusive")
    exponent = centre(_offset_exponents(x / x.max(), curves.to_numpy()))
    verdict = "inconclusive"
    if within[0] <= exponent.low and exponent.high <= within[1]:
        verdict = "linear"
    elif exponent.high < within[0] or exponent.low > within[1]:
        verdict = "not linear"
    return Linearity(exponent, verdict)


def minimum(processes: pd.DataFrame, margin: float = MARGIN) -> Minimum:
    """Tell whether the time falls to some x and rises from there.

    The break point is that of a continuous line of two pieces through ln(time) over ln(x) (Muggeo, Stat.
    Med. 22, 2003), with the percentile interval of a bootstrap over blocks. The verdict rests on the lowest
    of the measured points: both the first and the last x must be slower than it (two rows, Holm-corrected).
    """
    curve = processes.groupby("x")["steps_seconds"].median()
    lowest = float(curve.idxmin())
    fall = judge_one(_ratio(processes, lowest, float(curve.index.min())), margin)
    rise = judge_one(_ratio(processes, lowest, float(curve.index.max())), margin)
    falls, rises = holm([fall["p"], rise["p"]])
    legs = [
        row["verdict"] if adjusted <= 0.05 else "inconclusive"
        for row, adjusted in ((fall, falls), (rise, rises))
    ]
    if lowest in (curve.index.min(), curve.index.max()):
        verdict = "rises only" if lowest == curve.index.min() else "falls only"
    elif legs == ["slower", "slower"]:
        verdict = "falls then rises"
    elif "inconclusive" in legs:
        verdict = "inconclusive"
    else:
        verdict = "falls only" if legs[0] == "slower" else "rises only" if legs[1] == "slower" else "flat"
    return Minimum(_break_point(processes), lowest, fall, rise, verdict)


def _ratio(processes: pd.DataFrame, reference: float, candidate: float) -> Floats:
    pairs = log_ratios(processes[processes["x"] == reference], processes[processes["x"] == candidate])
    ratios: Floats = pairs["log_ratio"].to_numpy()
    return ratios


def _block_exponents(processes: pd.DataFrame) -> list[float]:
    """Return the log-log slope of every block that has all x, at least two; none if an x is not positive.

    The slope of a part of the range is another one wherever the curve is not straight.
    """
    every = processes["x"].nunique()
    if (processes["x"] <= 0).any() or every < 2:
        return []
    return [
        float(stats.linregress(np.log(block["x"]), np.log(block["steps_seconds"])).slope)
        for _, block in processes.groupby(PAIR)
        if block["x"].nunique() == every
    ]


def _offset_exponents(x: Floats, curves: Floats) -> Floats:
    """Return for each curve (rows) the exponent of a + b x^exponent with the least relative error."""
    candidates = np.linspace(*EXPONENTS)
    weights = 1 / curves.mean(axis=0)
    weighted = (curves * weights).T
    errors = np.empty((len(candidates), len(curves)))
    for row, exponent in enumerate(candidates):
        design = np.column_stack([np.ones_like(x), x**exponent]) * weights[:, None]
        errors[row] = ((weighted - design @ (np.linalg.pinv(design) @ weighted)) ** 2).sum(axis=0)
    exponents: Floats = candidates[errors.argmin(axis=0)]
    return exponents


def _break_point(processes: pd.DataFrame) -> Interval:
    """Fit the break in the mean curve of the blocks and of bootstrap draws of them; needs four x and no
    gaps.
    """
    curves = processes.pivot_table(index=PAIR, columns="x", values="steps_seconds", aggfunc="median").dropna()
    x = curves.columns.to_numpy(dtype=float)
    if len(x) < 4 or len(curves) == 0 or x.min() <= 0:
        return Interval(np.nan, -np.inf, np.inf)
    generator = np.random.default_rng(SEED)
    logs = np.log(curves.to_numpy())
    drawn = generator.integers(len(logs), size=(REPLICATES, len(logs)))
    breaks = _best_breaks(np.log(x), logs[drawn].mean(axis=1))
    low, high = np.quantile(breaks, [0.025, 0.975]) if len(logs) > 1 else (-np.inf, np.inf)
    return Interval(float(_best_breaks(np.log(x), logs.mean(axis=0)[None])[0]), float(low), float(high))


def _best_breaks(x: Floats, curves: Floats) -> Floats:
    """Return for each curve the break, over a fine grid inside x, of the two-piece line with the least
    squares.
    """
    candidates = np.linspace(x[0], x[-1], 202)[1:-1]
    errors = np.empty((len(candidates), len(curves)))
    for row, candidate in enumerate(candidates):
        design = np.column_stack([np.ones_like(x), x, np.maximum(x - candidate, 0)])
        residuals = curves.T - design @ (np.linalg.pinv(design) @ curves.T)
        errors[row] = (residuals**2).sum(axis=0)
    breaks: Floats = np.exp(candidates[errors.argmin(axis=0)])
    return breaks
