"""Where the time of a step goes, from profiled runs: its phases, what counters tell of them, how near they
are to the limits of the machine, and a step on every thread; and a ladder as a waterfall, each rung from the
time of the rung before to its own, a panel a scene.
"""

import math
from collections.abc import Sequence
from itertools import zip_longest
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.claims.entry import Evidence
from analysis.derived.counters import QUANTITIES, derived
from analysis.derived.ladder import (
    RUNG,
    claims,
    factors,
    named,
    rungs,
    scene_title,
    speed_up,
    tables_of,
    totals,
)
from analysis.derived.limits import ARITHMETIC, COPY, against_limits, busy_shares
from analysis.derived.unavoidable import PHASES
from analysis.figures.captions import caption
from analysis.figures.kinds import mark
from analysis.figures.labels import key, logarithmic_ticks, name_rows, note, plain_ticks
from analysis.figures.style import (
    BLUE,
    FAINT,
    GREEN,
    INK,
    ORANGE,
    VERMILLION,
    Drawing,
    Look,
    lighten,
    new_figure,
    new_grid,
)
from analysis.records import timelines
from analysis.statistics.verdicts import MARGIN
from analysis.support.wording import interval_of, number, scene_in_words, share

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


def profile(data: Evidence, experiment: str, subject: str) -> Drawing | None:
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
    seconds = table[table["series"] == first][["serial_seconds", "wall_seconds"]].sum()
    busy = threads.groupby(["series", "phase", "file"])["busy_seconds"]
    uneven = (busy.max() / busy.mean()).groupby(["series", "phase"]).median()
    scenes = table[["particles", "area_fraction"]].drop_duplicates().to_numpy()
    return caption(
        "phases", subject=subject, scenes=[scene_in_words(*scene) for scene in scenes], first=first,
        threads=int(table["threads"].max()), runs=table["file"].nunique(), shares=shares.loc[first],
        serial=seconds["serial_seconds"] / seconds["wall_seconds"],
        uneven=uneven.max(), where=uneven.idxmax(),
    )  # fmt: skip


def panels(data: Evidence, experiment: str, subject: str, source: str) -> Drawing | None:
    """Draw what one source counted of the published variants, a panel a quantity: sources are never mixed."""
    (counters,) = data.study.of(experiment, "counters")
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
    return Drawing(figure, caption("counters", subject=subject, runs=int(rows["runs"].max())))


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


def phases_against_limits(data: Evidence, experiment: str, subject: str) -> Drawing | None:
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
        for column, (name, shape, _, colour) in DOTS.items():
            value = getattr(row, column)
            told = f"{row.series}, {row.phase}: {name}", number(value)
            if value > 0:
                mark(axes, (value, height), Look(colour, shape), *told, size=4)
        for right, part, colour in ((5, row.reached, INK), (38, 1 - row.busy / row.wall, FAINT)):
            said = f"{number(100 * part, 2)} %" if part < 0.1 else share(part)
            note(axes, said, (row.wall, height), (right, 0), color=colour, va="center", fontsize=6.5)
    axes.set_xlim(axes.get_xlim()[0], axes.get_xlim()[1] * 6)
    axes.set_xlabel("time per disc and step, ns")
    axes.tick_params(axis="y", length=0)
    plain_ticks(axes.xaxis)


def _of_limits(subject: str, table: pd.DataFrame, runs: pd.DataFrame) -> str:
    copies = table.drop_duplicates(["scene_name", "size"]).itertuples()
    ordered = table.merge(runs[["series", "series_number"]].drop_duplicates(), on="series")
    groups = ordered.groupby(["series_number", "particles", "scene_name"], dropna=False)
    return caption(
        "limits", subject=subject, threads=int(table["threads"].iloc[0]), runs=runs["file"].nunique(),
        rates=[(scene_title(runs, row.scene_name), row) for row in copies],
        peak=table["arithmetic_rate"].max(), steps=[_of_a_step(rows, runs) for _, rows in groups],
    )  # fmt: skip


