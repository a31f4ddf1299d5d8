"""Two variants against each other: every block of the measurement, the published runs, and the ratio."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from analysis.derived.comparisons import USUAL, Stated
from analysis.figures.captions import PROCESSES, SCENES, opening, time_axis
from analysis.figures.curves import bounded, difference, margin_band
from analysis.figures.hover import Told, tell
from analysis.figures.labels import label_ends, note, plain_ticks
from analysis.figures.style import BLUE, INK, VERMILLION, Data, Drawing, lighten, new_figure
from analysis.statistics.pairs import PAIR, log_ratios
from analysis.statistics.verdicts import MARGIN, judge_one
from analysis.support.wording import blocks, change, count, exact, number, percent
from support.vocabulary import COUNTS


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
    """Draw the times of both sides block by block, the published ones, and the ratio with its verdict, of
    `row` if it is known, by what the question states; with `work` also the attempts at resolving a pair that
    each takes.
    """
    times = data.study.times_of(sides.experiment)
    candidate, reference = (
        _one_a_block(times[times["series"] == name]) for name in (sides.candidate, sides.reference)
    )
    if candidate.empty or reference.empty:
        return None
    if work and (times["question_kind"] == COUNTS).all():
        return _of_counts(data, sides)
    theirs = data.published.ratio(sides.experiment, sides.candidate, sides.reference)
    extra = work or theirs is not None
    figure, axes = new_figure(2.4, columns=2 + extra, widths=[1.2, *([1.0] * extra), 1.1])
    _by_block(axes[0], {sides.names[0]: candidate, sides.names[1]: reference}, time_axis(times))
    pairs = log_ratios(reference, candidate)
    if row is None:
        row = judge_one(pairs["log_ratio"], by.margin, by.error, biases=pairs["bias"])
    if theirs:
        _published_panel(axes[1], data.published.experiment(sides.experiment), sides)
    if work:
        _work(axes[1], data, sides)
    ratio_panel(axes[-1], row, theirs, sides.names, by.margin)
    dots = SCENES if times["x"].nunique() > 1 else PROCESSES
    said = _sentences(row, theirs, sides, by)
    verdicts = pd.DataFrame([{**row, "name": f"{sides.names[0]} against {sides.names[1]}"}])
    return Drawing(figure, opening(times, sides.subject, dots) + said + lost_by_turns(pairs), verdicts)


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


def _by_block(axes: Axes, curves: dict[str, pd.DataFrame], label: str) -> None:
    axes.set(xlabel="block", ylabel=label, title="measured")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    both = pd.concat(curves)
    # Nodes number their blocks alike: they stand one after another.
    both["position"] = 1 + both.groupby(PAIR).ngroup()
    labels = []
    for name, colour in zip(curves, (BLUE, VERMILLION), strict=True):
        ordered = both.loc[name].sort_values("position")
        _runs(axes, ordered["position"], ordered["steps_seconds"], name, colour)
        labels.append((name, ordered["steps_seconds"].iloc[-1], colour))
    axes.margins(y=0.15)
    # With one block alone the axis would be too short for a whole number.
    axes.set_xlim(0.5, both["position"].max() + 0.5)
    label_ends(axes, labels)


def _published_panel(axes: Axes, published: pd.DataFrame, sides: Sides) -> None:
    axes.set(xlabel="repetition", ylabel="time of the process, s", title="published")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    labels = []
    both = (sides.candidate, sides.reference)
    for series, name, colour in zip(both, sides.names, (BLUE, VERMILLION), strict=True):
        run = published[published["series"] == series]
        _runs(axes, run["x"], run["seconds"], f"{name}, published", lighten(colour))
        labels.append((name, run["seconds"].iloc[-1], lighten(colour, 0.35)))
    axes.margins(y=0.15)
    label_ends(axes, labels)


def _runs(axes: Axes, x: pd.Series, seconds: pd.Series, name: str, colour: str) -> None:
    (line,) = axes.plot(x, seconds, color=colour, marker="o", linewidth=0.8)
    tell(line, [Told(name, exact(one), number(other)) for one, other in zip(x, seconds, strict=True)])


def ratio_panel(
    axes: Axes, ours: dict[str, float], theirs: dict[str, float] | None, names: tuple[str, str],
    margin: float = MARGIN,
) -> None:  # fmt: skip
    """Draw the ratio as a dot with the interval on which the verdict rests."""
    margin_band(axes, margin)
    entries = [("measured", ours, INK)] + ([("published", theirs, lighten(INK))] if theirs else [])
    for height, (name, row, colour) in zip((1.0, 0.0), entries, strict=False):
        difference(axes, row, height, name, colour, 2.6, markeredgecolor="white", zorder=3)
        said, beside = f"{name}: {row['verdict']}", ("axes fraction", "data")
        note(axes, said, (0, height), (0, 9), xycoords=beside, color=colour, fontsize=7)
    axes.set(ylim=(-0.6, 1.7), title="difference")
    axes.set_xlabel(f"time of {names[0]}\nagainst {names[1]}, %")
    axes.xaxis.set_major_locator(MaxNLocator(5))
    bounded(axes, margin)


def _work(axes: Axes, data: Data, sides: Sides) -> None:
    """Draw the attempts at resolving a pair, those that resolve it in a stronger shade; medians of scenes."""
    runs = data.study.runs_of(sides.experiment)
    counts = (
        runs[["pair_resolves", "pair_attempts"]].div(runs["steps"], axis=0).groupby(runs["series"]).median()
    )
    for height, (series, name, colour) in enumerate(
        zip((sides.reference, sides.candidate), sides.names[::-1], (VERMILLION, BLUE), strict=True)
    ):
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
        f"the bar is the {100 * (1 - by.error):g} % interval, which decides).{published}"
    )


def lost_by_turns(pairs: pd.DataFrame) -> str:
    """Say how far cold caches at each turn move the ratio of `pairs` (see `log_ratios`), if it is known."""
    known = pairs["bias"].dropna()
    if known.empty:
        return ""
    moved = percent(float(np.expm1(known.median())), 2)
    return f" Cold caches at each turn move it by {moved}: the interval reaches over both, with and without."
