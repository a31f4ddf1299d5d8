"""What figures of times are made of: curves with intervals over a sweep, rows of dots with theirs, and paired
differences against a margin, whose intervals end in an arrow where they go on beyond the axis.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.hover import Told, point, tell
from analysis.figures.labels import logarithmic_ticks, name_rows, note, percent_ticks
from analysis.figures.style import BAND, BLUE, FAINT, INK, Look, lighten
from analysis.statistics.verdicts import MARGIN
from analysis.support.wording import change, exact, interval_of, number

FAR = 1.6
"""Times the least ratio from which the greatest is shown as a factor, not in per cent."""


def line(
    axes: Axes, x: pd.Series, y: pd.Series, look: Look, told: Iterable[Told], **more: Any  # noqa: ANN401
) -> None:  # fmt: skip
    """Draw a curve whose points tell something."""
    (drawn,) = axes.plot(x, y, color=look.colour, marker=look.marker, linestyle=look.dashes, **more)
    tell(drawn, told)


def curve(
    axes: Axes, summary: pd.DataFrame, look: Look, value: str = "median", aside: float = 1.0
) -> None:  # fmt: skip
    """Draw `value` over `aside` times `x`, a mark a point, with the interval `low` to `high` as a bar."""
    rows = summary.sort_values("x")
    below, above = rows[value] - rows["low"], rows["high"] - rows[value]
    drawn, *_ = axes.errorbar(
        aside * rows["x"], rows[value], yerr=[below.clip(lower=0), above.clip(lower=0)], color=look.colour,
        marker=look.marker, linestyle=look.dashes, elinewidth=1.1, zorder=3,
    )  # fmt: skip
    records = rows.to_dict("records")
    tell(
        drawn, [Told(str(row.get("series", "")), exact(row["x"]), interval_of(row, value)) for row in records]
    )


def curves(
    axes: Axes, summary: pd.DataFrame, shown: Mapping[str, Look], value: str = "median"
) -> list[tuple[str, float, str]]:
    """Draw the curve of each series; return the labels of their ends."""
    for series, part in summary.groupby("series"):
        curve(axes, part, shown[str(series)], value)
    ends = summary.loc[summary.groupby("series")["x"].idxmax()]
    return [(row["series"], row[value], shown[row["series"]].colour) for row in ends.to_dict("records")]


def published_curve(axes: Axes, x: pd.Series, y: pd.Series, look: Look) -> None:
    """Draw a published series in a lighter tone, below everything else."""
    told = [Told("published", exact(one), number(other)) for one, other in zip(x, y, strict=True)]
    lighter = look._replace(colour=lighten(look.colour))
    line(axes, x, y, lighter, told, markersize=2.5, linewidth=1.0, zorder=2)


def dots(axes: Axes, summary: pd.DataFrame, name: str, colour: str = BLUE, *, named: bool = True) -> None:
    """Draw a row of the table as a dot with its interval, in order from below; the column `name` is written
    beside the rows if they are to be `named`.
    """
    for height, row in enumerate(summary.to_dict("records")):
        short = f"{number(row['median'])} s"
        told = f"{interval_of(row)} s" if "low" in row else short
        if "low" in row:
            axes.plot([row["low"], row["high"]], [height, height], color=colour, linewidth=1.4)
        size = 5 if named else 3.5
        point(axes, row["median"], height, "o", Told(str(row[name]), told), color=colour, markersize=size)
        write_above(axes, told if named else short, (row["median"], height), colour)
    name_rows(axes, list(summary[name]) if named else [""] * len(summary))
    axes.set_ylim(-0.5, len(summary) - 0.3)
    axes.set_xlim(0, axes.get_xlim()[1] * 1.12)


def write_above(axes: Axes, text: str, at: tuple[float, float], colour: str) -> None:
    """Write what a point of a row shows above it."""
    note(axes, text, at, (0, 6), ha="center", fontsize=7, color=colour)


def forest(axes: Axes, rows: Sequence[Mapping[Any, Any]], margin: float = MARGIN, width: float = 2.0) -> None:
    """Draw rows of `verdicts.judge` in per cent, each a dot with the interval that decides, at the height
    `at`, in its `colour`, with its `mark` and its `name`; what is `said`, if anything, stands above it.

    The margin is shaded and stays in view; one long interval, or one without an end, cannot stretch the axis.
    """
    axes.axvspan(-100 * margin, 100 * margin, color=BAND, zorder=0, linewidth=0)
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    axes.spines["left"].set_visible(False)
    within = reach(pd.DataFrame(rows, columns=["ratio", "low", "high"]), margin)
    axes.set_xlim(*(100 * (end - 1) for end in within))
    for row in rows:
        estimate, low, high = (100 * (row[end] - 1) for end in ("ratio", "low", "high"))
        told = Told(f"{row['name']}: {row['verdict']}", change(row))
        point(axes, estimate, row["at"], row["mark"], told, color=row["colour"], markersize=5, zorder=4)
        span(axes, low, high, row["at"], row["colour"], width)
        if row["said"]:
            write_above(axes, row["said"], (estimate, row["at"]), INK)


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


def ratio_axis(axes: Axes, table: pd.DataFrame, against: str, margin: float = MARGIN) -> None:
    """Let the vertical axis show the ratios of a table to something: in per cent or, where they lie far
    apart, as factors on a logarithmic axis. Shade what is within the margin, and mark no difference.
    """
    axes.axhspan(1 / (1 + margin), 1 + margin, color=BAND, zorder=0, linewidth=0)
    axes.axhline(1, color=FAINT, linewidth=0.7, zorder=1)
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
    rows = table.sort_values("x")
    records = rows.to_dict("records")
    told = [Told(str(row.get("series", "")), exact(row["x"]), change(row)) for row in records]
    line(axes, aside * rows["x"], rows["ratio"], look, told, zorder=3)
    for row in records:
        span(axes, row["low"], row["high"], aside * row["x"], look.colour, 1.1, upright=True)
