"""A ladder as a waterfall: each rung from the time of the rung before to its own, a panel a scene."""

import math
from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.ladder import RUNG, claims, factors, rungs, scene_title, speed_up, tables_of, totals
from analysis.figures.labels import logarithmic_ticks, name_rows
from analysis.figures.style import FAINT, GREEN, INK, VERMILLION, Data, Drawing, lighten, new_grid, point
from analysis.statistics.verdicts import MARGIN
from analysis.support.values import table_of
from analysis.support.wording import count, interval_of, number, share

COLUMNS = 2
ROW_HEIGHT = 0.2
COLOURS = {"faster": GREEN, "slower": VERMILLION}
ENDS = {"ns": 0.1, "factor": 0.37, "resolves": 0.65, "sweeps": 0.91, "✓": 1.0}
"""What stands beside the bars, and where each column ends."""


def waterfall(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw an experiment's series in the order of its question, each against the one before, by scene."""
    tables = tables_of(data.study, experiment)
    if tables is None:
        return None
    runs, times = tables
    table = rungs(runs, times, data.study.counters)
    steps, whole = factors(times), totals(times).set_index("scene_name")
    scenes = list(dict.fromkeys(table.sort_values(["particles", "radius", "scene_name"])["scene_name"]))
    names = table.drop_duplicates("series_number").set_index("series_number")["change"].sort_index()
    columns = min(len(scenes), COLUMNS)
    lines = math.ceil(len(scenes) / columns)
    height = lines * (0.85 + ROW_HEIGHT * (len(names) + 1))
    figure, grid = new_grid(height, lines, 2 * columns, width_ratios=[1.0, 1.3] * columns)
    panels = list(grid.ravel())
    for unused in panels[2 * len(scenes) :]:
        unused.set_visible(False)
    for number_of, scene in enumerate(scenes):
        axes, beside = panels[2 * number_of : 2 * number_of + 2]
        rows = _rows(table, steps, scene, names)
        total = whole.loc[scene] if scene in whole.index else None
        _bars(axes, rows, names, has_both_ends=total is not None, is_named=number_of % columns == 0)
        _figures(beside, rows, names, total)
        axes.set_title(scene_title(runs, scene), pad=13)
    failed = data.study.failed_checks(experiment)
    changes = table.set_index(RUNG)["change"]
    places = steps[RUNG].itertuples(index=False, name=None)
    verdicts = steps.assign(name=[f"{scene_title(runs, one)}: {changes[one, rung]}" for one, rung in places])
    known = table.drop_duplicates("series_number").sort_values("series_number")
    title = "The rungs by their short names, with the names by which the program knows them:"
    cells = known[["series", "change", "variant"]].astype(str).to_numpy()
    short_names = table_of(title, ["Rung", "Changes", "Variant (carom list)"], cells)
    return Drawing(figure, _caption(subject, runs, times, table, failed), verdicts, [short_names])


def _rows(table: pd.DataFrame, steps: pd.DataFrame, scene: str, names: pd.Series) -> pd.DataFrame:
    """Return the scene's rungs in order, with the `height` of each, the time `before` it and its `verdict`
    against the rung before, where that was measured.
    """
    judged = steps[[*RUNG, "ratio", "verdict"]]
    rows = table[table["scene_name"] == scene].merge(judged, on=RUNG, how="left").sort_values("series_number")
    before = rows.set_index("series_number")["nanoseconds"].reindex(names.index).shift()
    heights = {rung: -float(line) for line, rung in enumerate(names.index)}
    numbers = rows["series_number"]
    return rows.assign(before=numbers.map(before), height=numbers.map(heights), told=numbers.map(names))


def _bars(axes: Axes, rows: pd.DataFrame, names: pd.Series, *, has_both_ends: bool, is_named: bool) -> None:
    axes.set_xscale("log")
    axes.use_sticky_edges = False  # A bar begins at a time, not at the axis.
    for row in rows.itertuples():
        if pd.notna(row.before):
            axes.plot([row.before] * 2, [row.height + 1, row.height], color=FAINT, linewidth=0.6, zorder=1)
            left, right = sorted((row.before, row.nanoseconds))
            colour = COLOURS.get(row.verdict, FAINT)
            axes.barh(row.height, right - left, left=left, color=colour, height=0.55, zorder=2)
        axes.plot([row.low, row.high], [row.height] * 2, color=INK, linewidth=1.4, zorder=3)
        told = row.told, interval_of(row, "nanoseconds")
        point(axes, row.nanoseconds, row.height, "o", *told, color=INK, markersize=3, zorder=4)
    if has_both_ends:
        left, right = sorted(rows["nanoseconds"].iloc[[0, -1]])
        axes.barh(-len(names), right - left, left=left, color=lighten(FAINT), height=0.3, zorder=2)
    axes.set_ylim(-len(names) - 0.6, 0.6)
    ticks = [-float(line) for line in range(len(names) + 1)]
    name_rows(axes, [*names, "in all"] if is_named else [""] * len(ticks), ticks)
    axes.set_xlabel("time per disc and step, ns")
    logarithmic_ticks(axes.xaxis, most=4)


def _figures(axes: Axes, rows: pd.DataFrame, names: pd.Series, total: pd.Series | None) -> None:
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


def _caption(subject: str, runs: pd.DataFrame, times: pd.DataFrame, table: pd.DataFrame, failed: int) -> str:
    processes = count(times["file"].nunique(), "process")
    threads = count(int(times["threads"].iloc[0]), "thread")
    results = count(int(table["passed"].sum()) + failed, "result")
    checks = f"{failed} of {results} failed" if failed else f"all {results} passed"
    scopes = " and ".join(sorted(runs["check_scope"].unique()))
    return (
        f"{subject[0].upper()}{subject[1:]} ({threads}). {'; '.join(claims(runs, times))}. Each rung "
        f"changes one choice of the rung above it; its bar runs from that rung's time to its own (dot: "
        f"median, line: 95 % bootstrap interval), green if faster and red if slower by more than "
        f"{share(MARGIN)}, Holm-corrected, pale if neither is settled. Factors are of paired times within "
        f"{count(times['block'].nunique(), 'block')}, from {processes}, none left out. Resolves and sweeps "
        f"are per step. Checks ({scopes}): {checks}. {_instructions(table)}"
    )


def _instructions(table: pd.DataFrame) -> str:
    """Say how many instructions the rungs take, where they were counted."""
    counted = table[table["instructions"].notna()]
    if counted.empty:
        return "Instructions were not counted: no profiled run of these variants and scenes has them."
    said = "; ".join(f"{row.change} {number(row.instructions)}" for row in counted.itertuples())
    return f"Instructions per disc and step ({', '.join(sorted(set(counted['source'])))}): {said}."
