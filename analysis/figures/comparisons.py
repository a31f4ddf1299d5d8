"""Ratios with intervals in rows: any number of series against one of them, two of them with every block and
the times of both beside it, machines, ways to measure, pauses.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from analysis.claims.entry import Evidence
from analysis.derived.comparisons import USUAL, Stated, differences, reference, stated
from analysis.derived.pauses import ratios as pause_ratios
from analysis.derived.ways import APART, TURNS, comparisons, overall, said
from analysis.derived.ways import KIND as WAYS
from analysis.figures.captions import PROCESSES, SCENES, caption, opening, time_axis
from analysis.figures.kinds import NO_ENDS, Dot, curve, forest, of_medians, of_ratio
from analysis.figures.labels import SIGNS, key, label_ends, logarithmic_ticks, note, plain_ticks
from analysis.figures.style import BLUE, INK, VERMILLION, Drawing, Look, lighten, looks, new_figure
from analysis.records.studies import Study
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import PAIR, log_ratios
from analysis.statistics.ranking import ranking
from analysis.statistics.verdicts import MARGIN, Ratio, corrected, judge_pairs, judge_unpaired, ratio_of
from analysis.support.values import Floats, Table
from analysis.support.wording import change, exact, number
from support.vocabulary import COUNTS

MANY = 40
"""Blocks from which their marks are as small as the line."""
LOOKS = {TURNS: Look(BLUE), APART: Look(VERMILLION, "s", "--")}

UNCHECKED = "not checked"
_TRAJECTORY = "trajectory of "

Names = Mapping[str, str]
"""The two series compared, the candidate first, each with its name for the reader."""


def comparison(
    data: Evidence, experiment: str, subject: str,
    names: Names | None = None, work: bool = False, published: Mapping[str, str] | None = None,
) -> Drawing | None:  # fmt: skip
    """Draw the differences of an experiment's series from its reference, with a table of verdicts. Two
    series, or those of `names`, are drawn as a pair, with the attempts at resolving a pair that each takes if
    `work` is wanted. On the same axis are published times of series, from the experiments `published`.
    """
    times = data.study.times_of(experiment)
    against, by = reference(times), stated(times)
    series = sorted(times["series"].unique(), key=lambda name: name == against)
    if names or (len(series) == 2 and times["x"].nunique() == 1):
        return _pair(data, experiment, subject, names or dict(zip(series, series, strict=True)), by, work)
    table = differences(times, against)
    table["label"] = _labels(table, table)
    summary = summarise(times, ["series", "x"]).iloc[::-1]
    theirs = _published_orders(data, table, against, published) if published else {}
    figure, (left, right) = new_figure(0.8 + 0.36 * len(summary), columns=2, widths=[2.1, 1.0])
    _differences(left, table, summary, by.margin, theirs)
    left.set_xlabel(f"time against {against}, %")
    medians = of_medians(summary, _labels(summary, summary), INK, short=True)
    forest(right, medians, [""] * len(summary), width=1.4)
    right.set_xlabel(time_axis(times))
    rows, is_usual = list(table.itertuples()), by == USUAL
    told = caption("comparison", rows=rows, against=against, by=by, is_usual=is_usual, theirs=theirs)
    table["name"] = [f"{label} against {against}" for label in table["label"]]
    words = f"{opening(times, subject)} {told}".strip()
    return Drawing(figure, words, table, league(data.study, experiment))


def _published_orders(
    data: Evidence, table: pd.DataFrame, against: str, questions: Mapping[str, str]
) -> Mapping[str, float]:
    """Return the published times of series, with self-contained resolves, as ratios, moved as one so that the
    first is level with ours, if it is there.
    """
    seconds = {
        name: data.published.experiment(question).query("series == 'on'")["seconds"].median()
        for name, question in questions.items()
    }
    level, first = {against: 1.0, **table.set_index("series")["ratio"]}, next(iter(seconds))
    if first not in level:
        return {}
    return {name: level[first] * one / seconds[first] for name, one in seconds.items() if name in level}


def _labels(rows: pd.DataFrame, table: pd.DataFrame) -> list[str]:
    """Return the series of each row, with x where the table has several."""
    several = table["x"].nunique() > 1
    return [f"{row.series}, {exact(row.x)}" if several else str(row.series) for row in rows.itertuples()]


def _differences(
    axes: Axes, table: pd.DataFrame, rows: pd.DataFrame, margin: float, published: Mapping[str, float]
) -> None:  # fmt: skip
    """Draw every difference with the interval that decides at the height of its row in the other panel, and
    the published ones, lighter, below them.
    """
    heights = {(row.series, row.x): float(height) for height, row in enumerate(rows.itertuples())}
    shown = looks(rows["series"])
    dots = [
        of_ratio(row, heights[row.series, row.x], row.label, shown[row.series], row.verdict)
        for row in table.itertuples()
    ]
    for (name, _), height in heights.items():
        if name in published:
            ratio = 100 * (published[name] - 1)
            dots.append(Dot(ratio, *NO_ENDS, height - 0.2, "published", number(ratio), Look(lighten(INK))))
    forest(axes, dots, _labels(rows, rows), margin)


def league(study: Study, experiment: str) -> list[Table]:
    """Return the table of an experiment of whole processes at one place of its sweep, none of any other: who
    is faster than whom, who was not checked, who failed.
    """
    times, failures = study.of(experiment, "times", "failures")
    if (times["kind"] != "process").any() or times["x"].nunique() > 1:
        return []
    checked = study.runs_of(experiment).groupby("series")["check_scope"].agg(_checked)
    rows = ranking(times, stated(times).margin)
    failed = failures[~failures["series"].isin(checked.index)].groupby("series")["reason"].first()
    return [("league", {"rows": rows, "checked": checked.to_dict(), "failed": failed.to_dict()})]


def _checked(scopes: pd.Series) -> str:
    """Say what of a program was checked."""
    told = {UNCHECKED if scope == "nothing" else scope.removeprefix(_TRAJECTORY) for scope in scopes}
    return "; ".join(sorted(told))


def _pair(
    data: Evidence, experiment: str, subject: str, names: Names, by: Stated, work: bool
) -> Drawing | None:  # fmt: skip
    """Draw the ratio of both sides with its verdict and that of every block, the published one below it on
    the same axis, and beside them the times block by block.
    """
    times = data.study.times_of(experiment)
    candidate, reference = (times[times["series"] == name] for name in names)
    if candidate.empty or reference.empty:
        return None
    if work and (times["question_kind"] == COUNTS).all():
        return _of_counts(data, experiment, subject, names)
    theirs, told = data.published.ratio(experiment, *names), list(names.values())
    # The ratio has most of the room.
    widths = [2.1, 1.0, *([0.9] if theirs else []), *([0.9] if work else [])]
    figure, axes = new_figure(2.3, len(widths), widths)
    # Of several scenes of a sweep, one value a block.
    pairs = log_ratios(reference, candidate, match=("x",)).groupby(PAIR, as_index=False, sort=False)
    pairs = pairs.mean(numeric_only=True)
    row = judge_pairs(pairs, by.margin, by.error)
    runs = data.published.experiment(experiment)
    each = [np.exp(pairs["log_ratio"].to_numpy()), _published_ratios(runs, names)]
    ratio_panel(axes[0], row, theirs, told, by.margin, each)
    _times(axes[1], _one_a_block(times[times["series"].isin(list(names))]), names)
    axes[1].set(xlabel="block", ylabel=time_axis(times), title="measured")
    if theirs:
        axes[2].set(xlabel="repetition", ylabel="time of the process, s", title="published")
        _times(axes[2], runs, names, published=True)
    if work:
        _work(axes[-1], data, experiment, names)
    # Cold caches at each turn make the ratio too great by so much, where that is known.
    bias = pairs["bias"].dropna()
    moved = None if bias.empty else float(np.expm1(bias.median()))
    opened = opening(times, subject, SCENES if times["x"].nunique() > 1 else PROCESSES)
    verdicts = pd.DataFrame([{**vars(row), "name": " against ".join(told)}])
    words = caption("pair", row=row, names=told, by=by, theirs=theirs, moved=moved)
    return Drawing(figure, f"{opened} {words}", verdicts, league(data.study, experiment))


def _published_ratios(published: pd.DataFrame, names: Names) -> Floats:
    """Return the ratio of each published repetition of both."""
    runs = published.pivot_table(index="x", columns="series", values="seconds")
    if not set(names) <= set(runs):
        return np.empty(0)
    candidate, reference = (runs[series] for series in names)
    return np.asarray((candidate / reference).dropna(), dtype=float)


def _of_counts(data: Evidence, experiment: str, subject: str, names: Names) -> Drawing:
    """Draw the attempts alone. They have no verdict here: the claim about them has."""
    figure, axes = new_figure(1.6)
    _work(axes[0], data, experiment, names)
    scenes = data.study.runs_of(experiment)["x"].nunique()
    return Drawing(figure, caption("counts", subject=subject, scenes=scenes))


def _one_a_block(processes: pd.DataFrame) -> pd.DataFrame:
    """Return one row a series and block, numbered as `x`, since nodes number theirs alike, with its
    `seconds`; where it holds several scenes of a sweep, the geometric mean of their times.
    """
    table = np.log(processes["steps_seconds"]).groupby([processes[key] for key in ("series", *PAIR)]).mean()
    both = np.exp(table).rename("seconds").reset_index()
    return both.assign(x=1 + both.groupby(PAIR).ngroup())


def _times(axes: Axes, runs: pd.DataFrame, names: Names, *, published: bool = False) -> None:
    """Draw the `seconds` of both sides over blocks or repetitions, `x`, small."""
    labels = []
    for series, look in looks(reversed(list(names))).items():
        own, name = runs[runs["series"] == series].sort_values("x"), names[series]
        lighter = look._replace(colour=lighten(look.colour)) if published else look
        told = f"{name}, published" if published else name
        size = 2.5 if len(own) <= MANY else 1.2
        curve(axes, own[["x", "seconds"]], lighter, "seconds", name=told, size=size, width=0.8)
        ink = lighten(look.colour, 0.35) if published else look.colour
        labels.append((name.replace(" with ", "\nwith "), own["seconds"].iloc[-1], ink))
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
    centred: Any = {"xycoords": ("axes fraction", "data"), "ha": "center", "fontsize": 7}
    for at, (name, row, colour) in enumerate(rows):
        dot = of_ratio(row, at, name, Look(colour))
        # Too few published runs for an interval are no open end: they have no bar at all.
        is_bare = name == "published" and not row.has_interval
        dots.append(replace(dot, low=np.nan, high=np.nan) if is_bare else dot)
        note(axes, change(row), (0.5, at), (0, 9), color=colour, **centred)
    forest(axes, dots, [f"{name}:\n{row.verdict}" for name, row, _ in rows], margin, width=2.6)
    low, high = axes.get_xlim()
    for dot, ratios in zip(reversed(dots), each, strict=False):
        blocks = 100 * (ratios - 1)
        blocks = blocks[(blocks > low) & (blocks < high)]
        pale = lighten(dot.look.colour, 0.3)
        axes.plot(blocks, np.full(len(blocks), dot.at - 0.24), "|", color=pale, markersize=5)
    axes.set(title="difference", xlabel=f"time of {names[0]} against {names[1]}, %")
    axes.xaxis.set_major_locator(MaxNLocator(6))


def _work(axes: Axes, data: Evidence, experiment: str, names: Names) -> None:
    """Draw the attempts at resolving a pair, those that resolve it in a stronger shade; medians of scenes."""
    runs = data.study.runs_of(experiment)
    counts = runs[["pair_resolves", "pair_attempts"]].div(runs["steps"], axis=0)
    medians, shown = counts.groupby(runs["series"]).median(), looks(reversed(list(names)))
    for height, (series, name) in enumerate(list(names.items())[::-1]):
        colour, counted = shown[series].colour, medians.loc[series].dropna()
        for shade, amount in zip((colour, lighten(colour, 0.5)), counted, strict=False):
            axes.barh(height, amount, color=shade, height=0.5, zorder=2 if shade == colour else 1)
        said = " of ".join(exact(round(amount)) for amount in counted)
        note(axes, f"{name}: {said}", (0, height + 0.27), (0, 2), color=colour, fontsize=7)
    axes.set(yticks=[], xlabel="resolves of attempts per step", title="work", ylim=(-0.6, 1.6))
    axes.xaxis.set_major_locator(MaxNLocator(3))
    plain_ticks(axes.xaxis)
    axes.spines["left"].set_visible(False)


def machines(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw the time on each machine, a row a series: every study at this scale, never merged."""
    present = [study for study in data.studies if study.scale == data.study.scale]
    times = pd.concat([study.times_of(experiment).assign(machine=study.machine) for study in present])
    if times.empty:
        return None
    several = [key for key in ("revision", "series") if times.groupby("machine")[key].nunique().max() > 1]
    times = times.assign(told=times[["machine", *several]].agg(", ".join, axis=1))
    times["name"] = times["told"].str.replace(": ", "\n", n=1).str.replace(", ", "\n", n=1)
    summary = summarise(times, ["name"]).sort_values("median", ascending=False)
    published = data.published.experiment(experiment).groupby("series")["seconds"].median().sort_values()
    height = 0.7 + 0.42 * max(len(summary), len(published))
    figure, axes = new_figure(height, columns=1 if published.empty else 2)
    names = list(summary["name"])
    forest(axes[0], of_medians(summary, names, BLUE), names, width=1.4)
    axes[0].set_xlabel("time of the steps, s")
    if not published.empty:
        axes[0].set_title("measured")
        gigahertz = data.published.machines.set_index("machine")["maximum_gigahertz"]
        theirs = published[::-1].rename("median").reset_index()
        names = [f"{name}\n{gigahertz[name]} GHz" for name in theirs["series"]]
        forest(axes[1], of_medians(theirs, names, lighten(BLUE, 0.4)), names)
        axes[1].set(xlabel="time of the process, s", title="published, 16 threads")
    return Drawing(figure, _of_machines(times, subject))


