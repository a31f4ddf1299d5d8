"""Two variants against each other: the ratio with that of every block, the published one below it on the same
axis, and the times of both beside it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from analysis.derived.comparisons import USUAL, Stated
from analysis.figures.captions import PROCESSES, SCENES, opening, time_axis
from analysis.figures.kinds import forest, line, of_ratio
from analysis.figures.labels import label_ends, note, plain_ticks
from analysis.figures.style import INK, Data, Drawing, Look, lighten, looks, new_figure
from analysis.statistics.pairs import PAIR, log_ratios
from analysis.statistics.verdicts import MARGIN, Ratio, judge_pairs
from analysis.support.values import Floats
from analysis.support.wording import blocks, change, count, exact, percent
from support.vocabulary import COUNTS

MANY = 40
"""Blocks from which their marks are as small as the line."""


Names = Mapping[str, str]
"""The two series compared, the candidate first, each with its name for the reader."""


def pair_drawing(
    data: Data, experiment: str, subject: str, names: Names,
    work: bool = False, by: Stated = USUAL, row: Ratio | None = None,
) -> Drawing | None:  # fmt: skip
    """Draw the ratio of both sides with its verdict, of `row` if it is known, by what the question states.
    Below it is the published one, beside it are the times block by block. With `work` also the attempts at
    resolving a pair that each takes.
    """
    times = data.study.times_of(experiment)
    candidate, reference = (times[times["series"] == name] for name in names)
    if candidate.empty or reference.empty:
        return None
    if work and (times["question_kind"] == COUNTS).all():
        return _of_counts(data, experiment, subject, names)
    theirs = data.published.ratio(experiment, *names)
    # The ratio has most of the room.
    widths = [2.1, 1.0, *([0.9] if theirs else []), *([0.9] if work else [])]
    figure, axes = new_figure(2.3, len(widths), widths)
    # Of several scenes of a sweep, one value a block.
    pairs = log_ratios(reference, candidate, match=("x",)).groupby(PAIR, as_index=False, sort=False)
    pairs = pairs.mean(numeric_only=True)
    row = row or judge_pairs(pairs, by.margin, by.error)
    runs = data.published.experiment(experiment)
    shown, told = _looks(names), list(names.values())
    each = [np.exp(pairs["log_ratio"].to_numpy()), _published_ratios(runs, names)]
    ratio_panel(axes[0], row, theirs, told, by.margin, each)
    both = _one_a_block(times[times["series"].isin(list(names))])
    _times(axes[1], both.assign(name=both["series"].map(names)), "steps_seconds", shown)
    axes[1].set(xlabel="block", ylabel=time_axis(times), title="measured")
    if theirs:
        axes[2].set(xlabel="repetition", ylabel="time of the process, s", title="published")
        runs = runs.assign(name=runs["series"].map(names))
        _times(axes[2], runs, "seconds", shown, published=True)
    if work:
        _work(axes[-1], data, experiment, names)
    dots = SCENES if times["x"].nunique() > 1 else PROCESSES
    said = _sentences(row, theirs, told, by)
    verdicts = pd.DataFrame([{**vars(row), "name": " against ".join(told)}])
    return Drawing(figure, opening(times, subject, dots) + said + lost_by_turns(pairs), verdicts)


def _looks(names: Names) -> dict[str, Look]:
    """Return the look of both by the names that the reader is given."""
    found = looks(reversed(list(names)))
    return {name: found[series] for series, name in names.items()}


def _published_ratios(published: pd.DataFrame, names: Names) -> Floats:
    """Return the ratio of each published repetition of both."""
    runs = published.pivot_table(index="x", columns="series", values="seconds")
    if not set(names) <= set(runs):
        return np.empty(0)
    candidate, reference = (runs[series] for series in names)
    return np.asarray((candidate / reference).dropna(), dtype=float)


def _of_counts(data: Data, experiment: str, subject: str, names: Names) -> Drawing:
    """Draw the attempts alone. They have no verdict here: the claim about them has."""
    figure, axes = new_figure(1.6)
    _work(axes[0], data, experiment, names)
    scenes = data.study.runs_of(experiment)["x"].nunique()
    return Drawing(
        figure,
        f"{subject}: attempts at resolving a pair, and in a stronger shade those that resolved it, of "
        f"one step; the median of {count(scenes, 'scene')}. They were counted in one run each, whose time "
        "is not compared.",
    )


def _one_a_block(processes: pd.DataFrame) -> pd.DataFrame:
    """Return one row a series and block, numbered as `x`, since nodes number theirs alike; where it holds
    several scenes of a sweep, the geometric mean of their times.
    """
    table = np.log(processes["steps_seconds"]).groupby([processes[key] for key in ("series", *PAIR)]).mean()
    both = np.exp(table).reset_index()
    return both.assign(x=1 + both.groupby(PAIR).ngroup())


def _times(
    axes: Axes, runs: pd.DataFrame, value: str, shown: Mapping[str, Look], *, published: bool = False
) -> None:
    """Draw the times of both sides, by `name`, over blocks or repetitions, `x`, small."""
    labels = []
    for name, look in shown.items():
        own = runs[runs["name"] == name].sort_values("x")
        lighter = look._replace(colour=lighten(look.colour)) if published else look
        size = 2.5 if len(own) <= MANY else 1.2
        told = f"{name}, published" if published else name
        line(axes, own["x"], own[value], lighter, told, markersize=size, linewidth=0.8)
        ink = lighten(look.colour, 0.35) if published else look.colour
        labels.append((name.replace(" with ", "\nwith "), own[value].iloc[-1], ink))
    axes.xaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.margins(y=0.15)
    # With one block alone the axis would be too short for a whole number.
    axes.set_xlim(0.5, runs["x"].max() + 0.5)
    label_ends(axes, labels, size=6.5)


def ratio_panel(
    axes: Axes, ours: Ratio, theirs: Ratio | None, names: Sequence[str],
    margin: float = MARGIN, each: Sequence[Floats] = (),
) -> None:  # fmt: skip
    """Draw the ratio as a dot with the interval on which the verdict rests, the published one below it, and
    below either the ratios of `each` of its blocks or runs.
    """
    rows = [("published", theirs, lighten(INK, 0.4))] if theirs else []
    rows.append(("measured", ours, INK))
    dots = []
    for at, (name, row, colour) in enumerate(rows):
        dot = of_ratio(row, at, name, Look(colour))
        # Too few published runs for an interval are no open end: they have no bar at all.
        is_bare = name == "published" and not row.has_interval
        dots.append(replace(dot, low=np.nan, high=np.nan) if is_bare else dot)
        note(
            axes,
            change(row),
            (0.5, at),
            (0, 9),
            xycoords=("axes fraction", "data"),
            ha="center",
            fontsize=7,
            color=colour,
        )
    forest(axes, dots, [f"{name}:\n{row.verdict}" for name, row, _ in rows], margin, width=2.6)
    low, high = axes.get_xlim()
    for (_, _, colour), at, ratios in zip(reversed(rows), reversed(range(len(rows))), each, strict=False):
        blocks = 100 * (ratios - 1)
        blocks = blocks[(blocks > low) & (blocks < high)]
        axes.plot(blocks, np.full(len(blocks), at - 0.24), "|", color=lighten(colour, 0.3), markersize=5)
    axes.set(title="difference", xlabel=f"time of {names[0]} against {names[1]}, %")
    axes.xaxis.set_major_locator(MaxNLocator(6))


def _work(axes: Axes, data: Data, experiment: str, names: Names) -> None:
    """Draw the attempts at resolving a pair, those that resolve it in a stronger shade; medians of scenes."""
    runs = data.study.runs_of(experiment)
    counts = (
        runs[["pair_resolves", "pair_attempts"]].div(runs["steps"], axis=0).groupby(runs["series"]).median()
    )
    shown = _looks(names)
    for height, (series, name) in enumerate(list(names.items())[::-1]):
        colour = shown[name].colour
        resolves, attempts = counts.loc[series]
        counted = not np.isnan(attempts)
        axes.barh(height, attempts if counted else 0, color=lighten(colour, 0.5), height=0.5)
        axes.barh(height, resolves, color=colour, height=0.5)
        said = f"{exact(round(resolves))} of {exact(round(attempts))}" if counted else exact(round(resolves))
        note(axes, f"{name}: {said}", (0, height + 0.27), (0, 2), color=colour, fontsize=7)
    axes.set(yticks=[], xlabel="resolves of attempts per step", title="work", ylim=(-0.6, 1.6))
    axes.xaxis.set_major_locator(MaxNLocator(3))
    plain_ticks(axes.xaxis)
    axes.spines["left"].set_visible(False)


def _sentences(row: Ratio, theirs: Ratio | None, names: Sequence[str], by: Stated) -> str:
    published = f" Published: {change(theirs)} ({theirs.verdict})." if theirs else ""
    return (
        f" The time of {names[0]} is {change(row)} against {names[1]}, from {blocks(row)} "
        f"(paired log ratios): {row.verdict} with a margin of {100 * by.margin:g} % (shaded; "
        f"the bar is the {100 * (1 - by.error):g} % interval, which decides). Each stroke below is the ratio "
        f"of one block.{published}"
    )


def lost_by_turns(pairs: pd.DataFrame) -> str:
    """Say how far cold caches at each turn move the ratio of `pairs` (see `log_ratios`), if it is known."""
    known = pairs["bias"].dropna()
    if known.empty:
        return ""
    moved = percent(float(np.expm1(known.median())), 2)
    return f" Cold caches at each turn move it by {moved}: the interval reaches over both, with and without."
