"""Where the time of a step goes, from profiled runs: its phases, what counters tell of them, how near they
are to the limits of the machine, and a step on every thread.
"""

from itertools import zip_longest
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.counters import QUANTITIES, derived
from analysis.derived.ladder import named, scene_title
from analysis.derived.limits import ARITHMETIC, COPY, against_limits, busy_shares
from analysis.derived.unavoidable import PHASES
from analysis.figures.labels import key, name_rows, note, plain_ticks
from analysis.figures.style import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    ORANGE,
    VERMILLION,
    Data,
    Drawing,
    lighten,
    new_figure,
    new_grid,
    point,
)
from analysis.records import timelines
from analysis.support.wording import count, number, scene_in_words, share

PHASE_COLOURS = {"move": ORANGE, "bin": GREEN, "find": BLUE, "resolve": VERMILLION}
COLUMNS = 3
"""Counters side by side."""

DOTS = {
    COPY: ("least by copying", "<", "◂", BLUE),
    ARITHMETIC: ("least by arithmetic", "d", "◆", ORANGE),
    "wall": ("measured", "o", "●", INK),
}
"""What is drawn of a phase, by column: what it is called, its mark, that of the key, and its colour."""

MOST, MANY = 6, 400
"""Timelines that are drawn, and spans of one kind from which they become pixels."""
EDGED_FROM = 1 / 150
"""The narrowest chunk that gets a white edge, as a part of the axis; a narrower one would vanish in it."""