def _of_machines(times: pd.DataFrame, subject: str) -> str:
    groups = {name: group["steps_seconds"] for name, group in times.groupby("told")}
    # By name: were the fastest chosen, the verdicts against it would be biased.
    first, *others = groups
    rows = None
    if times["machine"].nunique() > 1:
        table = pd.DataFrame([vars(judge_unpaired(groups[first], groups[name])) for name in others])
        rows = list(corrected(table).assign(label=others).itertuples())
    # What is no partition has its host in its name.
    nodes = [
        f"{machine} on {', '.join(sorted(names))}"
        for machine, names in times.groupby("machine")["node"].unique().items()
        if not str(machine).startswith(f"{names[0]}: ")
    ]
    return caption(
        "machines", subject=subject, nodes=nodes, first=first, rows=rows,
        particles=times["particles"].iloc[0], threads=sorted(times["threads"].unique()),
        processes=times["file"].nunique(),
    )  # fmt: skip


def ways(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw the ratios of an experiment in turns and in processes of their own, and the width of their
    intervals over the time spent.
    """
    found = comparisons(data.study, experiment)
    if not found:
        return None
    figure, (left, right) = new_figure(1.0 + 0.42 * max(len(found), 4), columns=2, widths=[1.1, 1.0])
    dots = [
        of_ratio(ratio_of(one.log_ratio(way)), at + aside, f"{one.name}, {way}", LOOKS[way], judged=False)
        for at, one in enumerate(reversed(found))
        for way, aside in ((TURNS, 0.13), (APART, -0.13))
    ]
    forest(left, dots, [one.name.replace(": ", "\n") for one in reversed(found)], MARGIN, width=1.4)
    left.set_xlabel("time against the other, %")
    right.set(xscale="log", yscale="log", xlabel="time spent, s", ylabel="half of the interval, %")
    for way, look in LOOKS.items():
        for one in found:
            widths = one.half_widths(way)
            drawn: Any = {"color": look.colour, "linestyle": look.dashes, "linewidth": 0.9}
            right.plot(widths["seconds"], 100 * widths["half"], **drawn)
    for axis in (right.xaxis, right.yaxis):
        logarithmic_ticks(axis)
    key(figure, [(f"{SIGNS[look.marker]} {way}", look.colour) for way, look in LOOKS.items()])
    opened = opening(data.study.times_of(experiment), subject, PROCESSES)
    table = "ways", {"found": found, "ways": list(LOOKS)}
    return Drawing(figure, f"{opened} {caption('ways', off=said(overall(found)))}", tables=[table])


@lru_cache(maxsize=1)
def bias_sentence(study: Study) -> str:
    """Say how far ratios by turns are off on this machine, as far as the study measured it; else nothing.

    Many figures of one study say it.
    """
    names = sorted(study.times.loc[study.times["question_kind"] == WAYS, "experiment"].unique())
    found = [one for name in names for one in comparisons(study, str(name))]
    if not found:
        return ""
    widest = max(found, key=lambda one: abs(one.bias.estimate))
    return " " + caption(
        "biases", amount=len(found), mean=said(overall(found)), widest=widest.name, off=said(widest.bias),
        names=names,
    )  # fmt: skip


def pauses(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw the time of each program in slices over its time without a pause."""
    times = data.study.times_of(experiment)
    found = pause_ratios(times)
    if found.empty:
        return None
    figure, [axes] = new_figure(1.0 + 0.32 * max(len(found), 4))
    rows = list(found.itertuples())
    dots = [
        replace(
            of_ratio(ratio_of(row.ratio), at, row.series, Look(BLUE), judged=False), is_hollow=not row.sliced
        )
        for at, row in enumerate(reversed(rows))
    ]
    forest(axes, dots, list(found["series"])[::-1], MARGIN, width=1.4)
    axes.set_xlabel("time in slices against time without a pause, %")
    return Drawing(
        figure,
        f"{opening(times, subject, PROCESSES)} {caption('pauses')}",
        tables=[("pauses", {"rows": found})],
    )
