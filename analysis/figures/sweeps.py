"""Time over one swept parameter, and below it ratios: to one of its points, the published ones on the same
axis, or to another series at the same point. Schedules over their chunks are swept so, too, and threads, with
speed-ups, the limits of the machine and the universal scalability law.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis import claims
from analysis.claims.entry import Evidence
from analysis.derived.comparisons import PUBLISHED, differences, differences_from, reference, stated
from analysis.derived.ladder import per_disc_step
from analysis.figures.captions import caption, course_of, opening, time_axis
from analysis.figures.kinds import curve, ends_of, published_curve, ratio_axis, ratio_curve
from analysis.figures.labels import SIGNS, from_zero, key, label_ends, logarithmic_ticks, note, plain_ticks
from analysis.figures.style import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    ORANGE,
    Drawing,
    Look,
    lighten,
    looks,
    new_figure,
    new_grid,
)
from analysis.records.studies import Study
from analysis.statistics import scalability
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import join_replicates, log_ratios, ratios_of
from analysis.statistics.scalability import log_ratios_by_x
from analysis.statistics.verdicts import error_of_picked, judge, judge_one
from analysis.support.wording import count, exact, number

SAME_RANGE = 0.75
THREADS = (1, 2, 4, 8, 16, 32, 64, 128, 256)

ASIDE = {"dynamic": 0.985, "static": 1.015}
"""How far the curve of a schedule is moved aside, so that intervals at one chunk do not cover each other."""
CHUNKS = [1, 2, 3, 5, 10, 20, 40, 80, 160, 320, 640, 1280]


def trend(
    data: Evidence, experiment: str, subject: str, label: str | None = None, course: str = "growth",
    scale: str = "", counted: bool = False, known: str = "",
) -> Drawing | None:  # fmt: skip
    """Draw time over x, a curve a series, and below it ratios: of several series to the reference at the same
    x, of a single one to its own time at one x, with the published series on the same axis, or if `counted`
    the pair resolves. `label` names x, `course` is what is said of a single series, `known` what else.

    Where a `scale` names the axes that are logarithmic the times of several series are per disc and step.
    """
    times = data.study.times_of(experiment)
    label = label or times["x_name"].iloc[0].replace("_", " ")
    several, shown = times["series"].nunique() > 1, looks(sorted(times["series"].unique()))
    scale = scale if several else ""
    figure, (above, below) = stacked(label, 4.2 if scale == "xy" else 3.7)
    summary = _draw_times(above, times, shown, scale)
    published, table = data.published.experiment(experiment), None
    told: dict[str, Any] = {"curves": _courses(data, experiment, times, course, scale), "known": known}
    if counted:
        _resolves(below, data.study.runs_of(experiment))
    elif several:
        told["is_moved"] = _name_ends(above, summary, shown, published if scale == "xy" else None)
        told["against"], table = _against_reference(below, times, shown, label)
    else:
        told |= _against_own(below, times, published, *shown.values())
    if scale != "x":
        return Drawing(figure, f"{opening(times, subject)} {caption('trend', told=told)}")
    told |= {"curves": [], "rows": [] if table is None else list(table.itertuples())}
    return Drawing(figure, f"{opening(times, subject)} {caption('trend', told=told)}", table)


def _draw_times(axes: Axes, times: pd.DataFrame, shown: Mapping[str, Look], scale: str) -> pd.DataFrame:
    """Draw the times of each series, and return them; see `trend`."""
    value = "nanoseconds" if scale else "steps_seconds"
    summary = summarise(per_disc_step(times) if scale else times, ["series", "x"], value=value)
    for series, part in summary.groupby("series"):
        curve(axes, part, shown[str(series)])
    axes.set_ylabel("time per disc\nand step, ns" if scale else time_axis(times))
    axes.set(xscale="log" if "x" in scale else "linear", yscale="log" if "y" in scale else "linear")
    if "y" in scale:
        logarithmic_ticks(axes.yaxis)
    else:
        from_zero(axes)
    plain_ticks(axes.xaxis, _far_apart(summary["x"]) if "y" in scale else None)
    return summary


def _resolves(axes: Axes, runs: pd.DataFrame) -> None:
    """Draw the pair resolves over x."""
    resolves = (runs["pair_resolves"] / (runs["particles"] * runs["steps"])).groupby(runs["x"]).median()
    curve(axes, resolves.rename("resolves").reset_index(), Look(GREEN), "resolves")
    axes.set_ylabel("pair resolves\nper disc and step")
    from_zero(axes)


def _against_reference(
    axes: Axes, times: pd.DataFrame, shown: Mapping[str, Look], label: str
) -> tuple[str, pd.DataFrame]:
    """Draw the ratios of several series to the reference at the same x; return that, and their table."""
    against = reference(times)
    table = differences(times, against)
    ratio_axis(axes, table, against, stated(times).margin)
    for series, part in table.groupby("series"):
        ratio_curve(axes, part, shown[str(series)])
    if len(table):
        label_ends(axes, ends_of(table, shown, "ratio"))
    table["label"] = [f"{exact(x)} {label}" for x in table["x"]]
    table["name"] = [f"{row.series} against {against}, {row.label}" for row in table.itertuples()]
    return against, table


def _name_ends(
    axes: Axes, summary: pd.DataFrame, shown: Mapping[str, Look], published: pd.DataFrame | None
) -> bool:
    """Name the curves at their ends, with a published one beside them, moved so that its median is level with
    ours, if it covers much the same range; tell whether it does.
    """
    ends = ends_of(summary, shown, "median")
    ours = summary[summary["series"].isin([] if published is None else published["series"])]
    is_moved = published is not None and len(ours) > 0 and ranges_agree(ours["x"], published["x"])
    if published is not None and is_moved:
        seconds = published["seconds"] * (ours["median"].median() / published["seconds"].median())
        look = shown[str(ours["series"].iloc[0])]
        published_curve(axes, published["x"], seconds, look)
        said = f"as published, {number(published['seconds'].iloc[-1])} s"
        ends.append((said, float(seconds.iloc[-1]), lighten(look.colour, 0.4)))
    label_ends(axes, ends)
    return is_moved


def stacked(label: str, height: float = 3.7) -> tuple[Figure, tuple[Axes, Axes]]:
    """Return a figure with the axes of the times above those of the ratios, over the x that `label` names."""
    figure, [[above], [below]] = new_grid(height, 2, sharex=True, height_ratios=[1.0, 1.25])
    below.set_xlabel(label)
    return figure, (above, below)


def _against_own(axes: Axes, times: pd.DataFrame, published: pd.DataFrame, look: Look) -> dict[str, Any]:
    """Draw the ratios of one series to its time at one x, the published ones beside them; return that x of
    either, as `at` and `at_theirs`.
    """
    at = level_of(times, published)
    own = pd.DataFrame([{"x": at, "ratio": 1.0, "low": 1.0, "high": 1.0}])
    table = pd.concat([differences_from(times, times["x"] == at), own], ignore_index=True)
    at_theirs = at if at in set(published["x"]) else float(published["x"].min())
    theirs = published_ratios(published, published["x"] == at_theirs)
    ratio_axis(axes, pd.concat([table, theirs]), f"that at {exact(at)}", stated(times).margin)
    ratio_curve(axes, table.assign(series=times["series"].iloc[0]), look)
    if theirs.empty:
        return {"at": at}
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
    return {"at": at, "at_theirs": at_theirs}


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


def _far_apart(x: pd.Series) -> list[float]:
    """Return the largest value and smaller ones so far apart that their names fit a logarithmic axis."""
    kept: list[float] = []
    for value in sorted(x.unique(), reverse=True):
        if not kept or value < kept[-1] / 1.35:
            kept.append(float(value))
    return kept


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


Choice = tuple[str, float]
"""A schedule and its chunk."""


def schedule(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw the ratio to the published choice over the chunk, a curve a kind of schedule, beside the published
    ones on the same axis, and the times small below; the choice is ringed. Where it was not measured the
    ratios are to the smallest chunk of the reference.
    """
    times = data.study.times_of(experiment)
    summary = summarise(join_replicates(times), ["series", "x"])
    published = data.published.experiment(experiment)
    chosen, first = chosen_in(experiment), reference(times)
    is_chosen = chosen is not None and bool(_is(times, chosen).any())
    smallest = first, float(times.loc[times["series"] == first, "x"].min())
    against = chosen if chosen is not None and is_chosen else smallest
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


