"""Time over one swept parameter, and below it ratios: to one of its points, or to another series at the same
point; the published ones on the same axis, or beside it. Threads, with speed-ups, the limits of the machine
and the universal scalability law.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis import claims
from analysis.claims.entry import Evidence
from analysis.derived.comparisons import PUBLISHED, differences, differences_from, reference, stated
from analysis.derived.ladder import per_disc_step
from analysis.figures.captions import caption, course_of, opening, time_axis
from analysis.figures.kinds import Sides, curve, curves, stack
from analysis.figures.labels import SIGNS, from_zero, key, note, plain_ticks
from analysis.figures.style import BLUE, FAINT, GREEN, INK, ORANGE, Drawing, Look, lighten, looks, new_figure
from analysis.records.studies import Study
from analysis.statistics import scalability
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import join_replicates, log_ratios, ratios_of
from analysis.statistics.verdicts import error_of_picked, judge_one
from analysis.support.wording import count, exact, number

SAME_RANGE = 0.75
THREADS = (1, 2, 4, 8, 16, 32, 64, 128, 256)
IDEAL: Any = {"color": FAINT, "linestyle": "--", "linewidth": 0.9, "zorder": 1}
ENDS = ["value", "low", "high"]

Choice = tuple[str, float]
"""A schedule and its chunk."""


def trend(
    data: Evidence, experiment: str, subject: str, label: str | None = None, course: str = "growth",
    scale: str = "", counted: bool = False, known: str = "",
) -> Drawing | None:  # fmt: skip
    """Draw time over x, a curve a series, and below it ratios: of several series to the reference at the same
    x, of a single one to its own time at one x, beside the published ones, or if `counted` the pair resolves.
    `label` names x, `course` is what is said of a single series, `known` what else.

    Where a `scale` names the axes that are logarithmic the times of several series are per disc and step.
    """
    times = data.study.times_of(experiment)
    label = label or times["x_name"].iloc[0].replace("_", " ")
    shown = looks(sorted(times["series"].unique()))
    scale = scale if len(shown) > 1 else ""
    told: dict[str, Any] = {"curves": _courses(data, experiment, times, course, scale), "known": known}
    seconds = per_disc_step(times) if scale else times
    summary = summarise(seconds, ["series", "x"], "nanoseconds" if scale else "steps_seconds")
    published, table = data.published.experiment(experiment), None
    sides: Sides = {"": (summary, summary[:0])}
    if len(shown) > 1 and not counted:
        table, told["against"] = differences(times, reference(times)), reference(times)
        moved = _moved(summary, published) if scale == "xy" else published[:0]
        told["is_moved"] = len(moved) > 0
        sides = {"": (pd.concat([summary, moved]), table)}
    elif not counted:
        sides, at = _against_own(times, summary, published)
        told |= at
    against = "" if counted else told.get("against") or f"that at {exact(told['at'])}"
    value = "time per disc\nand step, ns" if scale else time_axis(times)
    figure, grid = stack(label, value, sides, shown, against, stated(times).margin, scale)
    if counted:
        _resolves(grid[1][0], data.study.runs_of(experiment))
    if table is None or scale != "x":
        return Drawing(figure, f"{opening(times, subject)} {caption('trend', told=told)}")
    table = table.assign(label=[f"{exact(x)} {label}" for x in table["x"]])
    table["name"] = [f"{row.series} against {against}, {row.label}" for row in table.itertuples()]
    told |= {"curves": [], "rows": list(table.itertuples())}
    return Drawing(figure, f"{opening(times, subject)} {caption('trend', told=told)}", table)


def _against_own(
    times: pd.DataFrame, summary: pd.DataFrame, published: pd.DataFrame
) -> tuple[Sides, dict[str, float]]:
    """Return the columns of a single series against its time at one x, beside the published one against its
    own; and that x of either, as `at` and `at_theirs`. One axis serves both where the sweeps are alike.
    """
    at, published = level_of(times, published), published.assign(series=times["series"].iloc[0])
    at_theirs = at if at in set(published["x"]) else float(published["x"].min())
    ours, theirs = _to_one(times, published, times["x"] == at, published["x"] == at_theirs)
    if len(theirs) and ranges_agree(times["x"], published["x"]):
        both = pd.concat([ours.assign(label="measured"), theirs.assign(label="published")])
        sides: Sides = {"": (summary, both)}
    else:
        sides = _beside(summary, ours, published, theirs)
    return sides, {"at": at, **({"at_theirs": at_theirs} if len(theirs) else {})}


def _resolves(axes: Axes, runs: pd.DataFrame) -> None:
    """Draw the pair resolves over x."""
    resolves = (runs["pair_resolves"] / (runs["particles"] * runs["steps"])).groupby(runs["x"]).median()
    curve(axes, resolves.rename("resolves").reset_index(), Look(GREEN), "resolves")
    axes.set_ylabel("pair resolves\nper disc and step")
    from_zero(axes)


def _moved(summary: pd.DataFrame, published: pd.DataFrame) -> pd.DataFrame:
    """Return the published times of a series, moved so that their median is level with ours, if they cover
    much the same range; no rows if not.
    """
    ours = summary[summary["series"].isin(published["series"])]
    if ours.empty or not ranges_agree(ours["x"], published["x"]):
        return published[:0]
    median = published["seconds"] * (ours["median"].median() / published["seconds"].median())
    label = f"as published, {number(published['seconds'].iloc[-1])} s"
    return published.assign(median=median, label=label, is_published=True)


def _to_one(
    times: pd.DataFrame, published: pd.DataFrame, chosen: pd.Series, chosen_theirs: pd.Series
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the ratios to the rows chosen, of our times, and of the published ones without intervals; none
    of these where none is chosen.
    """
    own = times.loc[chosen, ["series", "x"]].drop_duplicates().assign(ratio=1.0, low=1.0, high=1.0)
    level = published.loc[chosen_theirs, "seconds"]
    theirs = published["seconds"] / (level.iloc[0] if len(level) else np.nan)
    table = published.assign(ratio=theirs, is_published=True).dropna(subset="ratio")
    return pd.concat([differences_from(times, chosen), own], ignore_index=True), table


