"""A ladder as a waterfall: each rung from the time of the rung before to its own, a panel a scene."""

import math

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.derived.ladder import RUNG, claims, factors, rungs, scene_title, speed_up, tables_of, totals
from analysis.figures.hover import Told, point
from analysis.figures.labels import logarithmic_ticks, name_rows
from analysis.figures.style import FAINT, GREEN, INK, VERMILLION, Data, Drawing, lighten, new_grid
from analysis.statistics.verdicts import MARGIN
from analysis.support.values import Row, Table, table_of
from analysis.support.wording import count, interval_of, number, share

COLUMNS = 2
ROW_HEIGHT = 0.2
COLOURS = {"faster": GREEN, "slower": VERMILLION}


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
    figure, panels = _panels(len(scenes), len(names) + 1)
    for scene, (axes, margin) in zip(scenes, panels, strict=True):
        rows = _rows(table, steps, scene, names)
        total = whole.loc[scene] if scene in whole.index else None
        _bars(axes, rows, names, total is not None)
        _figures(margin, rows, names, total)
        axes.set_title(scene_title(runs, scene), pad=13)
    caption = _caption(subject, runs, times, table, data.study.failed_checks(experiment))
    return Drawing(figure, caption, _verdicts(steps, table, runs), [_short_names(table)])


def _short_names(rungs: pd.DataFrame) -> Table:
    """Return the short name of each rung beside what it changes and the name of its variant."""
    rows = rungs.drop_duplicates("series_number").sort_values("series_number")
    cells = rows[["series", "change", "variant"]].astype(str).to_numpy()
    title = "The rungs by their short names, with the names by which the program knows them:"
    return table_of(title, ["Rung", "Changes", "Variant (carom list)"], cells)


def _rows(table: pd.DataFrame, steps: pd.DataFrame, scene: str, names: pd.Series) -> list[Row]:
    """Return the scene's rungs in order, with the `before` of each and its `verdict` against the rung
    before, where that was measured.
    """
    judged = steps[[*RUNG, "ratio", "verdict"]]
    rows = table[table["scene_name"] == scene].merge(judged, on=RUNG, how="left")
    rows = rows.sort_values("series_number")
    before = rows.set_index("series_number")["nanoseconds"].reindex(names.index).shift()
    return list(rows.assign(before=rows["series_number"].map(before)).to_dict("records"))


def _panels(scenes: int, rows: int) -> tuple[Figure, list[tuple[Axes, Axes]]]:
    """Return a pair of axes a scene: one for the bars, one for the figures beside them."""
    columns = min(scenes, COLUMNS)
    lines = math.ceil(scenes / columns)
    height = lines * (0.85 + ROW_HEIGHT * rows)
    figure, grid = new_grid(height, lines, 2 * columns, width_ratios=[1.0, 1.3] * columns)
    axes = grid.ravel()
    for unused in axes[2 * scenes :]:
        unused.set_visible(False)
    return figure, list(zip(axes[::2], axes[1::2], strict=True))[:scenes]


def _bars(axes: Axes, rows: list[Row], names: pd.Series, has_both_ends: bool) -> None:
    heights = {rung: -float(line) for line, rung in enumerate(names.index)}
    axes.set_xscale("log")
    axes.use_sticky_edges = False  # A bar begins at a time, not at the axis.
    for row in rows:
        height = heights[row["series_number"]]
        colour = COLOURS.get(row["verdict"], FAINT) if pd.notna(row["before"]) else INK
        if pd.notna(row["before"]):
            axes.plot([row["before"]] * 2, [height + 1, height], color=FAINT, linewidth=0.6, zorder=1)
            left, right = sorted((row["before"], row["nanoseconds"]))
            axes.barh(height, right - left, left=left, color=colour, height=0.55, zorder=2)
        axes.plot([row["low"], row["high"]], [height, height], color=INK, linewidth=1.4, zorder=3)
        told = Told(names[row["series_number"]], interval_of(row, "nanoseconds"))
        point(axes, row["nanoseconds"], height, "o", told, color=INK, markersize=3, zorder=4)
    if has_both_ends:
        first, last = rows[0]["nanoseconds"], rows[-1]["nanoseconds"]
        left, width = min(first, last), abs(first - last)
        axes.barh(-len(names), width, left=left, color=lighten(FAINT), height=0.3, zorder=2)
    axes.set_ylim(-len(names) - 0.6, 0.6)
    spec = axes.get_subplotspec()
    labelled = spec is None or spec.is_first_col()
    ticks = [*heights.values(), -len(names)]
    name_rows(axes, [*names, "in all"] if labelled else [""] * len(ticks), ticks)
    axes.set_xlabel("time per disc and step, ns")
    logarithmic_ticks(axes.xaxis, most=4)


def _figures(axes: Axes, rows: list[Row], names: pd.Series, total: pd.Series | None) -> None:
    """Write what each rung gains and does beside its bar."""
    heights = {rung: -float(line) for line, rung in enumerate(names.index)}
    columns = {"ns": 0.1, "factor": 0.37, "resolves": 0.65, "sweeps": 0.91, "✓": 1.0}
    for heading, end in columns.items():
        _write(axes, end, 0.75, heading, FAINT, "bottom")
    for row in rows:
        wrong = row["passed"] < row["records"] or pd.isna(row["nanoseconds"])
        for end, text in zip(columns.values(), _cells(row), strict=True):
            _write(axes, end, heights[row["series_number"]], text, VERMILLION if wrong else INK, "center")
    for rung in set(names.index) - {row["series_number"] for row in rows}:
        _write(axes, columns["sweeps"], heights[rung], "no result", VERMILLION, "center")
    if total is not None:
        _write(axes, columns["sweeps"], -len(names), speed_up(total), INK, "center", "bold")
    axes.set(xlim=(0, 1), ylim=(-len(names) - 0.6, 0.6))
    axes.axis("off")


def _write(
    axes: Axes, end: float, height: float, text: str, colour: str, vertical: str, weight: str = "normal"
) -> None:
    axes.text(end, height, text, fontsize=6, color=colour, weight=weight, ha="right", va=vertical)


def _cells(row: Row) -> list[str]:
    time = number(row["nanoseconds"]) if pd.notna(row["nanoseconds"]) else "none"
    factor = f"× {number(1 / row['ratio'])}" if pd.notna(row["ratio"]) else ""
    checked = "✓" if row["passed"] == row["records"] else "✗"
    return [time, factor, number(row["resolves"]), number(row["sweeps"]), checked]


def _verdicts(steps: pd.DataFrame, table: pd.DataFrame, runs: pd.DataFrame) -> pd.DataFrame:
    changes = table.set_index(RUNG)["change"]
    places = steps[RUNG].itertuples(index=False, name=None)
    names = [f"{scene_title(runs, scene)}: {changes[scene, rung]}" for scene, rung in places]
    return steps.assign(name=names)


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
    said = "; ".join(f"{row['change']} {number(row['instructions'])}" for row in counted.to_dict("records"))
    return f"Instructions per disc and step ({', '.join(sorted(set(counted['source'])))}): {said}."