def _of_a_step(rows: pd.DataFrame, runs: pd.DataFrame) -> dict[str, Any]:
    """Return how much of a whole step is unavoidable, its longest phase, and its work."""
    series, scene = rows[["series", "scene_name"]].iloc[0]
    one = runs[(runs["scene_name"] == scene) & (runs["series"] == series)]
    work = one[["overlaps", "pair_resolves", "sweeps"]].div(one["steps"] * one["substeps"], axis=0).median()
    found = {"series": series, "scene": scene_title(runs, scene), "longest": rows.loc[rows["wall"].idxmax()]}
    return {**found, "work": work, **rows[["wall", "least"]].sum()}


def timeline(data: Evidence, experiment: str, subject: str) -> Drawing | None:  # noqa: ARG001 - of all experiments
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
    height = 0.6 + sum(0.45 + 0.22 * lanes for lanes in rows)
    figure, columns = new_grid(height, len(found), sharex=True, height_ratios=rows)
    for axes, title, step in zip(columns[:, 0], titles, steps, strict=True):
        _lanes(axes, step, longest)
        axes.set_title(title)
    entries = [(f"■ {phase}", colour) for phase, colour in PHASE_COLOURS.items()]
    key(figure, [*entries, ("■ waiting", FAINT), ("pale: serial part of the phase", INK)])
    columns[-1, 0].set_xlabel("time since the step began, ms")
    told = list(zip(titles, map(_of_one_step, steps), strict=True))
    return Drawing(figure, caption("timeline", subject=subject, steps=told))


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


def _of_one_step(step: pd.DataFrame) -> dict[str, float]:
    """Return the seconds of a step's `phases`, its `chunks`, and the share of the threads' time `waiting`."""
    seconds = (step["end"] - step["begin"]).groupby(step["kind"]).sum()
    phases = seconds.get("phase", 0.0)
    waiting = seconds.get("wait", 0.0) / max(phases * step["thread"].nunique(), 1e-12)
    return {"phases": phases, "chunks": int((step["kind"] == "chunk").sum()), "waiting": waiting}


SCENES_BESIDE, ROW_HEIGHT = 2, 0.2
JUDGED = {"faster": GREEN, "slower": VERMILLION}
ENDS = {"ns": 0.1, "factor": 0.37, "resolves": 0.65, "sweeps": 0.91, "✓": 1.0}
"""What stands beside the bars, and where each column ends."""


