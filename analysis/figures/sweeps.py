"""Time over one swept parameter, the published series on an axis of its own, scaled to the same median; and
over the side length with the discs fixed, where the published variant pays for empty space.
"""

from collections.abc import Callable

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.comparisons import PUBLISHED
from analysis.derived.ladder import per_disc_step, speed_up
from analysis.figures.captions import growth_sentence, minimum_sentence, opening, time_axis
from analysis.figures.curves import colours, curve, curves, published_curve
from analysis.figures.hover import Told, tell
from analysis.figures.labels import from_zero, key, label_ends, logarithmic_ticks, plain_ticks
from analysis.figures.style import BLUE, FAINT, GREEN, Data, Drawing, lighten, new_figure
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
    curve(left, summary, BLUE)
    left.set_ylabel("time of the steps, s")
    runs = data.study.runs_of("density")
    resolves = (runs["pair_resolves"] / (runs["particles"] * runs["steps"])).groupby(runs["x"]).median()
    (line,) = right.plot(resolves.index, resolves, color=GREEN, marker="o")
    tell(line, [Told("", exact(float(str(x))), number(count)) for x, count in resolves.items()])
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
    """Draw time over x, a curve a series, with the published series beside a single one; `label` names x."""
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    figure, (axes,) = new_figure(2.9)
    summary = summarise(times, ["series", "x"])
    shades = colours(times)
    curves(axes, summary, shades)
    axes.set(xlabel=label or times["x_name"].iloc[0].replace("_", " "), ylabel=time_axis(times))
    plain_ticks(axes.xaxis)
    from_zero(axes)
    if len(shades) > 1:
        key(axes, [(f"● {series}", colour) for series, colour in shades.items()])
        said = "".join(f" {series}:{describe(part)}" for series, part in times.groupby("series"))
        return Drawing(figure, opening(times, subject) + said)
    published = data.published.experiment(experiment)
    entries, own_x = [("● measured, left axis", BLUE)], False
    if not published.empty:
        own_x = not ranges_agree(summary["x"], published["x"])
        _published_beside(axes, summary, published, own_x)
        entries.append((f"● published, right{' and upper' if own_x else ''} axis", lighten(BLUE, 0.4)))
        key(axes, entries, raised=18 if own_x else 4)
    caption = opening(times, subject) + describe(data.published.without_degenerate(experiment, times))
    if set(times["x"]) & set(data.published.degenerate.get(experiment, ())):
        caption += " At its degenerate end, which is no part of that, all discs start with one velocity."
    if not published.empty:
        caption += " Lighter: the published series on axes of its own, scaled so that both medians are level."
    return Drawing(figure, caption)


def _published_beside(axes: Axes, ours: pd.DataFrame, published: pd.DataFrame, own_x: bool) -> None:
    """Draw the published curve on a right axis whose scale puts its median level with ours; `own_x` names an
    upper axis of its own, for scenes of another size."""
    factor = published["seconds"].median() / ours["median"].median()
    highest = max(axes.get_ylim()[1], 1.05 * published["seconds"].max() / factor)
    axes.set_ylim(0, highest)
    right = axes.twinx()
    right.spines["right"].set_visible(True)
    right.tick_params(axis="y", colors=FAINT)
    right.set_ylabel("time of the process, published, s", color=FAINT)
    target = right
    if own_x:
        target = right.twiny()
        target.spines["top"].set_visible(True)
        target.tick_params(axis="x", colors=FAINT)
        plain_ticks(target.xaxis)
    axes.set_zorder(right.get_zorder() + 1)
    axes.patch.set_visible(False)
    published_curve(target, published["x"].to_list(), published["seconds"].to_list(), BLUE)
    right.set_ylim(0, highest * factor)


def ranges_agree(ours: pd.Series, published: pd.Series) -> bool:
    """Tell whether the two sweeps cover much the same range, so that one axis serves both."""
    shared = min(ours.max(), published.max()) - max(ours.min(), published.min())
    return bool(shared >= SAME_RANGE * (published.max() - published.min()))


def grid_length(data: Data) -> Drawing | None:
    """Draw time per disc and step over the side length, on logarithmic axes so that both ends can be read."""
    times = data.study.times_of(GRID_LENGTH)
    if times["series"].nunique() < 2:
        return trend(data, GRID_LENGTH, OVER_GRID_LENGTH, "side length", minimum_sentence)
    summary = summarise(per_disc_step(times), ["series", "x"], value="nanoseconds")
    shades = colours(times)
    figure, (axes,) = new_figure(3.2)
    axes.set(xscale="log", yscale="log", xlabel="side length", ylabel="time per disc and step, ns")
    labels = curves(axes, summary, shades)
    plain_ticks(axes.xaxis, _far_apart(summary["x"]))
    logarithmic_ticks(axes.yaxis)
    published = data.published.experiment(GRID_LENGTH)
    ours = summary[summary["series"].isin(published["series"])]
    caption = opening(times, OVER_GRID_LENGTH) + _sentences(times)
    if not ours.empty and ranges_agree(ours["x"], published["x"]):
        labels.append(_published_moved(axes, ours, published, shades))
        caption += " Lighter: the published series, its times moved so that its median is level with ours."
    label_ends(axes, labels)
    return Drawing(figure, caption)


def _far_apart(x: pd.Series) -> list[float]:
    """Return the largest value and smaller ones so far apart that their names fit a logarithmic axis."""
    kept: list[float] = []
    for value in sorted(x.unique(), reverse=True):
        if not kept or value < kept[-1] / 1.35:
            kept.append(float(value))
    return kept


def _published_moved(
    axes: Axes, ours: pd.DataFrame, published: pd.DataFrame, shades: dict[str, str]
) -> tuple[str, float, str]:
    """Draw the published curve moved to the median of ours; return its label."""
    factor = ours["median"].median() / published["seconds"].median()
    moved = published["seconds"] * factor
    colour = shades[str(ours["series"].iloc[0])]
    published_curve(axes, published["x"].to_list(), moved.to_list(), colour)
    said = f"as published, {number(published['seconds'].iloc[-1])} s"
    return said, float(moved.iloc[-1]), lighten(colour, 0.4)


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
