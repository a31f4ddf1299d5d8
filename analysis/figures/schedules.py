"""Time over the chunk against that of one schedule and chunk, a curve a kind of schedule; the published
study's appendix beside it on the same axis, and the times small below.
"""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.derived.comparisons import differences_from, reference, stated
from analysis.figures.captions import opening
from analysis.figures.curves import curve, published_curve, ratio_band, ratio_curve, reach
from analysis.figures.labels import label_ends, percent_ticks, plain_ticks
from analysis.figures.style import INK, WIDTH, Data, Drawing, Look, lighten, looks
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import join_replicates
from analysis.support.wording import exact, interval_of, number

Choice = tuple[str, float]
Label = tuple[str, float, str]

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
    published = data.published.experiment(experiment).rename(columns={"seconds": "median"})
    against = _against(times, chosen)
    ours = _with_reference(differences_from(times, _is(times, against)), against)
    theirs = _published_ratios(published, against)
    margin = stated(times).margin
    shown = looks(sorted({*times["series"], *published["series"]}))
    figure, panels = _panels(2 if len(theirs) else 1)
    within = reach(pd.concat([ours, theirs]), margin)
    for axes, table in zip(panels[0], (ours, theirs), strict=False):
        labels = _ratios(axes, table, shown, table is ours, within, margin)
        at = table[_is(table, against)]
        axes.plot(at["x"], at["ratio"], "o", color=INK, markersize=9, markerfacecolor="none", linewidth=0.8)
        label_ends(axes, labels)
    said = f"{against[0]} with chunk {exact(against[1])}"
    panels[0][0].set(ylabel=f"time against\n{said}, %", title="measured")
    for axes, table in zip(panels[1], (summary, published), strict=False):
        _times(axes, table, shown, table is summary)
    panels[1][0].set_ylabel("time of\nthe steps, s")
    if len(theirs):
        panels[0][1].set_title("published")
        panels[1][1].set_ylabel("time of the\nprocess, s")
    return Drawing(figure, opening(times, subject) + _sentences(summary, published, against, chosen))


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


def _published_ratios(published: pd.DataFrame, against: Choice) -> pd.DataFrame:
    """Return the published ratios, which have no interval; none where the reference was not published."""
    level = published.loc[_is(published, against), "median"]
    ratios = published["median"] / (level.iloc[0] if len(level) else float("nan"))
    return published.assign(ratio=ratios, low=float("nan"), high=float("nan")).dropna(subset="ratio")


def _panels(columns: int) -> tuple[Figure, Any]:
    """Return two rows of axes, the upper one higher."""
    figure = Figure(figsize=(WIDTH, 3.7))
    grid: Any = {"height_ratios": [2.0, 1.0]}
    return figure, figure.subplots(2, columns, squeeze=False, sharex="col", gridspec_kw=grid)


def _ratios(
    axes: Axes, table: pd.DataFrame, shown: Mapping[str, Look], ours: bool, within: tuple[float, float],
    margin: float,
) -> list[Label]:  # fmt: skip
    """Draw the ratios; return the labels of their ends."""
    ends = []
    axes.set_ylim(*within)
    ratio_band(axes, margin)
    for kind, rows in table.sort_values("x").groupby("series"):
        look = shown[str(kind)]
        if ours:
            ratio_curve(axes, rows, look, within, ASIDE.get(str(kind), 1.0))
        else:
            published_curve(axes, rows["x"].to_list(), rows["ratio"].to_list(), look)
        colour = look.colour if ours else lighten(look.colour, 0.35)
        ends.append((str(kind), float(rows["ratio"].iloc[-1]), colour))
    axes.set_xscale("log")
    percent_ticks(axes.yaxis)
    axes.tick_params(labelbottom=False)
    return ends


def _times(axes: Axes, table: pd.DataFrame, shown: Mapping[str, Look], ours: bool) -> None:
    """Draw the times themselves, small."""
    for kind, rows in table.sort_values("x").groupby("series"):
        if ours:
            curve(axes, rows, shown[str(kind)], aside=ASIDE.get(str(kind), 1.0))
        else:
            published_curve(axes, rows["x"].to_list(), rows["median"].to_list(), shown[str(kind)])
    axes.set_xlabel("chunk")
    within = table["x"].min(), table["x"].max()
    plain_ticks(axes.xaxis, [tick for tick in TICKS if within[0] <= tick <= within[1]] or within)
    axes.minorticks_off()


def _sentences(summary: pd.DataFrame, published: pd.DataFrame, against: Choice, chosen: Choice | None) -> str:
    best = summary.loc[summary["median"].idxmin()]
    said = f" Least measured median: {best['series']} with chunk {exact(best['x'])}, {interval_of(best)} s."
    ringed = "ringed, the published choice" if against == chosen else "ringed"
    said += (
        f" The upper panels show ratios to {against[0]} with chunk {exact(against[1])} ({ringed}). They are "
        "of pairs within blocks, with the intervals that decide. The margin is shaded."
    )
    if not published.empty:
        theirs = published.loc[published["median"].idxmin()]
        said += (
            f" The least published time is {number(theirs['median'])} s, {theirs['series']} with chunk "
            f"{exact(theirs['x'])}. Published ratios stand on the same axis."
        )
    return said