def waterfall(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw an experiment's series in the order of its question, each against the one before, by scene."""
    tables = tables_of(data.study, experiment)
    if tables is None:
        return None
    runs, times = tables
    table = rungs(runs, times, data.study.counters)
    steps, whole = factors(times), totals(times).set_index("scene_name")
    scenes = list(dict.fromkeys(table.sort_values(["particles", "radius", "scene_name"])["scene_name"]))
    names = table.drop_duplicates("series_number").set_index("series_number")["change"].sort_index()
    columns = min(len(scenes), SCENES_BESIDE)
    lines = math.ceil(len(scenes) / columns)
    height = lines * (0.85 + ROW_HEIGHT * (len(names) + 1))
    figure, grid = new_grid(height, lines, 2 * columns, width_ratios=[1.0, 1.3] * columns)
    for unused in grid.ravel()[2 * len(scenes) :]:
        unused.set_visible(False)
    for number_of, (scene, (axes, beside)) in enumerate(zip(scenes, grid.reshape(-1, 2), strict=False)):
        rows = _rungs(table, steps, scene, names)
        total = whole.loc[scene] if scene in whole.index else None
        _waterfall(axes, rows, names, has_both_ends=total is not None, is_named=number_of % columns == 0)
        _columns(beside, rows, names, total)
        axes.set_title(scene_title(runs, scene), pad=13)
    changes = table.set_index(RUNG)["change"]
    places = steps[RUNG].itertuples(index=False, name=None)
    verdicts = steps.assign(name=[f"{scene_title(runs, one)}: {changes[one, rung]}" for one, rung in places])
    known = table.drop_duplicates("series_number").sort_values("series_number")
    short_names = "rungs", {"rows": known[["series", "change", "variant"]]}
    failed, counted = data.study.failed_checks(experiment), table[table["instructions"].notna()]
    told = caption(
        "ladder", subject=subject, threads=int(times["threads"].iloc[0]), margin=MARGIN,
        totals=claims(runs, times), blocks=times["block"].nunique(), processes=times["file"].nunique(),
        scopes=sorted(runs["check_scope"].unique()), failed=failed,
        results=int(table["passed"].sum()) + failed,
        counted=list(counted.itertuples()), sources=sorted(set(counted["source"])),
    )  # fmt: skip
    return Drawing(figure, told, verdicts, [short_names])


def _rungs(table: pd.DataFrame, steps: pd.DataFrame, scene: str, names: pd.Series) -> pd.DataFrame:
    """Return the scene's rungs in order, with the `height` of each, the time `before` it and its `verdict`
    against the rung before, where that was measured.
    """
    judged = steps[[*RUNG, "ratio", "verdict"]]
    rows = table[table["scene_name"] == scene].merge(judged, on=RUNG, how="left").sort_values("series_number")
    before = rows.set_index("series_number")["nanoseconds"].reindex(names.index).shift()
    heights = {rung: -float(line) for line, rung in enumerate(names.index)}
    numbers = rows["series_number"]
    return rows.assign(before=numbers.map(before), height=numbers.map(heights), told=numbers.map(names))


def _waterfall(
    axes: Axes, rows: pd.DataFrame, names: pd.Series, *, has_both_ends: bool, is_named: bool
) -> None:  # fmt: skip
    def bar(height: float, times: Sequence[float], colour: str, thickness: float) -> None:
        left, right = sorted(times)
        axes.barh(height, right - left, left=left, color=colour, height=thickness, zorder=2)

    axes.set_xscale("log")
    axes.use_sticky_edges = False  # A bar begins at a time, not at the axis.
    for row in rows.itertuples():
        if pd.notna(row.before):
            axes.plot([row.before] * 2, [row.height + 1, row.height], color=FAINT, linewidth=0.6, zorder=1)
            bar(row.height, (row.before, row.nanoseconds), JUDGED.get(row.verdict, FAINT), 0.55)
        told, ends = (row.told, interval_of(row, "nanoseconds")), (row.low, row.high)
        mark(axes, (row.nanoseconds, row.height), Look(INK), *told, across=ends, size=3, width=1.4)
    if has_both_ends:
        bar(-len(names), rows["nanoseconds"].iloc[[0, -1]], lighten(FAINT), 0.3)
    axes.set_ylim(-len(names) - 0.6, 0.6)
    ticks = [-float(line) for line in range(len(names) + 1)]
    name_rows(axes, [*names, "in all"] if is_named else [""] * len(ticks), ticks)
    axes.set_xlabel("time per disc and step, ns")
    logarithmic_ticks(axes.xaxis, most=4)


def _columns(axes: Axes, rows: pd.DataFrame, names: pd.Series, total: pd.Series | None) -> None:
    """Write what each rung gains and does beside its bar."""

    def write(end: float, height: float, text: str, colour: str = INK, **more: str) -> None:
        look: Any = {"fontsize": 6, "color": colour, "ha": "right", "va": "center", **more}
        axes.text(end, height, text, **look)

    for heading, end in ENDS.items():
        write(end, 0.75, heading, FAINT, va="bottom")
    for row in rows.itertuples():
        is_wrong = row.passed < row.records or pd.isna(row.nanoseconds)
        cells = (
            number(row.nanoseconds) if pd.notna(row.nanoseconds) else "none",
            f"× {number(1 / row.ratio)}" if pd.notna(row.ratio) else "",
            number(row.resolves),
            number(row.sweeps),
            "✓" if row.passed == row.records else "✗",
        )
        for end, text in zip(ENDS.values(), cells, strict=True):
            write(end, row.height, text, VERMILLION if is_wrong else INK)
    for line, rung in enumerate(names.index):
        if rung not in set(rows["series_number"]):
            write(ENDS["sweeps"], -line, "no result", VERMILLION)
    if total is not None:
        write(ENDS["sweeps"], -len(names), speed_up(total), weight="bold")
    axes.set(xlim=(0, 1), ylim=(-len(names) - 0.6, 0.6))
    axes.axis("off")
