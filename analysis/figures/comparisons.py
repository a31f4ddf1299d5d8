"""Any number of series against one of them, programs in a league table, machines, ways to measure, pauses:
rows of dots with intervals each.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.comparisons import USUAL, Stated, differences, reference, stated
from analysis.derived.pauses import ratios as pause_ratios
from analysis.derived.ways import APART, TURNS, comparisons, overall, said
from analysis.figures.captions import PROCESSES, differing, opening, time_axis
from analysis.figures.kinds import Dot, forest, of_medians, of_ratio
from analysis.figures.labels import SIGNS, key, logarithmic_ticks
from analysis.figures.pairs import pair_drawing
from analysis.figures.style import BLUE, INK, VERMILLION, Data, Drawing, Look, lighten, looks, new_figure
from analysis.records.studies import Study
from analysis.statistics.bootstrap import summarise
from analysis.statistics.ranking import ranking
from analysis.statistics.verdicts import MARGIN, Ratio, corrected, judge_unpaired, of_row, ratio_of
from analysis.support.values import Cell, Table, table_of
from analysis.support.wording import count, exact, listed, number

PublishedOf = Callable[[Data, pd.DataFrame, str], Mapping[str, float]]
"""From the table of differences to the published ratios of series to the reference."""

LIGHTER = " Lighter: the published medians with self-contained resolves, moved as one so that track is level."
LOOKS = {TURNS: Look(BLUE), APART: Look(VERMILLION, "s", "--")}

LEAGUE = ("place", "program", "time, s", "bracket", "checked")
UNCHECKED, ANOTHER = "not checked", "another command"
_TRAJECTORY = "trajectory of "


def comparison(
    data: Data, experiment: str, subject: str, published: PublishedOf | None = None
) -> Drawing | None:  # fmt: skip
    """Draw the differences of an experiment's series from its reference, with a table of verdicts, and the
    `published` ones on the same axis.
    """
    times = data.study.times_of(experiment)
    if times.empty:
        return None
    against, by = reference(times), stated(times)
    table = named(differences(times, against), against)
    ranked = league(data.study, experiment)
    tables = [ranked] if ranked else []
    names = sorted(times["series"].unique(), key=lambda name: name == against)
    if len(names) == 2 and times["x"].nunique() == 1:
        row = of_row(table.iloc[0]) if len(table) else None
        drawing = pair_drawing(data, experiment, subject, {one: one for one in names}, by=by, row=row)
        return drawing and replace(drawing, verdicts=table, tables=tables)
    summary = summarise(times, ["series", "x"]).iloc[::-1]
    theirs = published(data, table, against) if published else {}
    figure, (left, right) = new_figure(0.8 + 0.36 * len(summary), columns=2, widths=[2.1, 1.0])
    _differences(left, table, summary, by.margin, theirs)
    left.set_xlabel(f"time against {against}, %")
    medians = of_medians(summary, _labels(summary, summary), INK, short=True)
    forest(right, medians, [""] * len(summary), width=1.4)
    right.set_xlabel(time_axis(times))
    told = differences_sentence(table, against, by)
    return Drawing(figure, f"{opening(times, subject)}{told}{LIGHTER if theirs else ''}", table, tables)


def published_orders(data: Data, table: pd.DataFrame, against: str) -> dict[str, float]:
    """Return the published times of the sequential orders, with self-contained resolves, as ratios, moved as
    one so that track is level with ours, if it is there.
    """
    seconds = {
        name: data.published.experiment(f"self_contained_{name}").query("series == 'on'")["seconds"].median()
        for name in ("track", "repeat")
    }
    level = {against: 1.0, **dict(zip(table["series"], table["ratio"], strict=True))}
    if "track" not in level:
        return {}
    return {name: level["track"] * one / seconds["track"] for name, one in seconds.items() if name in level}


def named(table: pd.DataFrame, against: str) -> pd.DataFrame:
    """Return the differences with what the report is to call each, its `name`."""
    return table.assign(name=[f"{label} against {against}" for label in _labels(table, table)])


def differences_sentence(table: pd.DataFrame, against: str, by: Stated = USUAL) -> str:
    """Say every difference with its verdict, and the margin and error if they are the question's own."""
    told = differing(_labels(table, table), table)
    own = (
        ""
        if by == USUAL
        else f", with a margin of {100 * by.margin:g} % and an error of {100 * by.error:g} %"
    )
    return f" Against {against}: {told} (Holm-corrected{own})." if told else ""


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
    shown, dots = looks(rows["series"]), []
    for label, row in zip(_labels(table, table), table.itertuples(), strict=True):
        at = heights[row.series, row.x]
        dots.append(of_ratio(row, at, label, shown[row.series], row.verdict))
    for (name, _), height in heights.items():
        if name in published:
            per_cent = 100 * (published[name] - 1)
            told, look = number(per_cent), Look(lighten(INK))
            dots.append(Dot(per_cent, float("nan"), float("nan"), height - 0.2, "published", told, look))
    forest(axes, dots, _labels(rows, rows), margin)


