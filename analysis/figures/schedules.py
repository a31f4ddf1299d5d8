"""Time over the chunk, one curve a kind of schedule, the published study's appendix beside it."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.captions import opening
from analysis.figures.curves import colours, curve, published_curve
from analysis.figures.labels import label_ends, plain_ticks
from analysis.figures.style import BLUE, GREEN, INK, VERMILLION, Data, Drawing, lighten, new_figure
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import join_replicates
from analysis.support.wording import exact, interval_of, number

Choice = tuple[str, int]
Label = tuple[str, float, str]

COLOURS = {"guided": BLUE, "dynamic": VERMILLION, "static": GREEN}
ASIDE = {"dynamic": 0.985, "static": 1.015}
"""How far a curve is moved to the side, so that intervals at the same chunk do not cover each other."""

TICKS = [1, 2, 3, 5, 10, 20, 40, 80, 160, 320, 640, 1280]


def schedule(data: Data, experiment: str, subject: str, chosen: Choice | None = None) -> Drawing | None:
    """Draw time over the chunk, a curve a series, beside the published ones; ring the published choice."""
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    summary = summarise(join_replicates(times), ["series", "x"])
    published = data.published.experiment(experiment).rename(columns={"seconds": "median"})
    shades = colours(times) | COLOURS
    tables = [summary] if published.empty else [summary, published]
    figure, axes = new_figure(2.7, columns=len(tables))
    ends = [_panel(one, table, table is summary, shades) for one, table in zip(axes, tables, strict=True)]
    look: Any = {"markersize": 9, "markerfacecolor": "none", "color": INK, "linewidth": 0.8}
    for one, table in zip(axes, tables, strict=True) if chosen else ():
        point = table[[choice == chosen for choice in zip(table["series"], table["x"], strict=True)]]
        one.plot(point["x"], point["median"], "o", **look)
    axes[0].set(ylabel="time of the steps, s", title="measured")
    if not published.empty:
        axes[1].set(ylabel="time of the process, s", title="published")
        _same_relative_range(axes[0], axes[1], summary["median"].median(), published["median"].median())
    for one, labels in zip(axes, ends, strict=True):
        label_ends(one, labels)
    return Drawing(figure, opening(times, subject) + _sentences(summary, published, chosen))


def _panel(axes: Axes, table: pd.DataFrame, ours: bool, shades: Mapping[str, str]) -> list[Label]:
    """Draw the curves; return the labels of their ends."""
    ends = []
    for kind, rows in table.sort_values("x").groupby("series"):
        colour = shades.get(str(kind), INK)
        if ours:
            curve(axes, rows, colour, aside=ASIDE.get(str(kind), 1.0))
        else:
            published_curve(axes, rows["x"].to_list(), rows["median"].to_list(), colour)
        ends.append((str(kind), float(rows["median"].iloc[-1]), colour if ours else lighten(colour, 0.35)))
    axes.set(xscale="log", xlabel="chunk")
    within = table["x"].min(), table["x"].max()
    plain_ticks(axes.xaxis, [tick for tick in TICKS if within[0] <= tick <= within[1]] or within)
    axes.minorticks_off()
    return ends


def _same_relative_range(left: Axes, right: Axes, ours: float, theirs: float) -> None:
    """Give both panels the same range relative to the median of their points."""
    ends = [end / ours for end in left.get_ylim()] + [end / theirs for end in right.get_ylim()]
    low, high = min(ends), max(ends)
    left.set_ylim(low * ours, high * ours)
    right.set_ylim(low * theirs, high * theirs)


def _sentences(summary: pd.DataFrame, published: pd.DataFrame, chosen: Choice | None) -> str:
    best = summary.loc[summary["median"].idxmin()]
    said = f" Least measured median: {best['series']} with chunk {exact(best['x'])}, {interval_of(best)} s."
    if chosen is not None:
        said += f" Ringed: {chosen[0]} with chunk {chosen[1]}, the published choice."
    if not published.empty:
        theirs = published.loc[published["median"].idxmin()]
        said += (
            f" The least published time is {number(theirs['median'])} s, {theirs['series']} with chunk "
            f"{exact(theirs['x'])}. Both panels span the same range relative to the median of their points."
        )
    return said
