"""Time over one swept parameter, with the published series on an axis of its own, scaled to the same
median.
"""

from collections.abc import Callable

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.captions import growth_sentence, opening, time_axis
from analysis.figures.curves import colours, curve, published_curve
from analysis.figures.hover import Told, tell
from analysis.figures.style import (
    BLUE,
    FAINT,
    GREEN,
    Data,
    Drawing,
    from_zero,
    key,
    lighten,
    new_figure,
    plain_ticks,
)
from analysis.statistics.bootstrap import summarise
from analysis.support.wording import exact, number

SAME_RANGE = 0.75


def density(data: Data) -> Drawing | None:
    """Draw time and pair resolves over the area fraction of the discs; the published study has no such
    sweep.
    """
    times = data.study.times_of("density")
    if times.empty:
        return None
    figure, (left, right) = new_figure(2.6, columns=2)
    summary = summarise(times, ["x"])
    curve(left, summary, BLUE)
    left.set(xlabel="area fraction of the discs, N π r² / L²", ylabel="time of the steps, s")
    from_zero(left)
    runs = data.study.runs_of("density")
    resolves = (runs["pair_resolves"] / (runs["particles"] * runs["steps"])).groupby(runs["x"]).median()
    (line,) = right.plot(resolves.index, resolves, color=GREEN, marker="o")
    tell(line, [Told("", exact(float(str(x))), number(count)) for x, count in resolves.items()])
    right.set(xlabel="area fraction of the discs, N π r² / L²", ylabel="pair resolves per disc and step")
    from_zero(right)
    return Drawing(
        figure, opening(times, "Time over the area fraction of the discs") + growth_sentence(times)
    )


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
    for series, part in summary.groupby("series"):
        curve(axes, part, shades[str(series)])
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
