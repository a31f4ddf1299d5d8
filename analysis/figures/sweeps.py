"""Time over one swept parameter, and below it ratios: to one of its points, the published ones on the same
axis, or to another series at the same point.
"""

from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.derived.comparisons import PUBLISHED, differences, differences_from, reference, stated
from analysis.derived.ladder import per_disc_step, speed_up
from analysis.figures.captions import differing, growth_sentence, minimum_sentence, opening, time_axis
from analysis.figures.curves import curve, curves, line, published_curve, ratio_axis, ratio_curve
from analysis.figures.hover import Told
from analysis.figures.labels import from_zero, label_ends, logarithmic_ticks, plain_ticks
from analysis.figures.style import (
    BLUE,
    FAINT,
    GREEN,
    Data,
    Drawing,
    Look,
    lighten,
    looks,
    new_figure,
    new_grid,
)
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import log_ratios, ratios_of
from analysis.statistics.verdicts import error_of_picked, judge_one
from analysis.support.wording import exact, interval_of, number

SAME_RANGE = 0.75
GRID_LENGTH, OVER_GRID_LENGTH = "grid_length", "Time over the side length"


def density(data: Data) -> Drawing | None:
    """Draw time and pair resolves over the area fraction of the discs, which the study did not sweep."""
    times = data.study.times_of("density")
    if times.empty:
        return None
    figure, (left, right) = new_figure(2.6, columns=2)
    summary = summarise(times, ["x"])
    curve(left, summary, Look(BLUE))
    left.set_ylabel("time of the steps, s")
    runs = data.study.runs_of("density")
    resolves = (runs["pair_resolves"] / (runs["particles"] * runs["steps"])).groupby(runs["x"]).median()
    told = [Told("", exact(float(str(x))), number(count)) for x, count in resolves.items()]
    line(right, resolves.index.to_series(), resolves, Look(GREEN), told)
    right.set_ylabel("pair resolves per disc and step")
    for axes in (left, right):
        axes.set_xlabel("area fraction of the discs, N π r² / L²")
        from_zero(axes)
    caption = opening(times, "Time over the area fraction of the discs") + growth_sentence(times)
    return Drawing(figure, caption)


def trend(
    data: Data,
    experiment: str,
    subject: str,
    label: str | None = None,
    describe: Callable[[pd.DataFrame], str] = growth_sentence,
) -> Drawing | None:
    """Draw time over x, a curve a series, and below it ratios: of several series to the reference at the same
    x, of a single one to its own time at one x, with the published series on the same axis. `label` names x.
    """
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    shown = looks(sorted(times["series"].unique()))
    figure, (above, below) = stacked(label or times["x_name"].iloc[0].replace("_", " "))
    ends = curves(above, summarise(times, ["series", "x"]), shown)
    above.set_ylabel(time_axis(times))
    from_zero(above)
    plain_ticks(above.xaxis)
    if len(shown) > 1:
        label_ends(above, ends)
        said = "".join(f" {series}:{describe(part)}" for series, part in times.groupby("series"))
        return Drawing(figure, opening(times, subject) + said + against_reference(below, times, shown))
    published = data.published.experiment(experiment)
    ratios = _against_own(below, times, published, next(iter(shown.values())))
    caption = opening(times, subject) + describe(data.published.without_degenerate(experiment, times))
    if set(times["x"]) & set(data.published.degenerate.get(experiment, ())):
        caption += " At its degenerate end, which is no part of that, all discs start with one velocity."
    return Drawing(figure, caption + ratios)


def stacked(label: str, height: float = 3.7) -> tuple[Figure, tuple[Axes, Axes]]:
    """Return a figure with the axes of the times above those of the ratios, over the x that `label` names."""
    figure, [[above], [below]] = new_grid(height, 2, sharex=True, height_ratios=[1.0, 1.25])
    below.set_xlabel(label)
    return figure, (above, below)


