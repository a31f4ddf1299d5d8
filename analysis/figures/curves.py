"""What figures of times are made of: curves with intervals over a sweep, rows of dots with theirs, and
differences against a margin.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.hover import Told, tell
from analysis.figures.labels import name_rows, note
from analysis.figures.style import BAND, BLUE, FAINT, PALETTE, lighten
from analysis.statistics.verdicts import MARGIN
from analysis.support.wording import change, exact, interval_of, number


def colours(table: pd.DataFrame) -> dict[str, str]:
    """Return a colour for each series, in the order of their names."""
    names = sorted(table["series"].unique())
    return {name: PALETTE[number % len(PALETTE)] for number, name in enumerate(names)}


def curve(axes: Axes, summary: pd.DataFrame, colour: str, value: str = "median", aside: float = 1.0) -> None:
    """Draw `value` over `aside` times `x`, a dot a point, with the interval `low` to `high` as a bar."""
    rows = summary.sort_values("x")
    below, above = rows[value] - rows["low"], rows["high"] - rows[value]
    line, *_ = axes.errorbar(
        aside * rows["x"], rows[value], yerr=[below.clip(lower=0), above.clip(lower=0)], color=colour,
        marker="o", elinewidth=1.1, zorder=3,
    )  # fmt: skip
    records = rows.to_dict("records")
    tell(
        line, [Told(str(row.get("series", "")), exact(row["x"]), interval_of(row, value)) for row in records]
    )


def curves(axes: Axes, summary: pd.DataFrame, shades: Mapping[str, str]) -> list[tuple[str, float, str]]:
    """Draw the curve of each series; return the labels of their ends."""
    for series, part in summary.groupby("series"):
        curve(axes, part, shades[str(series)])
    ends = summary.loc[summary.groupby("series")["x"].idxmax()]
    return [(row["series"], row["median"], shades[row["series"]]) for row in ends.to_dict("records")]


def published_curve(axes: Axes, x: Sequence[float], y: Sequence[float], colour: str) -> None:
    """Draw a published series in a lighter tone, below everything else."""
    (line,) = axes.plot(x, y, color=lighten(colour), marker="o", markersize=2.5, linewidth=1.0, zorder=2)
    tell(line, [Told("published", exact(one), number(other)) for one, other in zip(x, y, strict=True)])


def dots(axes: Axes, summary: pd.DataFrame, name: str, colour: str = BLUE) -> None:
    """Draw a row of the table as a dot with its interval, named by the column `name`, in order from below."""
    for height, row in enumerate(summary.to_dict("records")):
        if "low" in row:
            axes.plot([row["low"], row["high"]], [height, height], color=colour, linewidth=1.4)
        (dot,) = axes.plot(row["median"], height, "o", color=colour, markersize=5)
        said = f"{interval_of(row)} s" if "low" in row else f"{row['median']:.2f} s"
        tell(dot, [Told(str(row[name]), said)])
        note(axes, said, (row["median"], height), (0, 6), ha="center", fontsize=7, color=colour)
    name_rows(axes, list(summary[name]))
    axes.set_ylim(-0.5, len(summary) - 0.3)
    axes.set_xlim(0, axes.get_xlim()[1] * 1.12)


def faint_dots(axes: Axes, points: Sequence[tuple[int, float]], colour: str = BLUE) -> None:
    """Draw published values, given as row and value, in a lighter tone behind the measured ones."""
    for height, value in points:
        axes.plot(value, height, "o", color=lighten(colour), markersize=5, zorder=1)


def margin_band(axes: Axes, margin: float = MARGIN) -> None:
    """Shade what is within the margin, for differences of which each has a row, and mark no difference."""
    axes.axvspan(-100 * margin, 100 * margin, color=BAND, zorder=0, linewidth=0)
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)


def difference(
    axes: Axes,
    row: Mapping[Any, Any],
    height: float,
    name: str,
    colour: str,
    width: float,
    **look: Any,  # noqa: ANN401
) -> float:
    """Draw a row of `verdicts.judge` in per cent, as a dot with the interval that decides; return where."""
    if np.isfinite(row["high"]):  # without an interval its ends would stretch the axis
        ends = [100 * (row[end] - 1) for end in ("low", "high")]
        axes.plot(ends, [height, height], color=colour, linewidth=width, zorder=2)
    estimate = 100 * (row["ratio"] - 1)
    (dot,) = axes.plot(estimate, height, "o", color=colour, markersize=5, **look)
    tell(dot, [Told(f"{name}: {row['verdict']}", change(row))])
    return float(estimate)


def bounded(axes: Axes, margin: float = MARGIN) -> None:
    """Keep the margin in view, and an unbounded interval from stretching the axis."""
    low, high = axes.get_xlim()
    axes.set_xlim(max(min(low, -250 * margin), -100), min(max(high, 250 * margin), 300))