def _beside(
    summary: pd.DataFrame, ours: pd.DataFrame, published: pd.DataFrame, theirs: pd.DataFrame
) -> Sides:
    """Return what was measured and what was published as two columns, the latter if there is any."""
    if theirs.empty:
        return {"": (summary, ours)}
    seconds = published.assign(median=published["seconds"], is_published=True)
    return {"measured": (summary, ours), "published": (seconds, theirs)}


def level_of(times: pd.DataFrame, published: pd.DataFrame) -> float:
    """Return the x that others are compared with, whatever was measured: where the published time is least,
    if both sweeps cover much the same range, or the smallest one.
    """
    if not published.empty and ranges_agree(times["x"], published["x"]):
        least = float(published.loc[published["seconds"].idxmin(), "x"])
        if least in set(times["x"]):
            return least
    return float(times["x"].min())


def ranges_agree(ours: pd.Series, published: pd.Series) -> bool:
    """Tell whether the two sweeps cover much the same range, so that one axis serves both."""
    shared = min(ours.max(), published.max()) - max(ours.min(), published.min())
    return bool(shared >= SAME_RANGE * (published.max() - published.min()))


def _courses(
    data: Evidence, experiment: str, times: pd.DataFrame, course: str, scale: str
) -> list[dict[str, Any]]:
    """Return what the times of each series do: what they are asked, or their growth where there are several;
    on axes that are both logarithmic how far they are flat, but for the published variant.
    """
    if times["series"].nunique() < 2:
        times_of_trend = data.published.without_degenerate(experiment, times)
        return [
            {"course": course_of(times_of_trend, course), "is_degenerate": len(times_of_trend) < len(times)}
        ]
    first = times[times["variant"] == PUBLISHED]
    return [
        _flatness(series, part, first)
        if scale == "xy" and part["variant"].iloc[0] != PUBLISHED
        else {"series": series, "course": course_of(part, course)}
        for series, part in times.groupby("series")
    ]


def _flatness(series: str, processes: pd.DataFrame, first: pd.DataFrame) -> dict[str, Any]:
    """Return how far the times of a series are `flat` from its second x on, since the first is the dense
    spike, and by how much it is `faster` than the published one at the smallest and the largest shared x.
    """
    rest = processes.groupby("x")["steps_seconds"].median().sort_index().iloc[1:]
    flat = None
    if len(rest) > 1:
        least, most = rest.idxmin(), rest.idxmax()
        ratios = ratios_of(processes, "x", least, most)["log_ratio"]
        row = judge_one(ratios, error=error_of_picked(len(rest)))
        flat = {"first": rest.index[0], "row": row, "most": most, "least": least}
    shared = sorted(set(first["x"]) & set(processes["x"]))
    faster = [
        (judge_one(log_ratios(*(part[part["x"] == x] for part in (first, processes)))["log_ratio"]), x)
        for x in sorted({*shared[:1], *shared[-1:]})
    ]
    return {"series": series, "flat": flat, "faster": faster}