def against_reference(axes: Axes, times: pd.DataFrame, shown: Mapping[str, Look]) -> str:
    """Draw the ratio of each series to the reference at the same x; say what it shows."""
    against = reference(times)
    table = differences(times, against)
    ratio_axis(axes, table, against, stated(times).margin)
    labels = []
    for series, part in table.groupby("series"):
        look = shown[str(series)]
        ratio_curve(axes, part, look)
        labels.append((str(series), _last(part), look.colour))
    label_ends(axes, labels)
    return (
        f" Below: ratios to {against} at the same x, of pairs within blocks, with the intervals that "
        "decide. The margin is shaded."
    )


def _against_own(axes: Axes, times: pd.DataFrame, published: pd.DataFrame, look: Look) -> str:
    """Draw the ratios of one series to its time at one x, the published ones beside them; say which."""
    at = level_of(times, published)
    own = pd.DataFrame([{"x": at, "ratio": 1.0, "low": 1.0, "high": 1.0}])
    table = pd.concat([differences_from(times, times["x"] == at), own], ignore_index=True)
    at_theirs = at if at in set(published["x"]) else float(published["x"].min())
    theirs = published_ratios(published, published["x"] == at_theirs)
    ratio_axis(axes, pd.concat([table, theirs]), f"that at {exact(at)}", stated(times).margin)
    ratio_curve(axes, table, look)
    said = (
        f" Below: ratios to the time at {exact(at)}, of pairs within blocks, with the intervals that decide."
    )
    if theirs.empty:
        return said
    beside = axes
    if not ranges_agree(times["x"], published["x"]):
        beside = axes.twiny()
        beside.spines["top"].set_visible(True)
        beside.tick_params(axis="x", colors=FAINT)
        beside.set_xlabel("published", color=FAINT, fontsize=7)
    published_curve(beside, theirs["x"], theirs["ratio"], look)
    plain_ticks(beside.xaxis)
    ends = (("measured", table, look.colour), ("published", theirs, lighten(look.colour, 0.35)))
    label_ends(axes, [(name, _last(part), colour) for name, part, colour in ends])
    return f"{said} Lighter: the published ratios on the same axis, to the time at {exact(at_theirs)}."


def _last(table: pd.DataFrame) -> float:
    return float(table.loc[table["x"].idxmax(), "ratio"])


def level_of(times: pd.DataFrame, published: pd.DataFrame) -> float:
    """Return the x that others are compared with, whatever was measured: where the published time is least,
    if both sweeps cover much the same range, or the smallest one.
    """
    if not published.empty and ranges_agree(times["x"], published["x"]):
        least = float(published.loc[published["seconds"].idxmin(), "x"])
        if least in set(times["x"]):
            return least
    return float(times["x"].min())


def published_ratios(published: pd.DataFrame, chosen: pd.Series) -> pd.DataFrame:
    """Return the published times as ratios to the one chosen, without intervals; none where none is."""
    level = published.loc[chosen, "seconds"]
    ratio = published["seconds"] / (level.iloc[0] if len(level) else np.nan)
    return published.assign(ratio=ratio, low=np.nan, high=np.nan).dropna(subset="ratio")


def ranges_agree(ours: pd.Series, published: pd.Series) -> bool:
    """Tell whether the two sweeps cover much the same range, so that one axis serves both."""
    shared = min(ours.max(), published.max()) - max(ours.min(), published.min())
    return bool(shared >= SAME_RANGE * (published.max() - published.min()))


def row(data: Data) -> Drawing | None:
    """Draw alternate rows against the checkered pattern over scene size: time per disc, paired ratio."""
    times = data.study.times_of("row")
    if times.empty:
        return None
    shown = looks(sorted(times["series"].unique()))
    figure, (above, below) = stacked("discs")
    summary = summarise(per_disc_step(times), ["series", "x"], value="nanoseconds")
    label_ends(above, curves(above, summary, shown))
    above.set(xscale="log", ylabel="time per disc\nand step, ns")
    from_zero(above)
    against = reference(times)
    table = differences(times, against)
    sizes = [f"{exact(x)} discs" for x in table["x"]]
    said = differing(sizes, table)
    caption = (
        opening(times, "Alternate rows against the checkered pattern, over scene size at one density")
        + f" Time of row against {against}: {said} (Holm-corrected)."
        + against_reference(below, times, shown)
        + " The published study states that row wins on large scenes, without a number."
    )
    for axes in (above, below):
        plain_ticks(axes.xaxis)
    names = [f"{name} against {against}, {size}" for name, size in zip(table["series"], sizes, strict=True)]
    return Drawing(figure, caption, table.assign(name=names))


