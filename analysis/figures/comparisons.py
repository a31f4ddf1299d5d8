"""Any number of series against one of them: differences within blocks with a verdict each, published ones on
the same axis, and times beside them.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.comparisons import USUAL, Stated, differences, reference, stated
from analysis.figures.captions import differing, opening, time_axis
from analysis.figures.curves import dots, forest
from analysis.figures.hover import Told, point
from analysis.figures.labels import name_rows
from analysis.figures.league import league
from analysis.figures.pairs import Sides, pair_drawing
from analysis.figures.style import INK, Data, Drawing, lighten, looks, new_figure
from analysis.statistics.bootstrap import summarise
from analysis.support.values import Row
from analysis.support.wording import exact, number

PublishedOf = Callable[[Data, pd.DataFrame, str], Mapping[str, float]]
"""From the table of differences to the published ratios of series to the reference."""

LIGHTER = " Lighter: the published medians with self-contained resolves, moved as one so that track is level."


def comparison(
    data: Data, experiment: str, subject: str, published: PublishedOf | None = None
) -> Drawing | None:  # fmt: skip
    """Draw the differences of an experiment's series from its reference, with a table of verdicts, and the
    `published` ones on the same axis.
    """
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    against, by = reference(times), stated(times)
    table = named(differences(times, against), against)
    ranked = league(data.study, experiment)
    tables = [ranked] if ranked else []
    names = sorted(times["series"].unique(), key=lambda name: name == against)
    if len(names) == 2 and times["x"].nunique() == 1:
        sides = Sides(experiment, names[0], names[1], subject, (names[0], names[1]))
        drawing = pair_drawing(data, sides, by=by, row=next(iter(table.to_dict("records")), None))
        return drawing and replace(drawing, verdicts=table, tables=tables)
    summary = summarise(times, ["series", "x"]).iloc[::-1]
    summary["name"] = [_label(row, summary) for row in summary.to_dict("records")]
    theirs = published(data, table, against) if published else {}
    figure, (left, right) = new_figure(0.8 + 0.36 * len(summary), columns=2, widths=[2.1, 1.0])
    _differences(left, table, summary, by.margin, theirs)
    left.set_xlabel(f"time against {against}, %")
    dots(right, summary, "name", INK, named=False)
    right.set_xlabel(time_axis(times))
    said = differences_sentence(table, against, by)
    lighter = LIGHTER if theirs else ""
    return Drawing(figure, f"{opening(times, subject)}{said}{lighter}", table, tables)


def published_orders(data: Data, table: pd.DataFrame, against: str) -> dict[str, float]:
    """Return the published times of the sequential orders, with self-contained resolves, as ratios, moved as
    one so that track is level with ours, if it is there.
    """
    seconds = {
        name: data.published.experiment(f"self_contained_{name}").query("series == 'on'")["seconds"].median()
        for name in ("track", "repeat")
    }
    level = {against: 1.0, **dict(zip(table["series"], table["ratio"], strict=True))}
    if "track" not in level:
        return {}
    return {name: level["track"] * one / seconds["track"] for name, one in seconds.items() if name in level}


def named(table: pd.DataFrame, against: str) -> pd.DataFrame:
    """Return the differences with what the report is to call each, its `name`."""
    return table.assign(name=[f"{_label(row, table)} against {against}" for row in table.to_dict("records")])


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


def _differences(
    axes: Axes, table: pd.DataFrame, rows: pd.DataFrame, margin: float, published: Mapping[str, float]
) -> None:  # fmt: skip
    """Draw every difference with the interval that decides at the height of its row in the other panel, and
    the published ones, lighter, below them.
    """
    heights = {(row.series, row.x): height for height, row in enumerate(rows.itertuples())}
    shown, drawn = looks(rows["series"]), []
    for row in table.to_dict("records"):
        look, at = shown[row["series"]], heights[row["series"], row["x"]]
        told = {"name": _label(row, table), "said": row["verdict"], "at": at}
        drawn.append({**row, **told, "colour": look.colour, "mark": look.marker})
    forest(axes, drawn, margin)
    for (name, _), height in heights.items():
        if name in published:
            change = 100 * (published[name] - 1)
            faint: Any = {"color": lighten(INK), "markersize": 4, "zorder": 1}
            point(axes, change, height - 0.2, "o", Told("published", number(change)), **faint)
    name_rows(axes, list(rows["name"]))
    axes.set_ylim(-0.5, len(rows) - 0.3)