def schedule(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw the times over the chunk, a curve a kind of schedule, and below them the ratios to the published
    choice, which is ringed, the published ones beside them. Where the choice was not measured the ratios are
    to the smallest chunk of the reference.
    """
    times = data.study.times_of(experiment)
    summary = summarise(join_replicates(times), ["series", "x"])
    published = data.published.experiment(experiment)
    chosen, first = chosen_in(experiment), reference(times)
    is_chosen = chosen is not None and bool(_is(times, chosen).any())
    smallest = first, float(times.loc[times["series"] == first, "x"].min())
    at = chosen if chosen is not None and is_chosen else smallest
    named = f"{at[0]} with chunk {exact(at[1])}"
    ours, theirs = _to_one(times, published, _is(times, at), _is(published, at))
    shown = looks(sorted({*times["series"], *published["series"]}))
    sides = _beside(summary, ours, published, theirs)
    figure, grid = stack("chunk", time_axis(times), sides, shown, named, stated(times).margin, "x")
    for axes in grid[1]:
        axes.plot(at[1], 1, "o", color=INK, markersize=9, markerfacecolor="none", linewidth=0.8)
    (best,) = summary.loc[[summary["median"].idxmin()]].itertuples()
    least = None if published.empty else published.loc[published["seconds"].idxmin()]
    told = caption("schedule", best=best, named=named, is_chosen=is_chosen, theirs=least)
    return Drawing(figure, f"{opening(times, subject)} {told}")


def chosen_in(experiment: str) -> Choice | None:
    """Return the schedule that a published claim says is to be chosen in an experiment, if one does."""
    told = (claim.arguments for claim in claims.load() if experiment in claim.experiments)
    return next(((one["schedule"], one["chunk"]) for one in told if "schedule" in one), None)


def _is(table: pd.DataFrame, choice: Choice) -> pd.Series:
    return (table["series"] == choice[0]) & (table["x"] == choice[1])


def oversubscription(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw time over threads in multiples of the machine's hardware threads, against as many as it has."""
    times, hardware = data.study.times_of(experiment), data.study.hardware_threads
    at = times["x"] == times.loc[times["x"] <= hardware, "x"].max()
    more = times["x"] > hardware
    ours, _ = _to_one(times[at | more], times[:0].assign(seconds=0.0), at[at | more], at[:0])
    sides = {"": (summarise(times, ["series", "x"]), ours)}
    shown, margin = looks(times["series"]), stated(times).margin
    figure, grid = stack("threads", time_axis(times), sides, shown, "all hardware threads", margin)
    _thread_axis(grid[1][0], times["x"].unique(), times["x"].unique())
    for axes in grid[:, 0]:
        _limits(axes, data.study, named=axes is grid[0][0])
    rows = ours[ours["x"] > hardware]
    rows = rows.assign(label=[f"{x / hardware:g} times as many:" for x in rows["x"]])
    told = caption("oversubscription", hardware=hardware, rows=list(rows.itertuples()))
    return Drawing(figure, f"{opening(times, subject)} {told}".strip())


def scaling(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw time, speed-up against ideal, and efficiency over threads, a curve a series and scene; the law is
    fitted to a single one. None without records whose x is the number of threads.
    """
    times = data.study.times_of(experiment)
    times = times[times["x_name"] == "threads"]
    if times.empty:
        return None
    times, published = _by_curve(times), data.published.experiment(experiment)
    parts = {str(series): part for series, part in times.groupby("series")}
    shown = {**looks(parts), "published": Look(BLUE)}
    measured = {series: scalability.speed_up(part) for series, part in parts.items()}
    entries = [_entry(series, part, shown[series], len(parts) > 1) for series, part in parts.items()]
    rows = [_relative(series, part, measured[series]) for series, part in parts.items()]
    if len(published):
        speed = published["seconds"].iloc[0] / published["seconds"]
        each = 1 / speed, speed, speed * published["x"].iloc[0] / published["x"]
        theirs = pd.DataFrame({"x": published["x"], "series": "published", "is_published": True})
        rows.append([theirs.assign(value=value) for value in each])
        entries.append(("● published", lighten(BLUE, 0.4)))
    figure, panels = new_figure(2.6, columns=3)
    tables = [pd.concat(one) for one in zip(*rows, strict=True)]
    for axes, table in zip(panels, tables, strict=True):
        curves(axes, table, shown, "value")
    ideal = np.geomspace(1, 1.1 * tables[1]["value"].max(), 50)
    panels[1].plot(times["x"].min() * ideal, ideal, **IDEAL)
    panels[2].axhline(1, **IDEAL)
    entries.append(("- - ideal", FAINT))
    law = scalability.fit(times, data.study.hardware_threads) if len(parts) == 1 else None
    if law:
        n = np.geomspace(1, times["x"].max(), 100)
        for axes, y in zip(panels[1:], (law.speed_up(n), law.speed_up(n) / n), strict=True):
            axes.plot(n, y, color=ORANGE, linewidth=0.9, zorder=2.5)
        entries.append(("— universal scalability law", ORANGE))
    first = count(int(times["x"].min()), "thread")
    labels = f"time relative to {first}", f"speed-up over {first}", "efficiency"
    for axes, label in zip(panels, labels, strict=True):
        _thread_axis(axes, [*times["x"], *published["x"]], THREADS)
        from_zero(axes)
        _limits(axes, data.study, named=axes is panels[0])
        axes.set_ylabel(label)
    key(figure, entries)
    told = caption(
        "scaling", best=[_best(data.study, *one) for one in measured.items()], study=data.study, law=law,
        has_published=len(published) > 0, is_single=len(parts) == 1,
    )  # fmt: skip
    return Drawing(figure, f"{opening(times, subject)} {told}")


def _by_curve(times: pd.DataFrame) -> pd.DataFrame:
    """Return the times with a series for each scene, if there are several."""
    scenes = times["scene_name"]
    if scenes.nunique() < 2:
        return times
    one = times["series"].nunique() == 1
    return times.assign(series=scenes if one else times["series"] + ", " + scenes)


def _relative(series: str, times: pd.DataFrame, speed_ups: pd.DataFrame) -> list[pd.DataFrame]:
    """Return the times of a series relative to the fewest threads, its speed-ups, and its efficiency."""
    first, summary = float(times["x"].min()), summarise(times, ["x"])
    ends = summary[["median", "low", "high"]].set_axis(ENDS, axis=1)
    relative = ends / ends.loc[summary["x"] == first, "value"].iloc[0]
    speed_ups = speed_ups.rename(columns={"speed_up": "value"})
    efficiency = speed_ups[ENDS].mul(first / speed_ups["x"], axis=0)
    parts = (summary["x"], relative), (speed_ups["x"], speed_ups[ENDS]), (speed_ups["x"], efficiency)
    return [values.assign(x=x, series=series) for x, values in parts]


def _best(study: Study, series: str, table: pd.DataFrame) -> tuple[str, pd.Series, str]:
    """Return a series, its greatest speed-up, and why that is to be doubted."""
    best, cores = table.loc[table["speed_up"].idxmax()], study.cores or study.hardware_threads
    return series, best, scalability.doubt(best["speed_up"], min(best["x"], cores) / table["x"].min())


def _entry(series: str, times: pd.DataFrame, look: Look, several: bool) -> tuple[str, str]:
    first = times["x"].min()
    seconds = times.loc[times["x"] == first, "steps_seconds"].median()
    said = f"{number(seconds)} s on {count(int(first), 'thread')}"
    return f"{SIGNS[look.marker]} {series if several else 'measured'}, {said}", look.colour


def _limits(axes: Axes, study: Study, named: bool) -> None:
    """Draw the machine's cores and hardware threads as lines, named if asked."""
    cores, hardware = study.cores, study.hardware_threads
    marks = {
        cores: "cores",
        hardware: "cores and\nhardware threads" if cores == hardware else "hardware\nthreads",
    }
    for position, name in marks.items():
        if position is None or not axes.get_xlim()[0] <= position <= axes.get_xlim()[1]:
            continue
        axes.axvline(position, color=FAINT, linewidth=0.7, linestyle=":", zorder=1)
        if named:
            look: Any = {"rotation": 90, "fontsize": 6, "color": FAINT, "va": "top"}
            above = ("data", "axes fraction")
            note(axes, f"{position} {name}", (position, 0.98), (2, 0), xycoords=above, **look)


def _thread_axis(axes: Axes, values: Sequence[float], ticks: Sequence[float]) -> None:
    axes.set_xscale("log", base=2)
    axes.set_xlabel("threads")
    plain_ticks(axes.xaxis, [tick for tick in ticks if min(values) <= tick <= max(values)])
    axes.minorticks_off()
