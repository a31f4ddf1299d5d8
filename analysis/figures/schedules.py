"""Time over the chunk against that of one schedule and chunk, a curve a kind of schedule; the published
study's appendix beside it on the same axis, and the times small below.
"""

from collections.abc import Mapping

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.comparisons import differences_from, reference, stated
from analysis.figures.captions import opening
from analysis.figures.curves import curve, published_curve, ratio_axis, ratio_curve
from analysis.figures.labels import label_ends, plain_ticks
from analysis.figures.style import INK, Data, Drawing, Look, lighten, looks, new_grid
from analysis.figures.sweeps import published_ratios
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import join_replicates
from analysis.support.wording import exact, interval_of, number

Choice = tuple[str, float]

ASIDE = {"dynamic": 0.985, "static": 1.015}
"""How far a curve is moved to the side, so that intervals at the same chunk do not cover each other."""

TICKS = [1, 2, 3, 5, 10, 20, 40, 80, 160, 320, 640, 1280]


def schedule(data: Data, experiment: str, subject: str, chosen: Choice | None = None) -> Drawing | None:
    """Draw the ratio to the published choice over the chunk, a curve a series, beside the published ones; the
    choice is ringed. Where it was not measured the ratios are to the smallest chunk of the reference.
    """
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    summary = summarise(join_replicates(times), ["series", "x"])
    published = data.published.experiment(experiment)
    against = _against(times, chosen)
    named = f"{against[0]} with chunk {exact(against[1])}"
    ours = _with_reference(differences_from(times, _is(times, against)), against)
    theirs = published_ratios(published, _is(published, against))
    shown = looks(sorted({*times["series"], *published["series"]}))
    columns = 2 if len(theirs) else 1
    figure, grid = new_grid(3.7, 2, columns, sharex="col", height_ratios=[2.0, 1.0])
    for (upper, lower), table in zip(grid.T, (ours, theirs), strict=False):
        ratio_axis(upper, pd.concat([ours, theirs]), named, stated(times).margin)
        _ratios(upper, table, shown, table is ours)
        at = table[_is(table, against)]
        upper.plot(at["x"], at["ratio"], "o", color=INK, markersize=9, markerfacecolor="none", linewidth=0.8)
        _times(lower, summary if table is ours else published, shown, table is ours)
        upper.set_title("measured" if table is ours else "published")
    grid[1][0].set_ylabel("time of\nthe steps, s")
    if len(theirs):
        grid[0][1].set_ylabel("")
        grid[1][1].set_ylabel("time of the\nprocess, s")
    said = _sentences(summary, published, named, is_chosen=against == chosen)
    return Drawing(figure, opening(times, subject) + said)


def _against(times: pd.DataFrame, chosen: Choice | None) -> Choice:
    if chosen is not None and _is(times, chosen).any():
        return chosen
    series = reference(times)
    return series, float(times.loc[times["series"] == series, "x"].min())


def _is(table: pd.DataFrame, choice: Choice) -> pd.Series:
    return (table["series"] == choice[0]) & (table["x"] == choice[1])


def _with_reference(table: pd.DataFrame, against: Choice) -> pd.DataFrame:
    """Return the ratios with that of the reference to itself, which has no interval."""
    own = {"series": against[0], "x": against[1], "ratio": 1.0}
    return pd.DataFrame([*table.to_dict("records"), own], columns=table.columns)


def _ratios(axes: Axes, table: pd.DataFrame, shown: Mapping[str, Look], ours: bool) -> None:
    """Draw the ratios on an axis that is settled, with names at their ends."""
    ends = []
    for kind, rows in table.sort_values("x").groupby("series"):
        look = shown[str(kind)]
        if ours:
            ratio_curve(axes, rows, look, ASIDE.get(str(kind), 1.0))
        else:
            published_curve(axes, rows["x"], rows["ratio"], look)
        colour = look.colour if ours else lighten(look.colour, 0.35)
        ends.append((str(kind), float(rows["ratio"].iloc[-1]), colour))
    axes.set_xscale("log")
    axes.tick_params(labelbottom=False)
    label_ends(axes, ends)


def _times(axes: Axes, table: pd.DataFrame, shown: Mapping[str, Look], ours: bool) -> None:
    """Draw the times themselves, small."""
    for kind, rows in table.sort_values("x").groupby("series"):
        if ours:
            curve(axes, rows, shown[str(kind)], aside=ASIDE.get(str(kind), 1.0))
        else:
            published_curve(axes, rows["x"], rows["seconds"], shown[str(kind)])
    axes.set_xlabel("chunk")
    within = table["x"].min(), table["x"].max()
    plain_ticks(axes.xaxis, [tick for tick in TICKS if within[0] <= tick <= within[1]] or within)
    axes.minorticks_off()


def _sentences(summary: pd.DataFrame, published: pd.DataFrame, named: str, *, is_chosen: bool) -> str:
    best = summary.loc[summary["median"].idxmin()]
    said = f" Least measured median: {best['series']} with chunk {exact(best['x'])}, {interval_of(best)} s."
    said += (
        f" The upper panels show ratios to {named} (ringed{', the published choice' if is_chosen else ''}). "
        "They are of pairs within blocks, with the intervals that decide. The margin is shaded."
    )
    if not published.empty:
        theirs = published.loc[published["seconds"].idxmin()]
        said += (
            f" The least published time is {number(theirs['seconds'])} s, {theirs['series']} with chunk "
            f"{exact(theirs['x'])}. Published ratios stand on the same axis."
        )
    return said
