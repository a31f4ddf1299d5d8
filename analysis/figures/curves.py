"""What figures of times are made of: curves with intervals over a sweep, rows of dots with theirs, and paired
differences against a margin, whose intervals end in an arrow where they go on beyond the axis.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.hover import Told, tell
from analysis.figures.labels import name_rows, note
from analysis.figures.style import BAND, BLUE, FAINT, Look, lighten
from analysis.statistics.verdicts import MARGIN
from analysis.support.wording import change, exact, interval_of, number


def curve(
    axes: Axes, summary: pd.DataFrame, look: Look, value: str = "median", aside: float = 1.0
) -> None:  # fmt: skip
    """Draw `value` over `aside` times `x`, a mark a point, with the interval `low` to `high` as a bar."""
    rows = summary.sort_values("x")
    below, above = rows[value] - rows["low"], rows["high"] - rows[value]
    line, *_ = axes.errorbar(
        aside * rows["x"], rows[value], yerr=[below.clip(lower=0), above.clip(lower=0)], color=look.colour,
        marker=look.marker, linestyle=look.dashes, elinewidth=1.1, zorder=3,
    )  # fmt: skip
    records = rows.to_dict("records")
    tell(
        line, [Told(str(row.get("series", "")), exact(row["x"]), interval_of(row, value)) for row in records]
    )


def curves(
    axes: Axes, summary: pd.DataFrame, shown: Mapping[str, Look], value: str = "median"
) -> list[tuple[str, float, str]]:
    """Draw the curve of each series; return the labels of their ends."""
    for series, part in summary.groupby("series"):
        curve(axes, part, shown[str(series)], value)
    ends = summary.loc[summary.groupby("series")["x"].idxmax()]
    return [(row["series"], row[value], shown[row["series"]].colour) for row in ends.to_dict("records")]


def published_curve(axes: Axes, x: Sequence[float], y: Sequence[float], look: Look) -> None:
    """Draw a published series in a lighter tone, below everything else."""
    (line,) = axes.plot(
        x, y, color=lighten(look.colour), marker=look.marker, linestyle=look.dashes, markersize=2.5,
        linewidth=1.0, zorder=2,
    )  # fmt: skip
    tell(line, [Told("published", exact(one), number(other)) for one, other in zip(x, y, strict=True)])


def dots(axes: Axes, summary: pd.DataFrame, name: str, colour: str = BLUE, *, named: bool = True) -> None:
    """Draw a row of the table as a dot with its interval, in order from below; the column `name` is written
    beside the rows if they are to be `named`.
    """
    for height, row in enumerate(summary.to_dict("records")):
        if "low" in row:
            axes.plot([row["low"], row["high"]], [height, height], color=colour, linewidth=1.4)
        (dot,) = axes.plot(row["median"], height, "o", color=colour, markersize=5 if named else 3.5)
        told = f"{interval_of(row)} s" if "low" in row else f"{number(row['median'])} s"
        tell(dot, [Told(str(row[name]), told)])
        said = told if named else f"{number(row['median'])} s"
        note(axes, said, (row["median"], height), (0, 6), ha="center", fontsize=7, color=colour)
    name_rows(axes, list(summary[name]) if named else [""] * len(summary))
    axes.set_ylim(-0.5, len(summary) - 0.3)
    axes.set_xlim(0, axes.get_xlim()[1] * 1.12)


def faint_dots(axes: Axes, points: Sequence[tuple[float, float]], colour: str = BLUE) -> None:
    """Draw published values, given as row and value, in a lighter tone below the measured ones."""
    for height, value in points:
        (dot,) = axes.plot(value, height - 0.2, "o", color=lighten(colour), markersize=4, zorder=1)
        tell(dot, [Told("published", number(value))])


def margin_band(axes: Axes, margin: float = MARGIN) -> None:
    """Shade what is within the margin, for differences of which each has a row, and mark no difference."""
    axes.axvspan(-100 * margin, 100 * margin, color=BAND, zorder=0, linewidth=0)
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)


class _Bar(NamedTuple):
    """A difference that waits for the limits of its axis: a ratio with its interval, and how it is drawn."""

    ratio: float
    low: float
    high: float
    height: float
    colour: str
    width: float


_BARS: WeakKeyDictionary[Axes, list[_Bar]] = WeakKeyDictionary()


def difference(
    axes: Axes,
    row: Mapping[Any, Any],
    height: float,
    name: str,
    colour: str,
    width: float,
    **look: Any,  # noqa: ANN401
) -> float:
    """Draw a row of `verdicts.judge` in per cent, as a dot with the interval that decides, which `bounded`
    adds; return where.
    """
    bar = _Bar(row["ratio"], row["low"], row["high"], height, colour, width)
    _BARS.setdefault(axes, []).append(bar)
    estimate = 100 * (row["ratio"] - 1)
    (dot,) = axes.plot(estimate, height, **{"marker": "o", "markersize": 5, **look}, color=colour)
    tell(dot, [Told(f"{name}: {row['verdict']}", change(row))])
    return float(estimate)


def bounded(axes: Axes, margin: float = MARGIN) -> None:
    """Settle the axis of the differences drawn, and add their intervals. The margin stays in view; one long
    interval, or one without an end, cannot stretch the axis and ends in an arrow at its end.
    """
    bars = _BARS.pop(axes, [])
    low, high = (100 * (end - 1) for end in reach(pd.DataFrame(bars, columns=_Bar._fields), margin))
    axes.set_xlim(low, high)
    for bar in bars:
        if np.isnan(bar.low) or np.isnan(bar.high):
            continue
        ends = [100 * (end - 1) for end in (bar.low, bar.high)]
        unknown = np.isinf(bar.high)
        drawn = np.clip(ends, low, high)
        look: Any = {"linewidth": 0.9 if unknown else bar.width, "linestyle": ":" if unknown else "-"}
        axes.plot(drawn, [bar.height] * 2, color=bar.colour, zorder=2, solid_capstyle="butt", **look)
        for at, mark, is_beyond in ((low, "<", ends[0] < low), (high, ">", ends[1] > high)):
            if is_beyond:
                axes.plot(at, bar.height, mark, color=bar.colour, markersize=4, clip_on=False, zorder=3)


def reach(table: pd.DataFrame, margin: float = MARGIN) -> tuple[float, float]:
    """Return the ends of an axis for the columns `ratio`, `low`, `high`. It has all ratios and the margin,
    and of the intervals what makes it at most three times as long.
    """
    known = np.log(table["ratio"].to_numpy(dtype=float))
    known = known[np.isfinite(known)]
    low, high = (float(end) for end in (min([-2.5 * margin, *known]), max([2.5 * margin, *known])))
    with np.errstate(divide="ignore"):
        ends = np.log(table[["low", "high"]].to_numpy(dtype=float).ravel())
    span = high - low
    ends = ends[(ends > low - span) & (ends < high + span)]
    low, high = min([low, *ends]), max([high, *ends])
    return float(np.exp(low - 0.06 * (high - low))), float(np.exp(high + 0.06 * (high - low)))


def ratio_curve(
    axes: Axes, table: pd.DataFrame, look: Look, within: tuple[float, float], aside: float = 1.0
) -> None:
    """Draw the column `ratio` over `aside` times `x` with its intervals, which end in an arrow at the ends of
    the axis, `within`. A ratio without an interval has none.
    """
    rows = table.sort_values("x")
    (line,) = axes.plot(
        aside * rows["x"],
        rows["ratio"],
        color=look.colour,
        marker=look.marker,
        linestyle=look.dashes,
        zorder=3,
    )
    tell(
        line,
        [Told(str(row.get("series", "")), exact(row["x"]), change(row)) for row in rows.to_dict("records")],
    )
    for row in rows.dropna(subset=["low", "high"]).itertuples():
        x, unknown = aside * row.x, np.isinf(row.high)
        drawn = np.clip([row.low, row.high], *within)
        dotted: Any = {"linewidth": 0.7, "linestyle": ":"} if unknown else {"linewidth": 1.1}
        axes.plot([x, x], drawn, color=look.colour, zorder=2.5, **dotted)
        for at, mark, is_beyond in (
            (within[0], "v", row.low < within[0]),
            (within[1], "^", row.high > within[1]),
        ):
            if is_beyond:
                axes.plot(x, at, mark, color=look.colour, markersize=3.5, clip_on=False, zorder=3)


def ratio_band(axes: Axes, margin: float = MARGIN) -> None:
    """Shade what is within the margin over a sweep, and mark no difference."""
    axes.axhspan(1 / (1 + margin), 1 + margin, color=BAND, zorder=0, linewidth=0)
    axes.axhline(1, color=FAINT, linewidth=0.7, zorder=1)
