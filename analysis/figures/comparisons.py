"""Any number of series against one of them: times, differences within blocks, and a verdict for each."""

from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.comparisons import USUAL, Stated, differences, reference, stated
from analysis.figures.captions import opening, time_axis
from analysis.figures.curves import dots
from analysis.figures.hover import Told, tell
from analysis.figures.league import league
from analysis.figures.pairs import Sides, bounded, interval_bar, pair_drawing
from analysis.figures.style import BAND, BLUE, FAINT, INK, Data, Drawing, new_figure
from analysis.statistics.bootstrap import summarise
from analysis.support.wording import change, exact


def comparison(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the differences of an experiment's series from its reference, with a table of verdicts."""
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    against, by = reference(times), stated(times)
    table = differences(times, against)
    ranked = league(data.study, experiment)
    tables = [] if ranked is None else [ranked]
    table["name"] = [f"{_label(row, table)} against {against}" for row in table.to_dict("records")]
    names = sorted(times["series"].unique(), key=lambda name: name == against)
    if len(names) == 2 and times["x"].nunique() == 1:
        sides = Sides(experiment, names[0], names[1], subject, (names[0], names[1]))
        drawing = pair_drawing(data, sides, by=by, row=next(iter(table.to_dict("records")), None))
        return drawing and replace(drawing, verdicts=table, tables=tables)
    summary = summarise(times, ["series", "x"]).iloc[::-1]
    summary["name"] = [_label(row, summary) for row in summary.to_dict("records")]
    figure, (left, right) = new_figure(0.8 + 0.42 * len(summary), columns=2)
    dots(left, summary, "name")
    left.set_xlabel(time_axis(times))
    _differences(right, table, summary, by.margin)
    right.set_xlabel(f"time against {against}, %")
    said = differences_sentence(table, against, by)
    return Drawing(figure, opening(times, subject) + said, table, tables)


def differences_sentence(table: pd.DataFrame, against: str, by: Stated = USUAL) -> str:
    """Say every difference with its verdict, and the margin and error if they are the question's own; nothing
    for an empty table.
    """
    said = "; ".join(
        f"{_label(row, table)} {change(row)} ({row['verdict']})" for row in table.to_dict("records")
    )
    own = "" if by == USUAL else f", with a margin of {_whole(by.margin)} and an error of {_whole(by.error)}"
    return f" Against {against}: {said} (Holm-corrected{own})." if said else ""


def _label(row: Mapping[Hashable, Any], table: pd.DataFrame) -> str:
    """Return the series, with x where the table has several."""
    return f"{row['series']}, {exact(row['x'])}" if table["x"].nunique() > 1 else str(row["series"])


def _whole(fraction: float) -> str:
    """Return a fraction as a percentage with as many digits as it has."""
    return f"{100 * fraction:g} %"


def _differences(axes: Axes, table: pd.DataFrame, rows: pd.DataFrame, margin: float) -> None:
    """Draw every difference with the interval that decides at the height of its row in the other panel."""
    axes.axvspan(-100 * margin, 100 * margin, color=BAND, zorder=0, linewidth=0)
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    heights = {(row.series, row.x): height for height, row in enumerate(rows.itertuples())}
    for row in table.to_dict("records"):
        height = heights[row["series"], row["x"]]
        estimate = 100 * (row["ratio"] - 1)
        interval_bar(axes, row, height, BLUE, 1.4)
        (dot,) = axes.plot(estimate, height, "o", color=BLUE, markersize=5)
        tell(dot, [Told(f"{_label(row, table)}: {row['verdict']}", change(row))])
        axes.annotate(
            row["verdict"], (estimate, height), xytext=(0, 6), textcoords="offset points", ha="center",
            fontsize=7, color=INK,
        )  # fmt: skip
    axes.set(yticks=[], ylim=(-0.5, len(rows) - 0.3))
    bounded(axes, margin)
    axes.spines["left"].set_visible(False)