def league(study: Study, experiment: str) -> Table | None:
    """Return the table of an experiment of whole processes at one place of its sweep, None for any other: who
    is faster than whom, who was not checked, who failed.
    """
    times, failures = study.of(experiment, "times", "failures")
    if times.empty or (times["kind"] != "process").any() or times["x"].nunique() > 1:
        return None
    checked = study.runs_of(experiment).groupby("series")["check_scope"].agg(_checked)
    rows: list[list[Cell | str]] = []
    for row in ranking(times, stated(times).margin).itertuples():
        told = checked[row.series]
        # What was checked in another program, or not at all, says nothing of the one that was timed.
        mark = "open" if UNCHECKED in told or ANOTHER in told else ""
        place = listed(sorted(set(row.place)), " to ")
        rows.append([place, row.series, number(row.seconds), row.bracket, Cell(told, mark)])
    failed = failures[~failures["series"].isin(checked.index)].groupby("series")["reason"].first()
    for series, reason in failed.items():
        rows.append(["–", str(series), "–", "", Cell(f"failed: {reason}", "fails")])
    title = (
        "In the order of their times. Programs with a letter in common cannot be told apart, or differ by "
        "less than the margin; those without differ by more (all pairs, Holm-corrected)"
    )
    return table_of(title, LEAGUE, rows)


def _checked(scopes: pd.Series) -> str:
    """Say what of a program was checked."""
    told = {UNCHECKED if scope == "nothing" else scope.removeprefix(_TRAJECTORY) for scope in scopes}
    return "; ".join(sorted(told))


def machines(data: Data, experiment: str, subject: str) -> Drawing | None:
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
    on = " or ".join(count(int(threads), "thread") for threads in sorted(times["threads"].unique()))
    caption = (
        f"{subject} (N = {exact(times['particles'].iloc[0])}, {on}): medians with 95 % "
        f"bootstrap intervals, {count(times['file'].nunique(), 'process')}.{_hosts(times)}"
    )
    groups = {name: group["steps_seconds"] for name, group in times.groupby("told")}
    if times["machine"].nunique() < 2:
        return f"{caption} Only one machine is present; more appear when their results are collected."
    # By name: were the fastest chosen, the verdicts against it would be biased.
    first = min(groups)
    others = [name for name in groups if name != first]
    table = corrected(pd.DataFrame([vars(judge_unpaired(groups[first], groups[name])) for name in others]))
    return f"{caption} Against {first} (not interleaved, so unpaired): {differing(others, table)}."


def _hosts(times: pd.DataFrame) -> str:
    """Say which nodes of a partition were used; what is no partition has its host in its name."""
    nodes = times.groupby("machine")["node"].unique()
    used = [
        f"{machine} on {', '.join(sorted(names))}"
        for machine, names in nodes.items()
        if not str(machine).startswith(f"{names[0]}: ")
    ]
    return f" Nodes: {'; '.join(used)}." if used else ""


def ways(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the ratios of an experiment in turns and in processes of their own, and the width of their
    intervals over the time spent.
    """
    found = comparisons(data.study, experiment)
    if not found:
        return None
    figure, (left, right) = new_figure(1.0 + 0.42 * max(len(found), 4), columns=2, widths=[1.1, 1.0])
    dots = [
        _of_way(ratio_of(one.log_ratio(way)), at + aside, f"{one.name}, {way}", LOOKS[way])
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
    caption = (
        f"{opening(data.study.times_of(experiment), subject, PROCESSES)} Ratios of the times of the steps "
        "with 95 % intervals, and, a line a comparison, half of these as blocks came, over the time that "
        f"they took. Ratios by turns are {said(overall(found))} off those apart, on average."
    )
    both = (TURNS, APART)
    rows: Iterable[list[Cell | str]] = (
        [one.name, *(said(one.log_ratio(way)) for way in both), said(one.bias), str(len(one.pairs)),
         *(number(one.seconds[way]) for way in both)]
        for one in found
    )  # fmt: skip
    columns = [
        "comparison",
        *both,
        "by turns against apart",
        "blocks",
        *(f"s a block, {way}" for way in both),
    ]
    title = "The same comparisons both ways, with 95 % intervals over the blocks"
    return Drawing(figure, caption, tables=[table_of(title, columns, rows)])


def _of_way(ratio: Ratio, at: float, name: str, look: Look, *, is_hollow: bool = False) -> Dot:
    """Return a ratio that has no verdict."""
    return replace(of_ratio(ratio, at, name, look), name=name, is_hollow=is_hollow)


def pauses(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the time of each program in slices over its time without a pause."""
    found = pause_ratios(data.study.times_of(experiment))
    if found.empty:
        return None
    figure, [axes] = new_figure(1.0 + 0.32 * max(len(found), 4))
    dots = [
        _of_way(ratio_of(row.ratio), at, row.series, Look(BLUE), is_hollow=not row.sliced)
        for at, row in enumerate(found[::-1].itertuples())
    ]
    forest(axes, dots, list(found["series"])[::-1], MARGIN, width=1.4)
    axes.set_xlabel("time in slices against time without a pause, %")
    opened = opening(data.study.times_of(experiment), subject, PROCESSES)
    caption = (
        f"{opened} Time in slices against time without a pause, by pairs within blocks, with 95 % "
        "intervals. A hollow dot is a program that was found to mind being stopped, and so was not."
    )
    rows: Iterable[list[Cell | str]] = (
        [
            row.series,
            number(row.seconds),
            said(row.ratio) + ("" if row.sliced else " (not stopped)"),
            str(row.blocks),
        ]
        for row in found.itertuples()
    )
    columns = ["program", "s without a pause", "in slices", "blocks"]
    title = "Time in slices against time without a pause, with 95 % intervals over the blocks"
    return Drawing(figure, caption, tables=[table_of(title, columns, rows)])
