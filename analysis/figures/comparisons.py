"""Any number of series against one of them: times, differences within blocks, and a verdict for each."""

from dataclasses import replace

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.comparisons import USUAL, Stated, differences, reference, stated
from analysis.figures.captions import differing, opening, time_axis
from analysis.figures.curves import bounded, difference, dots, margin_band
from analysis.figures.labels import note
from analysis.figures.league import league
from analysis.figures.pairs import Sides, pair_drawing
from analysis.figures.style import BLUE, INK, Data, Drawing, new_figure
from analysis.statistics.bootstrap import summarise
from analysis.support.values import Row
from analysis.support.wording import exact


def comparison(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the differences of an experiment's series from its reference, with a table of verdicts."""
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    against, by = reference(times), stated(times)
    table = differences(times, against)
    ranked = league(data.study, experiment)
    tables = [ranked] if ranked else []
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
    """Say every difference with its verdict, and the margin and error if they are the question's own."""
    said = differing((_label(row, table) for row in table.to_dict("records")), table)
    own = "" if by == USUAL else f", with a margin of {_whole(by.margin)} and an error of {_whole(by.error)}"
    return f" Against {against}: {said} (Holm-corrected{own})." if said else ""


def _label(row: Row, table: pd.DataFrame) -> str:
    """Return the series, with x where the table has several."""
    return f"{row['series']}, {exact(row['x'])}" if table["x"].nunique() > 1 else str(row["series"])


def _whole(fraction: float) -> str:
    """Return a fraction as a percentage with as many digits as it has."""
    return f"{100 * fraction:g} %"


def _differences(axes: Axes, table: pd.DataFrame, rows: pd.DataFrame, margin: float) -> None:
    """Draw every difference with the interval that decides at the height of its row in the other panel."""
    margin_band(axes, margin)
    heights = {(row.series, row.x): height for height, row in enumerate(rows.itertuples())}
    for row in table.to_dict("records"):
        height = heights[row["series"], row["x"]]
        at = difference(axes, row, height, _label(row, table), BLUE, 1.4)
        note(axes, row["verdict"], (at, height), (0, 6), ha="center", fontsize=7, color=INK)
    axes.set_ylim(-0.5, len(rows) - 0.3)
    bounded(axes, margin)