def grid_length(data: Data) -> Drawing | None:
    """Draw time per disc and step over the side length, on logarithmic axes so that both ends can be read."""
    times = data.study.times_of(GRID_LENGTH)
    if times["series"].nunique() < 2:
        return trend(data, GRID_LENGTH, OVER_GRID_LENGTH, "side length", minimum_sentence)
    summary = summarise(per_disc_step(times), ["series", "x"], value="nanoseconds")
    shown = looks(sorted(times["series"].unique()))
    figure, (above, below) = stacked("side length", 4.2)
    above.set(xscale="log", yscale="log", ylabel="time per disc and step, ns")
    labels = curves(above, summary, shown)
    logarithmic_ticks(above.yaxis)
    published = data.published.experiment(GRID_LENGTH)
    ours = summary[summary["series"].isin(published["series"])]
    caption = opening(times, OVER_GRID_LENGTH) + _sentences(times)
    if not ours.empty and ranges_agree(ours["x"], published["x"]):
        labels.append(_published_moved(above, ours, published, shown))
        caption += " Lighter: the published series, its times moved so that its median is level with ours."
    label_ends(above, labels)
    caption += against_reference(below, times, shown)
    plain_ticks(below.xaxis, _far_apart(summary["x"]))
    return Drawing(figure, caption)


def _far_apart(x: pd.Series) -> list[float]:
    """Return the largest value and smaller ones so far apart that their names fit a logarithmic axis."""
    kept: list[float] = []
    for value in sorted(x.unique(), reverse=True):
        if not kept or value < kept[-1] / 1.35:
            kept.append(float(value))
    return kept


def _published_moved(
    axes: Axes, ours: pd.DataFrame, published: pd.DataFrame, shown: Mapping[str, Look]
) -> tuple[str, float, str]:
    """Draw the published curve moved to the median of ours; return its label."""
    factor = ours["median"].median() / published["seconds"].median()
    moved = published["seconds"] * factor
    look = shown[str(ours["series"].iloc[0])]
    published_curve(axes, published["x"], moved, look)
    said = f"as published, {number(published['seconds'].iloc[-1])} s"
    return said, float(moved.iloc[-1]), lighten(look.colour, 0.4)


def _sentences(times: pd.DataFrame) -> str:
    """Say of each series how the time changes, and by how much each is faster than the published one."""
    first = times[times["variant"] == PUBLISHED]
    said = []
    for series, part in times.groupby("series"):
        if len(first) and part["variant"].iloc[0] == PUBLISHED:
            said.append(f" {series}:{minimum_sentence(times[times['series'] == series])}")
            continue
        said.append(f" {series}:{_flatness(part)}{_against(first, part)}")
    return "".join(said)


def _flatness(processes: pd.DataFrame) -> str:
    """Say how far the times of a series are apart from its second x on: the first is the dense spike."""
    curve_of = processes.groupby("x")["steps_seconds"].median().sort_index()
    rest = curve_of.iloc[1:]
    if len(rest) < 2:
        return ""
    ratios = ratios_of(processes, "x", rest.idxmin(), rest.idxmax())["log_ratio"]
    row = judge_one(ratios, error=error_of_picked(len(rest)))
    return (
        f" From {exact(rest.index[0])} on, the greatest time (at {exact(rest.idxmax())}) is "
        f"{interval_of(row, 'ratio')} times the least (at {exact(rest.idxmin())})."
    )


def _against(first: pd.DataFrame, processes: pd.DataFrame) -> str:
    """Say by how much a series is faster than the published one at the smallest and the largest shared x."""
    shared = sorted(set(first["x"]) & set(processes["x"]))
    if not shared:
        return ""
    said = []
    for x in dict.fromkeys((shared[0], shared[-1])):
        row = judge_one(log_ratios(first[first["x"] == x], processes[processes["x"] == x])["log_ratio"])
        said.append(f"{speed_up(row)} at {exact(x)}")
    return f" It is faster than the published variant by {' and '.join(said)}."