def scaling(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw time, speed-up against ideal, and efficiency over threads, a curve a series and scene; the law is
    fitted to a single one. None without records whose x is the number of threads.
    """
    times = data.study.times_of(experiment)
    times = times[times["x_name"] == "threads"]
    if times.empty:
        return None
    times = _by_curve(times)
    published = data.published.experiment(experiment)
    figure, panels = new_figure(2.6, columns=3)
    shown = looks(sorted(times["series"].unique()))
    parts = {str(series): part for series, part in times.groupby("series")}
    measured = {series: _speed_ups(panels, part, shown[series]) for series, part in parts.items()}
    entries = [_entry(series, part, shown[series], len(parts) > 1) for series, part in parts.items()]
    law = scalability.fit(times, data.study.hardware_threads) if len(parts) == 1 else None
    most = max(table["speed_up"].max() for table in measured.values())
    if len(published):
        x, speed = published["x"], published["seconds"].iloc[0] / published["seconds"]
        for axes, y in zip(panels, (1 / speed, speed, speed * x.iloc[0] / x), strict=True):
            published_curve(axes, x, y, Look(BLUE))
        most = max(most, speed.max())
        entries.append(("● published", lighten(BLUE, 0.4)))
    ideal = np.geomspace(1, 1.1 * most, 50)
    panels[1].plot(times["x"].min() * ideal, ideal, color=FAINT, linestyle="--", linewidth=0.9, zorder=1)
    panels[2].axhline(1, color=FAINT, linestyle="--", linewidth=0.9, zorder=1)
    entries.append(("- - ideal", FAINT))
    if law:
        n = np.geomspace(1, times["x"].max(), 100)
        for axes, y in zip(panels[1:], (law.speed_up(n), law.speed_up(n) / n), strict=True):
            axes.plot(n, y, color=ORANGE, linewidth=0.9, zorder=2.5)
        entries.append(("— universal scalability law", ORANGE))
    first = count(int(times["x"].min()), "thread")
    labels = f"time relative to {first}", f"speed-up over {first}", "efficiency"
    for axes, label in zip(panels, labels, strict=True):
        _thread_axis(axes, [*times["x"], *published["x"]])
        from_zero(axes)
        limits(axes, data.study, named=axes is panels[0])
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


def _speed_ups(panels: Sequence[Axes], times: pd.DataFrame, look: Look) -> pd.DataFrame:
    """Draw one series and return its speed-ups."""
    first, series = float(times["x"].min()), times["series"].iloc[0]
    speed_ups = scalability.speed_up(times).assign(series=series)
    summary, ends = summarise(times, ["series", "x"]), ["median", "low", "high"]
    relative = summary.assign(**summary[ends] / summary.loc[summary["x"] == first, "median"].iloc[0])
    ends = ["speed_up", "low", "high"]
    efficiency = speed_ups.assign(**speed_ups[ends].mul(first / speed_ups["x"], axis=0))
    for axes, table in zip(panels, (relative, speed_ups, efficiency), strict=True):
        curve(axes, table, look, "median" if table is relative else "speed_up")
    return speed_ups


def _best(study: Study, series: str, table: pd.DataFrame) -> tuple[str, pd.Series, str]:
    """Return a series, its greatest speed-up, and why that is to be doubted."""
    best, cores = table.loc[table["speed_up"].idxmax()], study.cores or study.hardware_threads
    return series, best, scalability.doubt(best["speed_up"], min(best["x"], cores) / table["x"].min())


def _entry(series: str, times: pd.DataFrame, look: Look, several: bool) -> tuple[str, str]:
    first = times["x"].min()
    seconds = times.loc[times["x"] == first, "steps_seconds"].median()
    said = f"{number(seconds)} s on {count(int(first), 'thread')}"
    return f"{SIGNS[look.marker]} {series if several else 'measured'}, {said}", look.colour


def oversubscription(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw time over threads in multiples of the machine's hardware threads, against as many as it has."""
    times = data.study.times_of(experiment)
    hardware = data.study.hardware_threads
    figure, (above, below) = stacked("threads", 3.4)
    curve(above, summarise(times, ["x"]), Look(BLUE))
    above.set_ylabel("time of the steps, s")
    from_zero(above)
    reference = times[times["x"] == times.loc[times["x"] <= hardware, "x"].max()]
    table = judge(log_ratios_by_x(reference, times[times["x"] > hardware]), ["x"])
    own = reference[["x"]].drop_duplicates().assign(ratio=1.0)
    ratios = pd.concat([own, table], ignore_index=True).reindex(columns=["x", "ratio", "low", "high"])
    ratio_axis(below, ratios, "all hardware threads")
    ratio_curve(below, ratios, Look(BLUE))
    _thread_axis(below, sorted(times["x"].unique()), times["x"].unique())
    limits(above, data.study, named=True)
    limits(below, data.study, named=False)
    rows = list(table.assign(label=[f"{x / hardware:g} times as many:" for x in table["x"]]).itertuples())
    told = caption("oversubscription", hardware=hardware, rows=rows)
    return Drawing(figure, f"{opening(times, subject)} {told}".strip())


def limits(axes: Axes, study: Study, named: bool) -> None:
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


def _thread_axis(axes: Axes, values: list[float], ticks: Iterable[float] = THREADS) -> None:
    axes.set_xscale("log", base=2)
    axes.set_xlabel("threads")
    plain_ticks(axes.xaxis, [tick for tick in ticks if min(values) <= tick <= max(values)])
    axes.minorticks_off()
