"""Each phase against the machine: the least that its unavoidable work could take, and what it took."""

from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.ladder import named, scene_title
from analysis.derived.limits import ARITHMETIC, COPY, against_limits
from analysis.derived.unavoidable import PHASES
from analysis.figures.hover import Told, point
from analysis.figures.labels import key, note, plain_ticks
from analysis.figures.style import BLUE, FAINT, INK, ORANGE, Data, Drawing, lighten, new_grid
from analysis.support.wording import count, number, share

DOTS = {
    COPY: ("least by copying", "<", "◂", BLUE),
    ARITHMETIC: ("least by arithmetic", "d", "◆", ORANGE),
    "wall": ("measured", "o", "●", INK),
}
"""What is drawn of a phase, by column: what it is called, its mark, that of the key, and its colour."""


def phases_against_limits(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw a row a series and phase, a panel a scene; None without profiled runs or measured limits."""
    runs, phases, threads = map(named, data.study.of(experiment, "runs", "phases", "threads"))
    table = against_limits(runs, phases, threads, data.study.limits)
    if table.empty:
        return None
    scenes = list(dict.fromkeys(table.sort_values(["particles", "scene_name"])["scene_name"]))
    series = list(dict.fromkeys(runs.sort_values("series_number")["series"]))
    known = set(zip(table["series"], table["phase"], strict=True))
    rows = [(name, phase) for name in series for phase in PHASES if (name, phase) in known]
    height = 1.0 + 0.21 * len(rows) + 0.1 * len(series)
    figure, [grid] = new_grid(height, 1, len(scenes), sharey=True)
    for axes, scene in zip(grid, scenes, strict=True):
        _panel(axes, table[table["scene_name"] == scene], rows)
        axes.set_title(" ", pad=16)
        axes.tick_params(axis="y", length=0)
        note(axes, scene_title(runs, scene), (0, 1), (0, 4), xycoords="axes fraction")
    _names(grid[0], rows)
    entries = [(f"{sign} {name}", colour) for name, _, sign, colour in DOTS.values()]
    key(grid[0], [*entries, ("the least in % of it", INK), ("% of it waiting", FAINT)], raised=16)
    return Drawing(figure, _caption(subject, table, runs))


def _heights(rows: list[tuple[str, str]]) -> dict[tuple[str, str], float]:
    """Return the height of each row, from above, with a gap between the series."""
    series = list(dict.fromkeys(name for name, _ in rows))
    return {row: -(line + 0.6 * series.index(row[0])) for line, row in enumerate(rows)}


def _panel(axes: Axes, table: pd.DataFrame, rows: list[tuple[str, str]]) -> None:
    heights = _heights(rows)
    axes.set_xscale("log")
    for row in table.to_dict("records"):
        height = heights[row["series"], row["phase"]]
        ends = [row["least"], row["wall"]]
        axes.plot(ends, [height, height], color=lighten(FAINT), linewidth=2.5, zorder=1)
        for column, (name, mark, _, colour) in DOTS.items():
            told = Told(f"{row['series']}, {row['phase']}: {name}", number(row[column]))
            if row[column] > 0:
                point(axes, row[column], height, mark, told, color=colour, markersize=4, zorder=4)
        waiting = 1 - row["busy"] / row["wall"]
        for right, part, colour in ((5, row["reached"], INK), (38, waiting, FAINT)):
            at = row["wall"], height
            note(axes, _percent(part), at, (right, 0), color=colour, va="center", fontsize=6.5)
    axes.set_xlim(axes.get_xlim()[0], axes.get_xlim()[1] * 6)
    axes.set_xlabel("time per disc and step, ns")
    plain_ticks(axes.xaxis)


def _percent(fraction: float) -> str:
    return f"{number(100 * fraction, 2)} %" if fraction < 0.1 else share(fraction)


def _names(axes: Axes, rows: list[tuple[str, str]]) -> None:
    heights = _heights(rows)
    axes.set_yticks(list(heights.values()), [phase for _, phase in rows])
    axes.set_ylim(min(heights.values()) - 0.6, 0.6)
    for name in dict.fromkeys(name for name, _ in rows):
        middle = [height for (series, _), height in heights.items() if series == name]
        look: Any = {"rotation": 90, "ha": "center", "va": "center", "fontsize": 7}
        at = 0, sum(middle) / len(middle)
        note(axes, name, at, (-48, 0), xycoords=("axes fraction", "data"), **look)


def _caption(subject: str, table: pd.DataFrame, runs: pd.DataFrame) -> str:
    threads = count(int(table["threads"].iloc[0]), "thread")
    profiled = count(runs["file"].nunique(), "profiled run")
    sizes = table.drop_duplicates(["scene_name", "size"]).to_dict("records")
    copies = "; ".join(
        f"{number(1e-9 * row['copy_rate'])} GB/s within {number(row['size'] / 2**20)} MiB ({row['level']}) "
        f"for {scene_title(runs, row['scene_name'])}"
        for row in sizes
    )
    peak = number(1e-9 * table["arithmetic_rate"].max())
    ordered = table.merge(runs[["series", "series_number"]].drop_duplicates(), on="series")
    groups = ordered.groupby(["series_number", "particles", "scene_name"], dropna=False)
    said = "; ".join(_sentence(rows, runs) for _, rows in groups)
    return (
        f"{subject[0].upper()}{subject[1:]} ({threads}, medians of {profiled}). The least time is the "
        f"greater of two: the bytes that a phase must read and write at the copy bandwidth measured "
        f"({copies}), and the operations that it must do at the peak measured ({peak} Gflop/s); percentages "
        f"say how much of the time that is. {said}."
    )


def _sentence(rows: pd.DataFrame, runs: pd.DataFrame) -> str:
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
