"""Time over one swept parameter, and below it ratios: to one of its points, the published ones on the same
axis, or to another series at the same point. Schedules over their chunks are swept so, too.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.derived.comparisons import PUBLISHED, differences, differences_from, reference, stated
from analysis.derived.ladder import per_disc_step, speed_up
from analysis.figures.captions import differing, growth_sentence, minimum_sentence, opening, time_axis
from analysis.figures.kinds import curve, ends_of, line, published_curve, ratio_axis, ratio_curve
from analysis.figures.labels import from_zero, label_ends, logarithmic_ticks, plain_ticks
from analysis.figures.style import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    Data,
    Drawing,
    Look,
    lighten,
    looks,
    new_figure,
    new_grid,
)
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import join_replicates, log_ratios, ratios_of
from analysis.statistics.verdicts import error_of_picked, judge_one
from analysis.support.wording import exact, interval_of, number

SAME_RANGE = 0.75
GRID_LENGTH, OVER_GRID_LENGTH = "grid_length", "Time over the side length"

ASIDE = {"dynamic": 0.985, "static": 1.015}
"""How far the curve of a schedule is moved aside, so that intervals at one chunk do not cover each other."""
CHUNKS = [1, 2, 3, 5, 10, 20, 40, 80, 160, 320, 640, 1280]

DECIDES = "of pairs within blocks, with the intervals that decide."


def density(data: Data) -> Drawing | None:
    """Draw time and pair resolves over the area fraction of the discs, which the study did not sweep."""
    times = data.study.times_of("density")
    if times.empty:
        return None
    figure, (left, right) = new_figure(2.6, columns=2)
    curve(left, summarise(times, ["x"]), Look(BLUE))
    left.set_ylabel("time of the steps, s")
    runs = data.study.runs_of("density")
    resolves = (runs["pair_resolves"] / (runs["particles"] * runs["steps"])).groupby(runs["x"]).median()
    line(right, resolves.index, resolves, Look(GREEN), "")
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
    label = label or times["x_name"].iloc[0].replace("_", " ")
    if times["series"].nunique() > 1:
        said = "".join(f" {series}:{describe(part)}" for series, part in times.groupby("series"))
        return _several(times, label, opening(times, subject) + said)
    figure, (above, below) = stacked(label)
    (look,) = looks(times["series"].unique()).values()
    curve(above, summarise(times, ["series", "x"]), look)
    above.set_ylabel(time_axis(times))
    from_zero(above)
    plain_ticks(above.xaxis)
    caption = opening(times, subject) + describe(data.published.without_degenerate(experiment, times))
    if set(times["x"]) & set(data.published.degenerate.get(experiment, ())):
        caption += " At its degenerate end, which is no part of that, all discs start with one velocity."
    return Drawing(figure, caption + _against_own(below, times, data.published.experiment(experiment), look))


def _several(times: pd.DataFrame, label: str, caption: str, scale: str = "", more: Any = None) -> Drawing:  # noqa: ANN401
    """Draw the times of several series, with what `more` there is, above their ratios to the reference. They
    are per disc and step where a `scale` names the axes that are logarithmic.
    """
    shown, height = looks(sorted(times["series"].unique())), 4.2 if scale == "xy" else 3.7
    figure, (above, below) = stacked(label, height)
    value = "nanoseconds" if scale else "steps_seconds"
    summary = summarise(per_disc_step(times) if scale else times, ["series", "x"], value=value)
    for series, part in summary.groupby("series"):
        curve(above, part, shown[str(series)])
    ends = ends_of(summary, shown, "median")
    above.set_ylabel("time per disc\nand step, ns" if scale else time_axis(times))
    above.set(xscale="log" if "x" in scale else "linear", yscale="log" if "y" in scale else "linear")
    if "y" in scale:
        logarithmic_ticks(above.yaxis)
    else:
        from_zero(above)
    ends += more(above, summary, shown) if more else []
    label_ends(above, ends)
    against = reference(times)
    table = differences(times, against)
    ratio_axis(below, table, against, stated(times).margin)
    for series, part in table.groupby("series"):
        ratio_curve(below, part, shown[str(series)])
    if len(table):
        label_ends(below, ends_of(table, shown, "ratio"))
    plain_ticks(below.xaxis, _far_apart(summary["x"]) if "y" in scale else None)
    said = f" Below: ratios to {against} at the same x, {DECIDES} The margin is shaded."
    return Drawing(figure, caption + said, table if scale == "x" else None)


def stacked(label: str, height: float = 3.7) -> tuple[Figure, tuple[Axes, Axes]]:
    """Return a figure with the axes of the times above those of the ratios, over the x that `label` names."""
    figure, [[above], [below]] = new_grid(height, 2, sharex=True, height_ratios=[1.0, 1.25])
    below.set_xlabel(label)
    return figure, (above, below)


def _against_own(axes: Axes, times: pd.DataFrame, published: pd.DataFrame, look: Look) -> str:
    """Draw the ratios of one series to its time at one x, the published ones beside them; say which."""
    at = level_of(times, published)
    own = pd.DataFrame([{"x": at, "ratio": 1.0, "low": 1.0, "high": 1.0}])
    table = pd.concat([differences_from(times, times["x"] == at), own], ignore_index=True)
    at_theirs = at if at in set(published["x"]) else float(published["x"].min())
    theirs = published_ratios(published, published["x"] == at_theirs)
    ratio_axis(axes, pd.concat([table, theirs]), f"that at {exact(at)}", stated(times).margin)
    ratio_curve(axes, table.assign(series=times["series"].iloc[0]), look)
    said = f" Below: ratios to the time at {exact(at)}, {DECIDES}"
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
    both = pd.concat([table.assign(series="measured"), theirs.assign(series="published")])
    shown = {"measured": look, "published": look._replace(colour=lighten(look.colour, 0.35))}
    label_ends(axes, ends_of(both.reset_index(), shown, "ratio"))
    return f"{said} Lighter: the published ratios on the same axis, to the time at {exact(at_theirs)}."


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
    subject = "Alternate rows against the checkered pattern, over scene size at one density"
    drawn = _several(times, "discs", "", "x")
    assert drawn.verdicts is not None
    table, against = drawn.verdicts, reference(times)
    sizes = [f"{exact(x)} discs" for x in table["x"]]
    said = f" Time of row against {against}: {differing(sizes, table)} (Holm-corrected).{drawn.caption}"
    beside = " The published study states that row wins on large scenes, without a number."
    names = [f"{name} against {against}, {size}" for name, size in zip(table["series"], sizes, strict=True)]
    return Drawing(drawn.figure, opening(times, subject) + said + beside, table.assign(name=names))


def grid_length(data: Data) -> Drawing | None:
    """Draw time per disc and step over the side length, on logarithmic axes so that both ends can be read."""
    times = data.study.times_of(GRID_LENGTH)
    if times["series"].nunique() < 2:
        return trend(data, GRID_LENGTH, OVER_GRID_LENGTH, "side length", minimum_sentence)
    published = data.published.experiment(GRID_LENGTH)
    ours = times[times["series"].isin(published["series"])]
    caption = opening(times, OVER_GRID_LENGTH) + _sentences(times)
    if ours.empty or not ranges_agree(ours["x"], published["x"]):
        return _several(times, "side length", caption, "xy")

    def moved(axes: Axes, summary: pd.DataFrame, shown: Mapping[str, Look]) -> list[tuple[str, float, str]]:
        series = summary[summary["series"].isin(published["series"])]
        seconds = published["seconds"] * (series["median"].median() / published["seconds"].median())
        look = shown[str(series["series"].iloc[0])]
        published_curve(axes, published["x"], seconds, look)
        said = f"as published, {number(published['seconds'].iloc[-1])} s"
        return [(said, float(seconds.iloc[-1]), lighten(look.colour, 0.4))]

    caption += " Lighter: the published series, its times moved so that its median is level with ours."
    return _several(times, "side length", caption, "xy", moved)


def _far_apart(x: pd.Series) -> list[float]:
    """Return the largest value and smaller ones so far apart that their names fit a logarithmic axis."""
    kept: list[float] = []
    for value in sorted(x.unique(), reverse=True):
        if not kept or value < kept[-1] / 1.35:
            kept.append(float(value))
    return kept


def _sentences(times: pd.DataFrame) -> str:
    """Say of each series how the time changes, and by how much each is faster than the published one."""
    first = times[times["variant"] == PUBLISHED]

    def told(part: pd.DataFrame) -> str:
        is_published = part["variant"].iloc[0] == PUBLISHED
        return minimum_sentence(part) if is_published else _flatness(part) + _against(first, part)

    return "".join(f" {series}:{told(part)}" for series, part in times.groupby("series"))


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
    ends = {
        x: log_ratios(first[first["x"] == x], processes[processes["x"] == x]) for x in (shared[0], shared[-1])
    }
    said = (f"{speed_up(judge_one(ratios['log_ratio']))} at {exact(x)}" for x, ratios in ends.items())
    return f" It is faster than the published variant by {' and '.join(said)}."


Choice = tuple[str, float]
"""A schedule and its chunk."""


def schedule(data: Data, experiment: str, subject: str, chosen: Choice | None = None) -> Drawing | None:
    """Draw the ratio to the published choice over the chunk, a curve a kind of schedule, beside the published
    ones on the same axis, and the times small below; the choice is ringed. Where it was not measured the
    ratios are to the smallest chunk of the reference.
    """
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    summary = summarise(join_replicates(times), ["series", "x"])
    published = data.published.experiment(experiment)
    first = reference(times)
    against = first, float(times.loc[times["series"] == first, "x"].min())
    if chosen is not None and _is(times, chosen).any():
        against = chosen
    named = f"{against[0]} with chunk {exact(against[1])}"
    # That of the reference to itself has no interval.
    own = pd.DataFrame([{"series": against[0], "x": against[1], "ratio": 1.0}])
    ours = pd.concat([differences_from(times, _is(times, against)), own], ignore_index=True)
    theirs = published_ratios(published, _is(published, against))
    shown = looks(sorted({*times["series"], *published["series"]}))
    sides: Sequence[tuple[str, pd.DataFrame, pd.DataFrame]] = [
        ("measured", ours, summary), *([("published", theirs, published)] if len(theirs) else []),
    ]  # fmt: skip
    figure, grid = new_grid(3.7, 2, len(sides), sharex="col", height_ratios=[2.0, 1.0])
    for (upper, lower), (title, ratios, seconds) in zip(grid.T, sides, strict=True):
        ratio_axis(upper, pd.concat([ours, theirs]), named, stated(times).margin)
        _over_chunks(upper, lower, ratios, seconds, shown)
        at = ratios[_is(ratios, against)]
        upper.plot(at["x"], at["ratio"], "o", color=INK, markersize=9, markerfacecolor="none", linewidth=0.8)
        upper.set_title(title)
    grid[1][0].set_ylabel("time of\nthe steps, s")
    if len(theirs):
        grid[0][1].set_ylabel("")
        grid[1][1].set_ylabel("time of the\nprocess, s")
    said = _of_schedules(summary, published, named, is_chosen=against == chosen)
    return Drawing(figure, opening(times, subject) + said)


def _is(table: pd.DataFrame, choice: Choice) -> pd.Series:
    return (table["series"] == choice[0]) & (table["x"] == choice[1])


def _over_chunks(
    upper: Axes, lower: Axes, ratios: pd.DataFrame, seconds: pd.DataFrame, shown: Mapping[str, Look]
) -> None:
    """Draw the ratios on an axis that is settled, with names at their ends, and the times themselves."""
    published = "seconds" in seconds
    upper.set_xscale("log")
    for kind, look in shown.items():
        own, times = (table[table["series"] == kind].sort_values("x") for table in (ratios, seconds))
        if published:
            published_curve(upper, own["x"], own["ratio"], look)
            published_curve(lower, times["x"], times["seconds"], look)
        else:
            ratio_curve(upper, own, look, ASIDE.get(kind, 1.0))
            curve(lower, times, look, aside=ASIDE.get(kind, 1.0))
    upper.tick_params(labelbottom=False)
    ends = ends_of(ratios, shown, "ratio")
    label_ends(upper, [(name, y, lighten(ink, 0.35) if published else ink) for name, y, ink in ends])
    lower.set_xlabel("chunk")
    within = seconds["x"].min(), seconds["x"].max()
    plain_ticks(lower.xaxis, [tick for tick in CHUNKS if within[0] <= tick <= within[1]] or within)
    lower.minorticks_off()


def _of_schedules(summary: pd.DataFrame, published: pd.DataFrame, named: str, *, is_chosen: bool) -> str:
    (best,) = summary.loc[[summary["median"].idxmin()]].itertuples()
    said = (
        f" Least measured median: {best.series} with chunk {exact(best.x)}, {interval_of(best)} s."
        f" The upper panels show ratios to {named} (ringed{', the published choice' if is_chosen else ''}). "
        "They are of pairs within blocks, with the intervals that decide. The margin is shaded."
    )
    if published.empty:
        return said
    theirs = published.loc[published["seconds"].idxmin()]
    return (
        f"{said} The least published time is {number(theirs['seconds'])} s, {theirs['series']} with chunk "
        f"{exact(theirs['x'])}. Published ratios stand on the same axis."
    )
