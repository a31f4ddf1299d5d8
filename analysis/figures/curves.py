"""Curves with intervals, the building block of every sweep."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.style import PALETTE, lighten


def colours(table: pd.DataFrame) -> dict[str, str]:
    """Return a colour for each series, in the order of their names."""
    names = sorted(table["series"].unique())
    return {name: PALETTE[number % len(PALETTE)] for number, name in enumerate(names)}


def curve(axes: Axes, summary: pd.DataFrame, colour: str, value: str = "median") -> None:
    """Draw `value` over `x` as a line with a dot a point and the interval `low` to `high` as a bar."""
    rows = summary.sort_values("x")
    below, above = rows[value] - rows["low"], rows["high"] - rows[value]
    axes.errorbar(
        rows["x"], rows[value], yerr=[below.clip(lower=0), above.clip(lower=0)], color=colour, marker="o",
        elinewidth=1.1, zorder=3,
    )  # fmt: skip


def published_curve(axes: Axes, x: Sequence[float], y: Sequence[float], colour: str) -> None:
    """Draw a published series in a lighter tone, below everything else."""
    axes.plot(x, y, color=lighten(colour), marker="o", markersize=2.5, linewidth=1.0, zorder=2)
