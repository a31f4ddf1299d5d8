"""Medians with intervals as rows of dots."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.hover import Told, tell
from analysis.figures.style import BLUE, lighten
from analysis.support.wording import interval_of


def dots(axes: Axes, summary: pd.DataFrame, name: str, colour: str = BLUE) -> None:
    """Draw a row of the table as a dot with its interval, named by the column `name`, in order from below."""
    for height, row in enumerate(summary.to_dict("records")):
        if "low" in row:
            axes.plot([row["low"], row["high"]], [height, height], color=colour, linewidth=1.4)
        (dot,) = axes.plot(row["median"], height, "o", color=colour, markersize=5)
        said = f"{interval_of(row)} s" if "low" in row else f"{row['median']:.2f} s"
        tell(dot, [Told(str(row[name]), said)])
        axes.annotate(
            said,
            (row["median"], height),
            xytext=(0, 6),
            textcoords="offset points",
            ha="center",
            fontsize=7,
            color=colour,
        )
    axes.set_yticks(range(len(summary)), list(summary[name]))
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(-0.5, len(summary) - 0.3)
    axes.set_xlim(0, axes.get_xlim()[1] * 1.12)


def faint_dots(axes: Axes, points: Sequence[tuple[int, float]], colour: str = BLUE) -> None:
    """Draw published values, given as row and value, in a lighter tone behind the measured ones."""
    for height, value in points:
        axes.plot(value, height, "o", color=lighten(colour), markersize=5, zorder=1)
