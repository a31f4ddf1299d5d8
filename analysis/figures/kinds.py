"""The kinds of which figures are made: forests, and curves with or without ratios below them. What a point
tells stands in the same rows as what is drawn of it.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.labels import logarithmic_ticks, name_rows, note, percent_ticks
from analysis.figures.style import BAND, FAINT, INK, Look, lighten, point
from analysis.statistics.verdicts import MARGIN
from analysis.support.wording import change, exact, interval_of, number

PLAIN = Look(INK)
FAR = 1.6
"""Times the least ratio from which the greatest is shown as a factor, not in per cent."""


@dataclass(frozen=True)
class Dot:
    """A value with its interval, if it has one, at a height of a forest, what it is called and tells, and
    what is `said` above it.
    """

    value: float
    low: float
    high: float
    at: float
    name: str
    told: str
    look: Look = PLAIN
    said: str = ""
    is_hollow: bool = False


def of_ratio(row: Any, at: float, name: str, look: Look = PLAIN, said: str = "") -> Dot:  # noqa: ANN401
    """Return a ratio, or a row of a table of them, in per cent."""
    value, low, high = (100 * (end - 1) for end in (row.ratio, row.low, row.high))
    return Dot(value, low, high, at, f"{name}: {row.verdict}", change(row), look, said)


def of_medians(summary: pd.DataFrame, names: Sequence[str], colour: str, *, short: bool = False) -> list[Dot]:
    """Return the medians of a table in seconds, from below; unless it is `short` with their intervals."""
    dots = []
    for height, (name, row) in enumerate(zip(names, summary.itertuples(), strict=True)):
        value = f"{number(row.median)} s"
        told = f"{interval_of(row)} s" if "low" in summary else value
        low, high = getattr(row, "low", np.nan), getattr(row, "high", np.nan)
        dots.append(Dot(row.median, low, high, height, name, told, Look(colour), value if short else told))
    return dots


def forest(
    axes: Axes, dots: Sequence[Dot], names: Sequence[str], margin: float | None = None, width: float = 2.0
) -> None:
    """Draw values with their intervals, in rows that have `names` from below. With a `margin` they are ratios
    in per cent: what is within it is shaded and stays in view, and one long interval, or one without an end,
    cannot stretch the axis. Without one the axis begins at 0.
    """
    if margin is None:
        axes.set_xlim(0, 1.12 * float(np.nanmax([end for dot in dots for end in (dot.value, dot.high)])))
    else:
        shade(axes, -100 * margin, 100 * margin, 0)
        axes.spines["left"].set_visible(False)
        rows = [[1 + end / 100 for end in (one.value, one.low, one.high)] for one in dots]
        ratios = pd.DataFrame(rows, columns=["ratio", "low", "high"])
        axes.set_xlim(*(100 * (end - 1) for end in reach(ratios, margin)))
    for dot in dots:
        mark = {"color": dot.look.colour, "mfc": "white" if dot.is_hollow else dot.look.colour}
        point(axes, dot.value, dot.at, dot.look.marker, dot.name, dot.told, markersize=5, zorder=4, **mark)
        span(axes, dot.low, dot.high, dot.at, dot.look.colour, width)
        if dot.said:
            ink = INK if margin is not None else dot.look.colour
            note(axes, dot.said, (dot.value, dot.at), (0, 6), ha="center", fontsize=7, color=ink)
    name_rows(axes, names)
    axes.set_ylim(-0.5, len(names) - 0.3)


def shade(axes: Axes, low: float, high: float, equal: float, *, upright: bool = False) -> None:
    """Shade what is within the margin, and mark no difference."""
    band, line = (axes.axhspan, axes.axhline) if upright else (axes.axvspan, axes.axvline)
    band(low, high, color=BAND, zorder=0, linewidth=0)
    line(equal, color=FAINT, linewidth=0.7, zorder=1)


def span(
    axes: Axes, low: float, high: float, at: float, colour: str, width: float, *, upright: bool = False
) -> None:
    """Draw an interval, which ends in an arrow where it goes on beyond the axis. One without an end is thin
    and dotted; one that is not known is not drawn.
    """
    if np.isnan(low) or np.isnan(high):
        return
    ends = np.clip([low, high], *(axes.get_ylim() if upright else axes.get_xlim()))
    places = ([at, at], ends) if upright else (ends, [at, at])
    known: Any = {"linewidth": width, "solid_capstyle": "butt"}
    look = {"linewidth": 0.9, "linestyle": ":"} if np.isinf(high) else known
    axes.plot(*places, color=colour, zorder=2, **look)
    for end in (low, high):
        arrow(axes, end, at, colour, upright=upright)


def arrow(axes: Axes, value: float, at: float, colour: str, *, upright: bool = False) -> bool:
    """Draw an arrow at the end of the axis if a value lies beyond it; tell whether it does."""
    low, high = axes.get_ylim() if upright else axes.get_xlim()
    shown = min(max(value, low), high)
    if shown != value:
        marks, place = ("v^", (at, shown)) if upright else ("<>", (shown, at))
        axes.plot(*place, marks[int(value > shown)], color=colour, markersize=4, clip_on=False, zorder=6)
    return shown != value


def reach(table: pd.DataFrame, margin: float = MARGIN) -> tuple[float, float]:
    """Return the ends of an axis for the columns `ratio`, `low`, `high`. It has all ratios and the margin,
    and of the intervals what makes it at most three times as long.
    """
    known = np.log(table["ratio"].to_numpy(dtype=float))
    known = known[np.isfinite(known)]
    low, high = (float(end) for end in (min([-2.5 * margin, *known]), max([2.5 * margin, *known])))
    with np.errstate(divide="ignore"):
        ends = np.log(table[["low", "high"]].to_numpy(dtype=float).ravel())
    length = high - low
    ends = ends[(ends > low - length) & (ends < high + length)]
    low, high = min([low, *ends]), max([high, *ends])
    return float(np.exp(low - 0.06 * (high - low))), float(np.exp(high + 0.06 * (high - low)))


def curve(
    axes: Axes, table: pd.DataFrame, look: Look, value: str = "median", aside: float = 1.0, said: Any = None  # noqa: ANN401
) -> None:  # fmt: skip
    """Draw `value` over `aside` times `x`, a mark a point, with the interval `low` to `high` if it has one.
    What a point tells is `said` of its row, by default the value with its interval.
    """
    rows = table.sort_values("x")
    axes.plot(aside * rows["x"], rows[value], color=look.colour, linestyle=look.dashes, zorder=3)
    for row in rows.itertuples():
        up = interval_of(row, value) if said is None else said(row)
        told = str(getattr(row, "series", "")), exact(row.x), up
        point(axes, aside * row.x, getattr(row, value), look.marker, *told, color=look.colour, zorder=3)
        if said is None:
            axes.plot([aside * row.x] * 2, [row.low, row.high], color=look.colour, linewidth=1.1, zorder=3)


def ends_of(table: pd.DataFrame, shown: Mapping[str, Look], value: str) -> list[tuple[str, float, str]]:
    """Return the label of each series, where its last point is, and its colour."""
    last = table.loc[table.groupby("series")["x"].idxmax()]
    return [(row["series"], float(row[value]), shown[row["series"]].colour) for _, row in last.iterrows()]


def line(axes: Axes, x: Iterable[float], y: Iterable[float], look: Look, name: str, **more: Any) -> None:  # noqa: ANN401
    """Draw a curve without intervals."""
    size = more.pop("markersize", 3.5)
    known = list(zip(x, y, strict=True))
    axes.plot(*zip(*known, strict=True), color=look.colour, linestyle=look.dashes, **more)
    for one, other in known:
        drawn = {"color": look.colour, "markersize": size, "zorder": more.get("zorder", 2)}
        point(axes, one, other, look.marker, name, exact(one), number(other), **drawn)


def published_curve(axes: Axes, x: pd.Series, y: pd.Series, look: Look) -> None:
    """Draw a published series in a lighter tone, below everything else."""
    lighter = look._replace(colour=lighten(look.colour))
    line(axes, x, y, lighter, "published", markersize=2.5, linewidth=1.0, zorder=2)


def ratio_axis(axes: Axes, table: pd.DataFrame, against: str, margin: float = MARGIN) -> None:
    """Let the vertical axis show the ratios of a table to something: in per cent or, where they lie far
    apart, as factors on a logarithmic axis. Shade what is within the margin, and mark no difference.
    """
    shade(axes, 1 / (1 + margin), 1 + margin, 1, upright=True)
    within = reach(table, margin)
    if within[1] < FAR * within[0]:
        axes.set_ylim(*within)
        percent_ticks(axes.yaxis)
        axes.set_ylabel(f"time against\n{against}, %")
        return
    axes.set_yscale("log", base=2)
    axes.set_ylim(*within)
    axes.minorticks_off()
    logarithmic_ticks(axes.yaxis, most=9)
    axes.set_ylabel(f"time relative\nto {against}")


def ratio_curve(axes: Axes, table: pd.DataFrame, look: Look, aside: float = 1.0) -> None:
    """Draw the column `ratio` over `aside` times `x` with its intervals, on an axis that is settled. A ratio
    without an interval has none.
    """
    curve(axes, table, look, "ratio", aside, change)
    for row in table.itertuples():
        span(axes, row.low, row.high, aside * row.x, look.colour, 1.1, upright=True)
