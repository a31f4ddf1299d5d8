"""Curves with intervals, the building block of every sweep."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.hover import Told, tell
from analysis.figures.style import PALETTE, lighten
from analysis.support.wording import exact, interval_of, number


def colours(table: pd.DataFrame) -> dict[str, str]:
    """Return a colour for each series, in the order of their names."""
    names = sorted(table["series"].unique())
    return {name: PALETTE[number % len(PALETTE)] for number, name in enumerate(names)}


def curve(axes: Axes, summary: pd.DataFrame, colour: str, value: str = "median", aside: float = 1.0) -> None:
    """Draw `value` over `x` as a line with a dot a point and the interval `low` to `high` as a bar, all of it
    `aside` times x.
    """
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


def published_curve(axes: Axes, x: Sequence[float], y: Sequence[float], colour: str) -> None:
    """Draw a published series in a lighter tone, below everything else."""
    (line,) = axes.plot(x, y, color=lighten(colour), marker="o", markersize=2.5, linewidth=1.0, zorder=2)
    tell(line, [Told("published", exact(one), number(other)) for one, other in zip(x, y, strict=True)])
