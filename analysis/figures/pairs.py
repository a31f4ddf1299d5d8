"""Two variants against each other: the ratio with that of every block, the published one below it on the same
axis, and the times of both beside it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from analysis.derived.comparisons import USUAL, Stated
from analysis.figures.captions import PROCESSES, SCENES, opening, time_axis
from analysis.figures.curves import forest, line
from analysis.figures.hover import Told
from analysis.figures.labels import label_ends, name_rows, note, plain_ticks
from analysis.figures.style import INK, Data, Drawing, Look, lighten, looks, new_figure
from analysis.statistics.pairs import PAIR, log_ratios
from analysis.statistics.verdicts import MARGIN, judge_one
from analysis.support.values import Floats
from analysis.support.wording import blocks, change, count, exact, number, percent
from support.vocabulary import COUNTS

MANY = 40
"""Blocks from which their marks are as small as the line."""


@dataclass(frozen=True)
class Sides:
    """The two series compared: their names in the records (`candidate` / `reference`) and for the reader."""

    experiment: str
    candidate: str
    reference: str
    subject: str
    names: tuple[str, str]


def pair_drawing(
    data: Data, sides: Sides, work: bool = False, by: Stated = USUAL, row: dict[str, Any] | None = None
) -> Drawing | None:
    """Draw the ratio of both sides with its verdict, of `row` if it is known, by what the question states.
    Below it is the published one, beside it are the times block by block. With `work` also the attempts at
    resolving a pair that each takes.
    """
    times = data.study.times_of(sides.experiment)
    both = [times[times["series"] == name] for name in (sides.candidate, sides.reference)]
    candidate, reference = map(_one_a_block, both)
    if candidate.empty or reference.empty:
        return None
    if work and (times["question_kind"] == COUNTS).all():
        return _of_counts(data, sides)
    theirs = data.published.ratio(sides.experiment, sides.candidate, sides.reference)
    # The ratio has most of the room.
    widths = [2.1, 1.0, *([0.9] if theirs else []), *([0.9] if work else [])]
    figure, axes = new_figure(2.3, len(widths), widths)
    # Of several scenes of a sweep, one value a block.
    pairs = log_ratios(both[1], both[0], match=("x",)).groupby(PAIR, as_index=False, sort=False)
    pairs = pairs[["log_ratio", "bias", "stops"]].mean()
    if row is None:
        row = judge_one(pairs["log_ratio"], by.margin, by.error, biases=pairs["bias"], stops=pairs["stops"])
    runs = data.published.experiment(sides.experiment)
    each = [np.exp(pairs["log_ratio"].to_numpy()), _published_ratios(runs, sides)]
    ratio_panel(axes[0], row, theirs, sides.names, by.margin, each)
    shown = _shown(sides)
    _by_block(axes[1], {sides.names[0]: candidate, sides.names[1]: reference}, shown, time_axis(times))
    if theirs:
        axes[2].set(xlabel="repetition", ylabel="time of the process, s", title="published")
        of_names = dict(zip((sides.candidate, sides.reference), sides.names, strict=True))
        _times(axes[2], runs.assign(name=runs["series"].map(of_names)), "seconds", shown, published=True)
    if work:
        _work(axes[-1], data, sides)
    dots = SCENES if times["x"].nunique() > 1 else PROCESSES
    said = _sentences(row, theirs, sides, by)
    verdicts = pd.DataFrame([{**row, "name": f"{sides.names[0]} against {sides.names[1]}"}])
    return Drawing(figure, opening(times, sides.subject, dots) + said + lost_by_turns(pairs), verdicts)


def _shown(sides: Sides) -> dict[str, Look]:
    """Return the look of both sides by the names that the reader is given."""
    found = looks([sides.reference, sides.candidate])
    return {sides.names[0]: found[sides.candidate], sides.names[1]: found[sides.reference]}


def _published_ratios(published: pd.DataFrame, sides: Sides) -> Floats:
    """Return the ratio of each published repetition of both."""
    runs = published.pivot_table(index="x", columns="series", values="seconds")
    if not {sides.candidate, sides.reference} <= set(runs):
        return np.empty(0)
    return np.asarray((runs[sides.candidate] / runs[sides.reference]).dropna(), dtype=float)


def _of_counts(data: Data, sides: Sides) -> Drawing:
    """Draw the attempts alone. They have no verdict here: the claim about them has."""
    figure, axes = new_figure(1.6)
    _work(axes[0], data, sides)
    scenes = data.study.runs_of(sides.experiment)["x"].nunique()
    return Drawing(
        figure,
        f"{sides.subject}: attempts at resolving a pair, and in a stronger shade those that resolved it, of "
        f"one step; the median of {count(scenes, 'scene')}. They were counted in one run each, whose time "
        "is not compared.",
    )


def _one_a_block(processes: pd.DataFrame) -> pd.DataFrame:
    """Return one row a block: where it holds several scenes of a sweep, the geometric mean of their times."""
    logs = processes.assign(steps_seconds=np.log(processes["steps_seconds"]))
    table = logs.groupby(PAIR, as_index=False).agg({"steps_seconds": "mean"})
    return table.assign(steps_seconds=np.exp(table["steps_seconds"]))


def _by_block(
    axes: Axes, curves: dict[str, pd.DataFrame], shown: Mapping[str, Look], label: str
) -> None:  # fmt: skip
    axes.set(xlabel="block", ylabel=label, title="measured")
    both = pd.concat(curves, names=["name"]).reset_index("name")
    # Nodes number their blocks alike: they stand one after another.
    both["x"] = 1 + both.groupby(PAIR).ngroup()
    _times(axes, both, "steps_seconds", shown)


def _times(
    axes: Axes, runs: pd.DataFrame, value: str, shown: Mapping[str, Look], *, published: bool = False
) -> None:
    """Draw the times of both sides, by `name`, over blocks or repetitions, `x`, small."""
    labels = []
    for name, look in shown.items():
        own = runs[runs["name"] == name].sort_values("x")
        lighter = look._replace(colour=lighten(look.colour)) if published else look
        told = f"{name}, published" if published else name
        points = [
            Told(told, exact(one), number(other)) for one, other in zip(own["x"], own[value], strict=True)
        ]
        size = 2.5 if len(own) <= MANY else 1.2
        line(axes, own["x"], own[value], lighter, points, markersize=size, linewidth=0.8)
        ink = lighten(look.colour, 0.35) if published else look.colour
        labels.append((name.replace(" with ", "\nwith "), own[value].iloc[-1], ink))
    axes.xaxis.set_major_locator(MaxNLocator(4, integer=True))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.margins(y=0.15)
    # With one block alone the axis would be too short for a whole number.
    axes.set_xlim(0.5, runs["x"].max() + 0.5)
    label_ends(axes, labels, size=6.5)


def ratio_panel(
    axes: Axes, ours: dict[str, Any], theirs: dict[str, Any] | None, names: tuple[str, str],
    margin: float = MARGIN, each: Sequence[Floats] = (),
) -> None:  # fmt: skip
    """Draw the ratio as a dot with the interval on which the verdict rests, the published one below it, and
    below either the ratios of `each` of its blocks or runs.
    """
    entries = [("measured", ours, INK)] + ([("published", theirs, lighten(INK, 0.4))] if theirs else [])
    heights = [float(len(entries) - place) for place in range(1, len(entries) + 1)]
    rows = []
    for height, (name, row, colour) in zip(heights, entries, strict=True):
        # Too few published runs for an interval are no open end: they have no bar at all.
        bare = {"low": np.nan, "high": np.nan} if name == "published" and np.isinf(row["high"]) else {}
        rows.append({**row, **bare, "at": height, "name": name, "colour": colour, "mark": "o", "said": ""})
        beside: Any = {"xycoords": ("axes fraction", "data"), "ha": "center", "fontsize": 7, "color": colour}
        note(axes, change(row), (0.5, height), (0, 9), **beside)
    forest(axes, rows, margin, width=2.6)
    low, high = axes.get_xlim()
    for height, ratios, (_, _, colour) in zip(heights, each, entries, strict=False):
        blocks = 100 * (ratios[(100 * (ratios - 1) > low) & (100 * (ratios - 1) < high)] - 1)
        axes.plot(blocks, np.full(len(blocks), height - 0.24), "|", color=lighten(colour, 0.3), markersize=5)
    name_rows(axes, [f"{name}:\n{row['verdict']}" for name, row, _ in entries], heights)
    axes.set(ylim=(-0.5, len(entries) - 0.3), title="difference")
    axes.set_xlabel(f"time of {names[0]} against {names[1]}, %")
    axes.xaxis.set_major_locator(MaxNLocator(6))


def _work(axes: Axes, data: Data, sides: Sides) -> None:
    """Draw the attempts at resolving a pair, those that resolve it in a stronger shade; medians of scenes."""
    runs = data.study.runs_of(sides.experiment)
    counts = (
        runs[["pair_resolves", "pair_attempts"]].div(runs["steps"], axis=0).groupby(runs["series"]).median()
    )
    shown = _shown(sides)
    for height, (series, name) in enumerate(
        zip((sides.reference, sides.candidate), sides.names[::-1], strict=True)
    ):
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


def _sentences(row: dict[str, float], theirs: dict[str, float] | None, sides: Sides, by: Stated) -> str:
    published = f" Published: {change(theirs)} ({theirs['verdict']})." if theirs else ""
    return (
        f" The time of {sides.names[0]} is {change(row)} against {sides.names[1]}, from {blocks(row)} "
        f"(paired log ratios): {row['verdict']} with a margin of {100 * by.margin:g} % (shaded; "
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
