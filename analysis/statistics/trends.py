"""Trends over a swept parameter: the growth exponent, linearity, and the point where a curve turns from
falling to rising. Each takes one row a process (as `records.tables.times` has them) of a single series with
its column `x`.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from analysis.statistics.breaks import break_point
from analysis.statistics.intervals import FEWEST, centre, measure
from analysis.statistics.looks import ERROR, last_look, seen
from analysis.statistics.pairs import block_curves, ratios_of
from analysis.statistics.simultaneous import Curves
from analysis.statistics.verdicts import MARGIN, judge_one, two_sided, verdict_row
from analysis.support.values import Floats, Interval

TOO_FEW_BLOCKS = "too few blocks"
LINEAR_WITHIN = (0.9, 1.1)
EXPONENTS = (0.3, 2.5, 441)


@dataclass(frozen=True)
class Growth:
    """How a time grows with x: its `exponent`, and the `change` from first to last (as of `judge_one`)."""

    exponent: Interval
    change: dict[str, Any]
    first: float
    last: float
    verdict: str
    p: float


@dataclass(frozen=True)
class Linearity:
    """The exponent of x over a fixed cost, from how many blocks, and whether that is a straight line."""

    exponent: Interval
    blocks: int
    verdict: str
    p: float


@dataclass(frozen=True)
class Minimum:
    """A fall to a break point and a rise from it; `fall` and `rise` are rows like those of `judge_one`, of
    the first and the last x against the lowest.
    """

    break_point: Interval
    lowest: float
    fall: dict[str, Any]
    rise: dict[str, Any]
    verdict: str
    p: float


def growth(processes: pd.DataFrame, margin: float = MARGIN) -> Growth:
    """Tell whether the time grows or falls with x, or is flat (the change over the whole range within the
    margin).

    The exponent is the slope of ln(time) on ln(x), fitted in each block, with the interval over the blocks;
    it must have the same sign as the change from the first to the last x, and exclude 0. `inconclusive`
    otherwise.
    """
    first, last = float(processes["x"].min()), float(processes["x"].max())
    change = judge_one(ratios_of(processes, "x", first, last)["log_ratio"], margin)
    exponents = seen(_block_exponents(processes))
    found = measure(exponents)
    p = {
        "grows": two_sided(found.p_value(0, "greater"), len(exponents)),
        "falls": two_sided(found.p_value(0, "less"), len(exponents)),
        "flat": 0.0,
    }
    said = {"slower": "grows", "faster": "falls", "equivalent": "flat"}.get(change["verdict"], "inconclusive")
    p_of_both = max(change["p"], p.get(said, 1.0))
    verdict = said if p_of_both <= ERROR else "inconclusive"
    return Growth(centre(exponents), change, first, last, verdict, p_of_both)


def linearity(processes: pd.DataFrame, within: tuple[float, float] = LINEAR_WITHIN) -> Linearity:
    """Tell whether the time is a straight line over x, with whatever fixed cost.

    Fits time = a + b x^exponent with the least relative error in each block (variable projection: a and b are
    linear, the exponent is searched on a fine grid); the interval is over the blocks. `linear` if it lies
    within the bounds, `not linear` if outside, else `inconclusive`, as from fewer than `FEWEST` blocks; NaN
    with fewer than four x.
    """
    curves = np.exp(block_curves(processes).dropna())
    x = curves.columns.to_numpy(dtype=float)
    if len(x) < 4 or len(curves) == 0:
        return Linearity(Interval(np.nan, -np.inf, np.inf), len(curves), "inconclusive", 1.0)
    exponents = seen(_offset_exponents(x / x.max(), curves.to_numpy()))
    found = measure(exponents)
    inside = max(found.p_value(within[0], "greater"), found.p_value(within[1], "less"))
    outside = min(found.p_value(within[0], "less"), found.p_value(within[1], "greater"))
    p = two_sided(min(inside, outside), len(exponents))
    verdict = "inconclusive" if p > ERROR else "linear" if inside < outside else "not linear"
    return Linearity(centre(exponents), len(exponents), verdict, p)


def minimum(processes: pd.DataFrame, margin: float = MARGIN) -> Minimum:
    """Tell whether the time falls to some x and rises from there.

    `falls then rises`: at some x inside the range the time is less than at both ends by more than the margin;
    `rises only`: it is more at the last x than at the first, and nowhere less than there; `falls only`: the
    other way round; `flat`: no two points differ; each by more than the margin (see `simultaneous`). At most
    one of these is true, and one that is not is said in at most 5 % of studies. What is not established is
    `inconclusive`, and anything from fewer than `FEWEST` whole blocks `too few blocks`.
    """
    table = block_curves(processes)
    whole, x = table.dropna(), table.columns.to_numpy(dtype=float)
    whole = whole.iloc[: last_look(len(whole))]
    rows = whole if len(whole) else table.median().to_frame().T
    curves = Curves(rows.to_numpy(dtype=float))
    verdict, p = curves.shape(np.log1p(margin)) if len(whole) >= FEWEST else (TOO_FEW_BLOCKS, 1.0)
    if len(whole) >= FEWEST and p > ERROR:
        verdict = "inconclusive"
    ends = (curves.interval_above_lowest(end) for end in (0, len(x) - 1))
    fall, rise = (verdict_row(end, len(whole), p, verdict) for end in ends)
    return Minimum(break_point(x, np.exp(whole.to_numpy())), float(x[curves.lowest]), fall, rise, verdict, p)


def _block_exponents(processes: pd.DataFrame) -> Floats:
    """Return the log-log slope of every block that has all x, at least two; none if an x is not positive.

    The slope of a part of the range is another one wherever the curve is not straight.
    """
    curves = block_curves(processes).dropna()
    x = curves.columns.to_numpy(dtype=float)
    if (x <= 0).any() or len(x) < 2 or curves.empty:
        return np.empty(0)
    slopes: Floats = np.polyfit(np.log(x), curves.to_numpy().T, 1)[0]
    return slopes


def _offset_exponents(x: Floats, curves: Floats) -> Floats:
    """Return for each curve (rows) the exponent of a + b x^exponent with the least relative error."""
    candidates = np.linspace(*EXPONENTS)
    weights = 1 / curves.mean(axis=0)
    weighted = (curves * weights).T
    errors = np.empty((len(candidates), len(curves)))
    for row, exponent in enumerate(candidates):
        design = np.column_stack([np.ones_like(x), x**exponent]) * weights[:, None]
        errors[row] = ((weighted - design @ (np.linalg.pinv(design) @ weighted)) ** 2).sum(axis=0)
    return candidates[errors.argmin(axis=0)]
