"""Trends over a swept parameter: the growth exponent, linearity, and the point where a curve turns from
falling to rising. Each takes one row a process (as `records.tables.times` has them) of a single series with
its column `x`; the order in which an error
falls with the time step.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, permutations
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy import special

from analysis.statistics.intervals import FEWEST, Centre, centre, measure
from analysis.statistics.looks import ERROR, last_look, seen, share
from analysis.statistics.pairs import block_curves, ratios_of
from analysis.statistics.verdicts import (
    EXPONENT,
    INCONCLUSIVE,
    MARGIN,
    Ratio,
    judge_one,
    ratio_of,
    two_sided,
    within_margin,
)
from analysis.support.values import Floats, Interval

Side = Literal["less", "greater"]
TOO_FEW_BLOCKS = "too few blocks"
LINEAR_WITHIN = (0.9, 1.1)
EXPONENTS = (0.3, 2.5, 441)


@dataclass(frozen=True)
class Growth:
    """How a time grows with x: its `exponent`, and the `change` from first to last with its verdict."""

    exponent: Interval
    change: Ratio
    first: float
    last: float


@dataclass(frozen=True)
class Minimum:
    """A fall to a break point and a rise from it: `fall` and `rise` are the first and the last x against the
    lowest, with the verdict on the shape.
    """

    break_point: Interval
    lowest: float
    fall: Ratio
    rise: Ratio


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
    said = {"slower": "grows", "faster": "falls", "equivalent": "flat"}.get(change.verdict, INCONCLUSIVE)
    p_of_both = max(change.p, p.get(said, 1.0))
    verdict = said if p_of_both <= ERROR else INCONCLUSIVE
    return Growth(centre(exponents), replace(change, verdict=verdict, p=p_of_both), first, last)


def linearity(processes: pd.DataFrame, within: tuple[float, float] = LINEAR_WITHIN) -> Ratio:
    """Return the exponent of x over a fixed cost, which is 1 for a straight line, and whether it is one.

    Fits time = a + b x^exponent with the least relative error in each block (variable projection: a and b are
    linear, the exponent is searched on a fine grid); the interval is over the blocks. `linear` if it lies
    within the bounds, `not linear` if outside, else `inconclusive`, as from fewer than `FEWEST` blocks; NaN
    with fewer than four x.
    """
    curves = np.exp(block_curves(processes).dropna())
    x = curves.columns.to_numpy(dtype=float)
    if len(x) < 4 or len(curves) == 0:
        return Ratio(what=EXPONENT, low=-np.inf, blocks=len(curves), within=within)
    exponents = seen(_offset_exponents(x / x.max(), curves.to_numpy()))
    found = measure(exponents)
    inside = max(found.p_value(within[0], "greater"), found.p_value(within[1], "less"))
    outside = min(found.p_value(within[0], "less"), found.p_value(within[1], "greater"))
    p = two_sided(min(inside, outside), len(exponents))
    verdict = INCONCLUSIVE if p > ERROR else "linear" if inside < outside else "not linear"
    ratio, low, high = centre(exponents)
    known = Ratio(what=EXPONENT, ratio=ratio, low=low, high=high, within=within)
    return replace(known, blocks=len(exponents), p=p, verdict=verdict)


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
        verdict = INCONCLUSIVE
    ends = (curves.interval_above_lowest(end) for end in (0, len(x) - 1))
    told = {"blocks": len(whole), "p": p, "verdict": verdict, "within": within_margin(margin)}
    fall, rise = (ratio_of(end, **told) for end in ends)
    return Minimum(break_point(x, np.exp(whole.to_numpy())), float(x[curves.lowest]), fall, rise)


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


MIRRORED: dict[Side, Side] = {"greater": "less", "less": "greater"}


@dataclass(frozen=True)
class Curves:
    """The logarithms of a curve's points, blocks x points, in the order of time, of a planned look.

    A difference of two points has the noise of those two points alone: an end may be several times as noisy
    as the rest, and what a block suffers cancels.
    """

    logs: Floats

    @cached_property
    def lowest(self) -> int:
        """The point of the least mean over the blocks."""
        return int(self.logs.mean(axis=0).argmin())

    @cached_property
    def _differences(self) -> dict[tuple[int, int], Centre]:
        pairs = combinations(range(self.logs.shape[1]), 2)
        return {(one, other): measure(self.logs[:, one] - self.logs[:, other]) for one, other in pairs}

    def interval_above_lowest(self, point: int) -> Interval:
        """Return how far a point lies above the lowest, which was found by looking: the intervals of an end
        against all others hold together, those of both ends, and of all looks, in 95 % of studies
        (Bonferroni).
        """
        level = 1 - ERROR * share(len(self.logs)) / max(1, 2 * (self.logs.shape[1] - 1))
        if point < self.lowest:
            return self._differences[point, self.lowest].interval(level)
        if point == self.lowest:
            return Interval(0.0, 0.0, 0.0)
        estimate, low, high = self._differences[self.lowest, point].interval(level)
        return Interval(-estimate, -high, -low)

    def shape(self, bound: float) -> tuple[str, float]:
        """Return the shape that is best supported, by differences of more than `bound`, and its p-value over
        all looks and shapes.

        *falls then rises*: some point inside lies below both ends; *rises only*: the last point lies above
        the first, and the first above none; *falls only*: the other way round; *flat*: no two points differ.
        At most one of these is true. What needs several differences at once has the greatest of their
        p-values (intersection-union: Berger, Technometrics 24, 1982), what needs any one of the points inside
        the least times their number.
        """
        points = range(self.logs.shape[1])
        last = len(points) - 1

        def p(one: int, other: int, side: Side) -> float:
            if one > other:
                return self._differences[other, one].p_value(-bound, MIRRORED[side])
            return self._differences[one, other].p_value(bound, side)

        def only_away_from(start: int, end: int) -> float:
            return max(p(end, start, "greater"), *(p(start, one, "less") for one in points if one != start))

        inside = [max(p(0, one, "greater"), p(last, one, "greater")) for one in points[1:-1]]
        found = {
            "falls then rises": len(inside) * min(inside, default=1.0),
            "rises only": only_away_from(0, last),
            "falls only": only_away_from(last, 0),
            "flat": max((p(*two, "less") for two in permutations(points, 2)), default=1.0),
        }
        best = min(found, key=lambda shape: found[shape])
        return best, len(found) * found[best] / share(len(self.logs))


CANDIDATES = 202


def break_point(x: Floats, curves: Floats) -> Interval:
    """Return where the two lines through ln(time) over ln(x) meet, with its 95 % interval; NaN with fewer
    than four x.

    `curves` has a row a block. The line of two pieces (Muggeo, Stat. Med. 22, 2003) is fitted in each block,
    and the interval is over the blocks, within the range of x; fewer than `FEWEST` blocks give none.
    """
    if len(x) < 4 or len(curves) == 0 or x.min() <= 0:
        return Interval(np.nan, -np.inf, np.inf)
    found = centre(_breaks(np.log(x), np.log(curves)))
    if len(curves) < FEWEST:
        return Interval(float(np.exp(found.estimate)), -np.inf, np.inf)
    low, high = np.clip(np.exp([found.low, found.high]), x[0], x[-1])
    return Interval(float(np.exp(found.estimate)), float(low), float(high))


def _breaks(x: Floats, curves: Floats) -> Floats:
    """Return for each curve the break, on a fine grid inside x, of the two-piece line of least squares."""
    candidates = np.linspace(x[0], x[-1], CANDIDATES)[1:-1]
    designs = np.stack(
        [np.column_stack([np.ones_like(x), x, np.maximum(x - candidate, 0)]) for candidate in candidates]
    )
    fitted = designs @ (np.linalg.pinv(designs) @ curves.T)
    return candidates[((curves.T - fitted) ** 2).sum(axis=1).argmin(axis=0)]


FEWEST_ERRORS = 3
"""Points that a fitted order needs: two always lie on a line and tell nothing of its error."""


def order(step: ArrayLike, error: ArrayLike, ceiling: float) -> Interval:
    """Return p of error = c step^p, the slope of ln(error) on ln(step), with its 95 % interval.

    Only errors above 0 and below `ceiling` count, a rule fixed beforehand: above it the error is no longer
    small and cannot follow its leading term. The interval is Student's t from the scatter about the line. NaN
    with unbounded ends below `FEWEST_ERRORS` points.
    """
    dt, value = np.asarray(step, dtype=float), np.asarray(error, dtype=float)
    fitted = (value > 0) & (value < ceiling)
    if fitted.sum() < FEWEST_ERRORS or len(np.unique(dt[fitted])) < FEWEST_ERRORS:
        return Interval(np.nan, -np.inf, np.inf)
    x, y = np.log(dt[fitted]), np.log(value[fitted])
    slope, intercept = np.polyfit(x, y, 1)
    freedom = len(x) - 2
    scatter = np.sum((y - intercept - slope * x) ** 2) / freedom
    half = float(special.stdtrit(freedom, 0.975) * np.sqrt(scatter / np.sum((x - x.mean()) ** 2)))
    return Interval(float(slope), float(slope) - half, float(slope) + half)