def profile(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw each phase's share of a step's wall time, and how much of it the threads are busy."""
    table, threads = data.study.of(experiment, "phases", "threads")
    if table.empty:
        return None
    series = list(dict.fromkeys(table.sort_values("series_number", kind="stable")["series"]))[::-1]
    figure, (left, right) = new_figure(0.8 + 0.42 * len(series), columns=2, widths=[1.15, 1])
    walls = table.pivot_table(index=["series", "file"], columns="phase", values="wall_seconds", aggfunc="sum")
    shares = walls.div(walls.sum(axis=1), axis=0).groupby("series").median().loc[series]
    shares = shares[[phase for phase in PHASE_COLOURS if phase in shares]]
    busy = busy_shares(threads, ["series", "phase", "file"]).groupby(["series", "phase"]).median()
    heights, begin = np.arange(len(series)), np.zeros(len(series))
    for rank, phase in enumerate(shares):
        colour, width = PHASE_COLOURS[phase], 100 * shares[phase].to_numpy()
        bars = left.barh(
            heights, width, left=begin, height=0.6, color=colour, edgecolor="white", linewidth=0.5
        )
        said = [f"{one:.0f}" if one >= 6 else "" for one in width]
        left.bar_label(bars, said, label_type="center", color="white", fontsize=7)
        begin += width
        # One thin bar a phase, in the phases' order from above, over a pale bar of the whole.
        thickness = 0.7 / len(shares.columns)
        at = heights + 0.35 - thickness * (rank + 0.5)
        right.barh(at, 100, color=lighten(colour, 0.8), height=thickness * 0.85)
        part = 100 * busy.unstack("phase").loc[series, phase]
        right.barh(at, part, color=colour, height=thickness * 0.85)
    name_rows(left, series)
    name_rows(right, [""] * len(series))
    left.set(xlabel="share of the wall time of a step, %", xlim=(0, 100))
    right.set(xlabel="busy time of the threads in the phase, %", xlim=(0, 100))
    key(figure, [(f"■ {phase}", colour) for phase, colour in PHASE_COLOURS.items()])
    return Drawing(figure, _of_phases(subject, table, shares, threads))


def _of_phases(subject: str, table: pd.DataFrame, shares: pd.DataFrame, threads: pd.DataFrame) -> str:
    first = table["series"].iloc[0]
    said = ", ".join(f"{phase} {share(shares.loc[first, phase])}" for phase in shares.columns)
    seconds = table[table["series"] == first][["serial_seconds", "wall_seconds"]].sum()
    serial = seconds["serial_seconds"] / seconds["wall_seconds"]
    runs = count(table["file"].nunique(), "profiled run")
    where = "; ".join(
        scene_in_words(particles, fraction)
        for particles, fraction in table[["particles", "area_fraction"]].drop_duplicates().to_numpy()
    )
    threads_used = count(int(table["threads"].max()), "thread")
    busy = threads.groupby(["series", "phase", "file"])["busy_seconds"]
    uneven = (busy.max() / busy.mean()).groupby(["series", "phase"]).median()
    series, phase = uneven.idxmax()
    return (
        f"{subject} ({where}, {threads_used}), from {runs} apart from the timed ones (medians). {first}: "
        f"{said}; {share(serial)} of it outside parallel loops. Right: busy time against waiting at "
        f"barriers. Greatest load imbalance (maximum over mean of the threads): {number(uneven.max())} in "
        f"{phase} of {series}."
    )


def panels(data: Data, source: str, subject: str) -> Drawing | None:
    """Draw what one source counted of the published variants, a panel a quantity: sources are never mixed."""
    (counters,) = data.study.of("phases", "counters")
    asked = [one for one in QUANTITIES if one.source == source]
    rows = derived(counters[counters["source"] == source], asked)
    if rows.empty:
        return None
    quantities = list(dict.fromkeys(rows["quantity"]))
    series = list(dict.fromkeys(counters["series"]))[::-1]
    lines = -(-len(quantities) // COLUMNS)
    figure, grid = new_grid(lines * (0.6 + 0.2 * len(series)), lines, COLUMNS, sharey=True)
    for axes, quantity in zip_longest(grid.ravel(), quantities):
        axes.set_visible(quantity is not None)
        if quantity is not None:
            _bars(axes, rows[rows["quantity"] == quantity].set_index("series").reindex(series), quantity)
    runs = count(int(rows["runs"].max()), "run")
    caption = (
        f"{subject} of profiled runs, {runs} a series, summed over threads: medians, with lines from the "
        "least to the greatest."
    )
    return Drawing(figure, caption)


def _bars(axes: Axes, rows: pd.DataFrame, quantity: str) -> None:
    heights = np.arange(len(rows))
    axes.barh(heights, rows["value"], color=BLUE, height=0.6)
    axes.hlines(heights, rows["least"], rows["greatest"], color=INK, linewidth=0.8)
    top = float(rows["greatest"].max())
    axes.set_xlim(0, top * 1.45 if top > 0 else 1)
    for height, row in enumerate(rows.itertuples()):
        known = not pd.isna(row.value)
        said, end = (number(row.value), row.greatest) if known else ("not counted", 0)
        note(axes, said, (end, height), (3, 0), va="center", fontsize=6.5)
    name_rows(axes, list(rows.index))
    axes.set_title(quantity, fontsize=7)
    axes.xaxis.set_visible(False)
    axes.spines["bottom"].set_visible(False)


def phases_against_limits(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the least that each phase's unavoidable work could take, and what it took: a row a series and
    phase, a panel a scene; None without profiled runs or measured limits.
    """
    runs, phases, threads = map(named, data.study.of(experiment, "runs", "phases", "threads"))
    table = against_limits(runs, phases, threads, data.study.limits)
    if table.empty:
        return None
    scenes = list(dict.fromkeys(table.sort_values(["particles", "scene_name"])["scene_name"]))
    series = list(dict.fromkeys(runs.sort_values("series_number")["series"]))
    known = set(zip(table["series"], table["phase"], strict=True))
    rows = [(name, phase) for name in series for phase in PHASES if (name, phase) in known]
    heights = {row: -(line + 0.6 * series.index(row[0])) for line, row in enumerate(rows)}
    figure, [grid] = new_grid(1.0 + 0.21 * len(rows) + 0.1 * len(series), 1, len(scenes), sharey=True)
    for axes, scene in zip(grid, scenes, strict=True):
        _limits(axes, table[table["scene_name"] == scene], heights)
        axes.set_title(scene_title(runs, scene))
    name_rows(grid[0], [phase for _, phase in rows], list(heights.values()))
    grid[0].set_ylim(min(heights.values()) - 0.6, 0.6)
    for name in series:
        own = [height for (one, _), height in heights.items() if one == name]
        look: Any = {"rotation": 90, "ha": "center", "va": "center", "fontsize": 7}
        if own:
            at = 0, sum(own) / len(own)
            note(grid[0], name, at, (-48, 0), xycoords=("axes fraction", "data"), **look)
    entries = [(f"{sign} {name}", colour) for name, _, sign, colour in DOTS.values()]
    key(figure, [*entries, ("the least in % of it", INK), ("% of it waiting", FAINT)])
    return Drawing(figure, _of_limits(subject, table, runs))


def _limits(axes: Axes, table: pd.DataFrame, heights: dict[tuple[str, str], float]) -> None:
    axes.set_xscale("log")
    for row in table.itertuples():
        height = heights[row.series, row.phase]
        axes.plot([row.least, row.wall], [height, height], color=lighten(FAINT), linewidth=2.5, zorder=1)
        for column, (name, mark, _, colour) in DOTS.items():
            value = getattr(row, column)
            told = f"{row.series}, {row.phase}: {name}", number(value)
            if value > 0:
                point(axes, value, height, mark, *told, color=colour, markersize=4, zorder=4)
        for right, part, colour in ((5, row.reached, INK), (38, 1 - row.busy / row.wall, FAINT)):
            said = f"{number(100 * part, 2)} %" if part < 0.1 else share(part)
            note(axes, said, (row.wall, height), (right, 0), color=colour, va="center", fontsize=6.5)
    axes.set_xlim(axes.get_xlim()[0], axes.get_xlim()[1] * 6)
    axes.set_xlabel("time per disc and step, ns")
    axes.tick_params(axis="y", length=0)
    plain_ticks(axes.xaxis)


def _of_limits(subject: str, table: pd.DataFrame, runs: pd.DataFrame) -> str:
    threads = count(int(table["threads"].iloc[0]), "thread")
    profiled = count(runs["file"].nunique(), "profiled run")
    copies = "; ".join(
        f"{number(1e-9 * row.copy_rate)} GB/s within {number(row.size / 2**20)} MiB ({row.level}) "
        f"for {scene_title(runs, row.scene_name)}"
        for row in table.drop_duplicates(["scene_name", "size"]).itertuples()
    )
    peak = number(1e-9 * table["arithmetic_rate"].max())
    ordered = table.merge(runs[["series", "series_number"]].drop_duplicates(), on="series")
    groups = ordered.groupby(["series_number", "particles", "scene_name"], dropna=False)
    said = "; ".join(_of_a_step(rows, runs) for _, rows in groups)
    return (
        f"{subject[0].upper()}{subject[1:]} ({threads}, medians of {profiled}). The least time is the "
        f"greater of two: the bytes that a phase must read and write at the copy bandwidth measured "
        f"({copies}), and the operations that it must do at the peak measured ({peak} Gflop/s); percentages "
        f"say how much of the time that is. {said}."
    )


def _of_a_step(rows: pd.DataFrame, runs: pd.DataFrame) -> str:
    """Say how much of a whole step is unavoidable, and what fills the rest in its longest phase."""
    first = rows.iloc[0]
    longest: Any = rows.loc[rows["wall"].idxmax()]
    one = runs[(runs["scene_name"] == first["scene_name"]) & (runs["series"] == first["series"])]
    work = one[["overlaps", "pair_resolves", "sweeps"]].div(one["steps"] * one["substeps"], axis=0).median()
    waiting = 1 - longest["busy"] / longest["wall"]
    return (
        f"{first['series']}, {scene_title(runs, first['scene_name'])}: {number(rows['wall'].sum())} ns per "
        f"disc and step, {share(rows['least'].sum() / rows['wall'].sum())} of it unavoidable; longest is "
        f"{longest['phase']} ({share(longest['reached'])} by {longest['bound']}, {share(waiting)} waiting), "
        f"with {number(work['overlaps'])} overlaps, {number(work['pair_resolves'])} resolves and "
        f"{number(work['sweeps'])} sweeps a step"
    )


def timeline(data: Data) -> Drawing | None:
    """Draw the step of median length of every timeline in the results folder, at most six, on a common time
    axis. They do not say whose they are: they stand with the first study that has profiled runs.
    """
    profiled = (one for one in data.studies if not one.phases.empty)
    found = timelines.load(data.folder)[:MOST] if data.study is next(profiled, data.studies[0]) else []
    if not found:
        return None
    titles = [_in_words(one.title, data.study.runs) for one in found]
    steps = [timelines.one_step(one.spans) for one in found]
    longest = 1e3 * max(step["end"].max() for step in steps)
    rows = [int(step["thread"].nunique()) for step in steps]
    height = 0.6 + sum(0.45 + 0.22 * count for count in rows)
    figure, columns = new_grid(height, len(found), sharex=True, height_ratios=rows)
    for axes, title, step in zip(columns[:, 0], titles, steps, strict=True):
        _lanes(axes, step, longest)
        axes.set_title(title)
    entries = [(f"■ {phase}", colour) for phase, colour in PHASE_COLOURS.items()]
    key(figure, [*entries, ("■ waiting", FAINT), ("pale: serial part of the phase", INK)])
    columns[-1, 0].set_xlabel("time since the step began, ms")
    said = "; ".join(f"{title}: {_of_one_step(step)}" for title, step in zip(titles, steps, strict=True))
    runs = count(len(found), "profiled run")
    return Drawing(figure, f"The step of median length of {runs}, thread by thread. {said}.")


def _in_words(title: str, runs: pd.DataFrame) -> str:
    """Return a timeline's title with its scene in words instead of its file, where the records know it."""
    variant, _, rest = title.partition(", ")
    file, _, threads = rest.rpartition(", ")
    known = runs.loc[runs["scene"] == file, ["particles", "area_fraction"]].drop_duplicates()
    if len(known) != 1:
        return title
    return f"{variant}, {scene_in_words(*known.iloc[0])}, {threads}"


def _lanes(axes: Axes, step: pd.DataFrame, longest: float) -> None:
    """Draw who works on what, and who waits, a lane a thread."""
    threads = sorted(step["thread"].unique(), reverse=True)
    working = "chunk" if (step["kind"] == "chunk").any() else "loop"
    for (kind, phase, thread), spans in step.groupby(["kind", "phase", "thread"]):
        bars = list(zip(1e3 * spans["begin"], 1e3 * (spans["end"] - spans["begin"]), strict=True))
        row, colour = threads.index(thread), PHASE_COLOURS.get(phase, FAINT)
        # Thousands of chunks would make the vector formats huge: those alone become pixels.
        style: dict[str, Any] = {"linewidth": 0, "rasterized": len(bars) > MANY}
        if kind == "phase":
            axes.broken_barh(bars, (-0.5, len(threads)), color=lighten(colour, 0.75), zorder=1, **style)
        elif kind == "wait":
            axes.broken_barh(bars, (row - 0.1, 0.2), color=FAINT, zorder=3, **style)
        elif kind == working:
            edged = np.median([width for _, width in bars]) > EDGED_FROM * longest
            style |= {"facecolor": colour, "edgecolor": "white", "linewidth": 0.3 if edged else 0}
            axes.broken_barh(bars, (row - 0.35, 0.7), zorder=2, **style)
    name_rows(axes, [f"thread {thread}" for thread in threads])
    axes.set_ylim(-0.5, len(threads) - 0.5)
    axes.spines["left"].set_visible(False)


def _of_one_step(step: pd.DataFrame) -> str:
    seconds = (step["end"] - step["begin"]).groupby(step["kind"]).sum()
    phases = seconds.get("phase", 0.0)
    chunks = int((step["kind"] == "chunk").sum())
    waiting = seconds.get("wait", 0.0) / max(phases * step["thread"].nunique(), 1e-12)
    taken = f", {count(chunks, 'chunk')}" if chunks else ""
    return f"{number(1e3 * phases)} ms{taken}, {share(waiting)} of the threads' time waiting"
