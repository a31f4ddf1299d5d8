"""Time over the chunk, one curve a kind of schedule, the published study's appendix beside it."""

from collections.abc import Mapping

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.captions import opening
from analysis.figures.curves import colours, curve, published_curve
from analysis.figures.labels import label_ends
from analysis.figures.style import (
    BLUE,
    GREEN,
    INK,
    VERMILLION,
    Data,
    Drawing,
    lighten,
    new_figure,
    plain_ticks,
)
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import join_replicates
from analysis.support.wording import exact, interval_of, number

Choice = tuple[str, int]

COLOURS = {"guided": BLUE, "dynamic": VERMILLION, "static": GREEN}
ASIDE = {"dynamic": 0.985, "static": 1.015}
"""How far a curve is moved to the side, so that intervals at the same chunk do not cover each other."""

TICKS = [1, 2, 3, 5, 10, 20, 40, 80, 160, 320, 640, 1280]


def schedule(data: Data, experiment: str, subject: str, chosen: Choice | None = None) -> Drawing | None:
    """Draw time over the chunk, a curve a series, the published series beside it if there is one; `chosen`
    is the published choice, which is ringed.
    """
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    summary = summarise(join_replicates(times), ["series", "x"])
    published = data.published.experiment(experiment).rename(columns={"seconds": "median"})
    shades = colours(times) | COLOURS
    tables = [summary] if published.empty else [summary, published]
    figure, axes = new_figure(2.7, columns=len(tables))
    for one, table in zip(axes, tables, strict=True):
        _panel(one, table, table is summary, shades)
        _ring(one, table, chosen)
    axes[0].set(ylabel="time of the steps, s", title="measured")
    if not published.empty:
        axes[1].set(ylabel="time of the process, s", title="published")
        _same_relative_range(axes[0], axes[1], summary["median"].median(), published["median"].median())
    for one, table in zip(axes, tables, strict=True):
        label_ends(one, _ends(table, table is summary, shades))
    return Drawing(figure, opening(times, subject) + _sentences(summary, published, chosen))


def _panel(axes: Axes, table: pd.DataFrame, ours: bool, shades: Mapping[str, str]) -> None:
    for kind, rows in table.groupby("series"):
        colour = shades.get(str(kind), INK)
        if ours:
            curve(axes, rows, colour, aside=ASIDE.get(str(kind), 1.0))
        else:
            rows = rows.sort_values("x")
            published_curve(axes, rows["x"].to_list(), rows["median"].to_list(), colour)
    axes.set(xscale="log", xlabel="chunk")
    within = table["x"].min(), table["x"].max()
    plain_ticks(axes.xaxis, [tick for tick in TICKS if within[0] <= tick <= within[1]] or within)
    axes.minorticks_off()


def _ring(axes: Axes, table: pd.DataFrame, chosen: Choice | None) -> None:
    """Ring the point that the published study chose."""
    if chosen is None:
        return
    point = table[(table["series"] == chosen[0]) & (table["x"] == chosen[1])]
    axes.plot(
        point["x"], point["median"], "o", markersize=9, markerfacecolor="none", color=INK, linewidth=0.8
    )


def _same_relative_range(left: Axes, right: Axes, ours: float, theirs: float) -> None:
    """Give both panels the same range relative to the median of their points."""
    ends = [end / ours for end in left.get_ylim()] + [end / theirs for end in right.get_ylim()]
    low, high = min(ends), max(ends)
    left.set_ylim(low * ours, high * ours)
    right.set_ylim(low * theirs, high * theirs)


def _ends(table: pd.DataFrame, ours: bool, shades: Mapping[str, str]) -> list[tuple[str, float, str]]:
    ends = []
    for kind, rows in table.groupby("series"):
        colour = shades.get(str(kind), INK)
        last = rows.loc[rows["x"].idxmax(), "median"]
        ends.append((str(kind), float(last), colour if ours else lighten(colour, 0.35)))
    return ends


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
