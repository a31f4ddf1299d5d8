"""Any number of series against one of them: times, differences within blocks, and a verdict for each."""

from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.captions import opening, time_axis
from analysis.figures.curves import dots
from analysis.figures.hover import Told, tell
from analysis.figures.league import league
from analysis.figures.pairs import Sides, bounded, pair_drawing
from analysis.figures.style import BAND, BLUE, FAINT, INK, Data, Drawing, new_figure
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import log_ratios, process_medians
from analysis.statistics.verdicts import MARGIN, judge
from analysis.support.wording import change, exact

PUBLISHED = "published"


def comparison(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the differences of an experiment's series from its reference, with a table of verdicts."""
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    against = reference(times)
    table = differences(times, against)
    ranked = league(data.study, experiment)
    tables = [] if ranked is None else [ranked]
    table["name"] = [f"{_label(row, table)} against {against}" for row in table.to_dict("records")]
    names = sorted(times["series"].unique(), key=lambda name: name == against)
    if len(names) == 2 and times["x"].nunique() == 1:
        drawing = pair_drawing(data, Sides(experiment, names[0], names[1], subject, (names[0], names[1])))
        return drawing and replace(drawing, verdicts=table, tables=tables)
    summary = summarise(times, ["series", "x"]).iloc[::-1]
    summary["name"] = [_label(row, summary) for row in summary.to_dict("records")]
    figure, (left, right) = new_figure(0.8 + 0.42 * len(summary), columns=2)
    dots(left, summary, "name")
    left.set_xlabel(time_axis(times))
    _differences(right, table, summary)
    right.set_xlabel(f"time against {against}, %")
    said = differences_sentence(table, against)
    return Drawing(figure, opening(times, subject) + said, table, tables)


def reference(times: pd.DataFrame) -> str:
    """Return the series that the others are compared with: the only one of the published variant, or else the
    first by name. It does not depend on the times, or the verdicts would be biased.
    """
    candidates = sorted(times.loc[times["variant"] == PUBLISHED, "series"].unique())
    return str(candidates[0] if len(candidates) == 1 else min(times["series"]))


def differences(times: pd.DataFrame, against: str) -> pd.DataFrame:
    """Return a row of `verdicts.judge` for every other series and x, compared within blocks with the series
    `against` at the same x, Holm-corrected over all of them.
    """
    processes = process_medians(times)
    first, others = (processes[(processes["series"] == against) == side] for side in (True, False))
    pairs = [
        log_ratios(first, part, match=("x",)).assign(series=name) for name, part in others.groupby("series")
    ]
    columns = ["series", "x", "log_ratio"]
    table = pd.concat(pairs) if pairs else pd.DataFrame(columns=columns)
    return judge(table, ["series", "x"])


def differences_sentence(table: pd.DataFrame, against: str) -> str:
    """Say every difference with its verdict; nothing for an empty table."""
    said = "; ".join(
        f"{_label(row, table)} {change(row)} ({row['verdict']})" for row in table.to_dict("records")
    )
    return f" Against {against}: {said} (Holm-corrected)." if said else ""


def _label(row: Mapping[Hashable, Any], table: pd.DataFrame) -> str:
    """Return the series, with x where the table has several."""
    return f"{row['series']}, {exact(row['x'])}" if table["x"].nunique() > 1 else str(row["series"])


def _differences(axes: Axes, table: pd.DataFrame, rows: pd.DataFrame) -> None:
    """Draw every difference with its 95 % interval at the height of its row in the other panel."""
    axes.axvspan(-100 * MARGIN, 100 * MARGIN, color=BAND, zorder=0, linewidth=0)
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    heights = {(row.series, row.x): height for height, row in enumerate(rows.itertuples())}
    for row in table.to_dict("records"):
        height = heights[row["series"], row["x"]]
        estimate, low, high = (100 * (row[end] - 1) for end in ("ratio", "low", "high"))
        axes.plot([low, high], [height, height], color=BLUE, linewidth=1.4)
        (dot,) = axes.plot(estimate, height, "o", color=BLUE, markersize=5)
        tell(dot, [Told(f"{_label(row, table)}: {row['verdict']}", change(row))])
        axes.annotate(
            row["verdict"], (estimate, height), xytext=(0, 6), textcoords="offset points", ha="center",
            fontsize=7, color=INK,
        )  # fmt: skip
    axes.set(yticks=[], ylim=(-0.5, len(rows) - 0.3))
    bounded(axes)
    axes.spines["left"].set_visible(False)
