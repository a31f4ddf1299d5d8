"""The kinds of which figures are made, drawn from rows: forests, curves with or without ratios below them,
and the mark with its intervals of which all of them are made. What a mark tells when the pointer rests on it
comes from the row that is drawn.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.figures.labels import (
    from_zero,
    label_ends,
    logarithmic_ticks,
    name_rows,
    note,
    percent_ticks,
    plain_ticks,
)
from analysis.figures.style import BAND, FAINT, INK, Look, lighten, new_grid, point
from analysis.statistics.verdicts import MARGIN
from analysis.support.wording import change, exact, interval_of, number

PLAIN = Look(INK)
FAR = 1.6
"""Times the least ratio from which the greatest is shown as a factor, not in per cent."""
NO_ENDS = (np.nan, np.nan)

ASIDE = {"dynamic": 0.985, "static": 1.015}
"""How far the curve of a schedule is moved aside, so that intervals at one chunk do not cover each other."""

Ends = tuple[float, float]
Sides = Mapping[str, tuple[pd.DataFrame, pd.DataFrame]]
"""Columns of a figure by their titles: the times by series and x as `median`, and the ratios."""


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


def of_ratio(
    row: Any, at: float, name: str, look: Look = PLAIN, said: str = "", *, judged: bool = True  # noqa: ANN401
) -> Dot:  # fmt: skip
    """Return a ratio, or a row of a table of them, in per cent; it tells its verdict if it was `judged`."""
    value, low, high = (100 * (end - 1) for end in (row.ratio, row.low, row.high))
    return Dot(value, low, high, at, f"{name}: {row.verdict}" if judged else name, change(row), look, said)


def of_medians(summary: pd.DataFrame, names: Sequence[str], colour: str, *, short: bool = False) -> list[Dot]:
    """Return the medians of a table in seconds, from below; unless it is `short` with their intervals."""
    dots = []
    for height, (name, row) in enumerate(zip(names, summary.itertuples(), strict=True)):
        value = f"{number(row.median)} s"
        told = f"{interval_of(row)} s" if "low" in summary else value
        low, high = getattr(row, "low", np.nan), getattr(row, "high", np.nan)
        dots.append(Dot(row.median, low, high, height, name, told, Look(colour), value if short else told))
    return dots


def mark(
    axes: Axes, at: tuple[float, float], look: Look, *told: str, across: Ends = NO_ENDS, up: Ends = NO_ENDS,
    hollow: bool = False, size: float = 3.5, width: float = 1.1, zorder: float = 3,
) -> None:  # fmt: skip
    """Draw a value with its interval along either axis, or along both; what it has told is its name, and
    what it tells of either axis.
    """
    face = "white" if hollow else look.colour
    point(axes, *at, look.marker, *told, color=look.colour, mfc=face, markersize=size, zorder=zorder + 1)
    span(axes, *across, at[1], look.colour, width)
    span(axes, *up, at[0], look.colour, width, upright=True)


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
        ends: Any = {"across": (dot.low, dot.high), "hollow": dot.is_hollow}
        mark(axes, (dot.value, dot.at), dot.look, dot.name, dot.told, size=5, width=width, **ends)
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
    """Draw an interval. On an axis that is settled it ends in an arrow where it goes on beyond, and one
    without an end is thin and dotted; one that is not known is not drawn.
    """
    if np.isnan(low) or np.isnan(high):
        return
    is_open = axes.get_autoscaley_on() if upright else axes.get_autoscalex_on()
    limits = (-np.inf, np.inf) if is_open else axes.get_ylim() if upright else axes.get_xlim()
    ends = np.clip([low, high], *limits)
    places = ([at, at], ends) if upright else (ends, [at, at])
    known: Any = {"linewidth": width, "solid_capstyle": "butt"}
    look = {"linewidth": 0.9, "linestyle": ":"} if np.isinf(high) else known
    axes.plot(*places, color=colour, zorder=2, **look)
    for end in () if is_open else (low, high):
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
    with np.errstate(divide="ignore"):
        known, ends = (np.log(table[of].to_numpy(dtype=float)) for of in ("ratio", ["low", "high"]))
    known = known[np.isfinite(known)]
    low, high = min([-2.5 * margin, *known]), max([2.5 * margin, *known])
    ends = ends[(ends > 2 * low - high) & (ends < 2 * high - low)]
    low, high = min([low, *ends]), max([high, *ends])
    return float(np.exp(low - 0.06 * (high - low))), float(np.exp(high + 0.06 * (high - low)))


def curve(
    axes: Axes, table: pd.DataFrame, look: Look, value: str = "median", aside: float = 1.0, *,
    told: Callable[[Any], str] | None = None, name: str | None = None, size: float = 3.5, zorder: float = 3,
    width: float = 1.3,
) -> None:  # fmt: skip
    """Draw `value` over `aside` times `x`, a mark a point, with the interval `low` to `high` if it has one.
    A point tells its `name`, or else the row's series, and what is `told` of its row, or else the value with
    the interval.
    """
    rows = table.sort_values("x")
    drawn: Any = {"color": look.colour, "linestyle": look.dashes, "zorder": zorder, "linewidth": width}
    axes.plot(aside * rows["x"], rows[value], **drawn)
    for row in rows.itertuples():
        y, ends = getattr(row, value), (getattr(row, "low", np.nan), getattr(row, "high", np.nan))
        up = told(row) if told else interval_of(row, value) if "low" in rows else number(y)
        called = str(getattr(row, "series", "")) if name is None else name
        mark(axes, (aside * row.x, y), look, called, exact(row.x), up, up=ends, size=size, zorder=zorder)


def curves(
    axes: Axes, rows: pd.DataFrame, shown: Mapping[str, Look], value: str = "median",
    told: Callable[[Any], str] | None = None,
) -> list[tuple[str, float, str]]:  # fmt: skip
    """Draw `value` of the rows over x, a curve a series, those that are published (`is_published`) in a
    lighter tone, below everything else. Return what is to stand at the end of each, for `label_ends`: the
    series, or what the rows have as `label`, where the last point is, and the colour.
    """
    ends = []
    is_published = rows.get("is_published", pd.Series(data=False, index=rows.index)).eq(True)
    for (series, theirs), part in rows.groupby([rows["series"], is_published]):
        look, aside, ink = shown[series], ASIDE.get(series, 1.0), shown[series].colour
        if theirs:
            pale: Any = {"name": "published", "size": 2.5, "width": 1.0, "zorder": 1.5}
            curve(axes, part[["x", value]], look._replace(colour=lighten(ink)), value, aside, **pale)
            ink = lighten(ink, 0.35)
        else:
            curve(axes, part, look, value, aside, told=told)
        last = part.loc[part["x"] == part["x"].max()].iloc[0]
        said = last.get("label", np.nan)
        ends.append((series if pd.isna(said) else said, float(last[value]), ink))
    return ends


def stack(
    label: str, value: str, sides: Sides, shown: Mapping[str, Look], against: str, margin: float,
    scale: str = "",
) -> tuple[Figure, Any]:  # fmt: skip
    """Draw times above ratios to something (`against`, nothing for none), a column a side. `label` names x,
    `value` the times, `scale` the axes that are logarithmic. Several series, and what has a `label`, are
    named at their ends.
    """
    height = 4.2 if scale == "xy" else 3.7
    figure, grid = new_grid(height, 2, len(sides), sharex="col", height_ratios=[1, 1.25])
    whole = pd.concat([ratios for _, ratios in sides.values()])
    for (above, below), (title, (times, ratios)) in zip(grid.T, sides.items(), strict=True):
        above.set(title=title, **{f"{axis}scale": "log" for axis in scale})
        ends = curves(above, times, shown)
        if "y" in scale:
            logarithmic_ticks(above.yaxis)
        else:
            from_zero(above)
        label_ends(above, ends if len(shown) > 1 else [])
        below.set_xlabel(label)
        if against:
            ratio_axis(below, whole, against, margin)
            ends = curves(below, ratios, shown, "ratio", change)
            label_ends(below, ends if len(shown) > 1 or "label" in ratios else [])
        ticks = logarithmic_ticks if "x" in scale else plain_ticks
        ticks(below.xaxis)
        above.set_ylabel("time of the\nprocess, s" if title == "published" else value)
    for axes in grid[1][1:]:
        axes.set_ylabel("")
    return figure, grid


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
