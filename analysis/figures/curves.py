"""What figures of times are made of: curves with intervals over a sweep, and rows of dots with theirs."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.hover import Told, tell
from analysis.figures.style import BLUE, PALETTE, lighten
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
