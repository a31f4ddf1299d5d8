"""The picture of what `carom compare` finds: intervals on one axis, and each block of them."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from analysis.commands.programs_compared import asked, times_of
from analysis.derived.comparisons import Stated, differences, reference, stated
from analysis.figures.kinds import forest, of_ratio, shade
from analysis.figures.style import FAINT, PALETTE, Drawing, Look, lighten, new_grid, save, styled
from analysis.statistics.pairs import log_ratios
from analysis.statistics.verdicts import INCONCLUSIVE
from support.errors import InputError
from support.vocabulary import AGAIN

_ROW, _BLOCKS_PANEL = 0.36, 1.9
"""Inches: a row of the intervals, and the panel of the blocks."""


def programs_picture(results: Path) -> Path:
    """Draw what a results folder says of compared commands; return the SVG, a file in that folder. Raises
    InputError where nothing is measured yet.
    """
    times = times_of(results)
    if times.empty:
        raise InputError(f"{results}: holds no comparison to draw")
    against = reference(times)
    table = _rows(times, against, asked(results)["cases"])
    with styled("compared"):
        drawing = Drawing(_figure(times, table, against, stated(times)), "")
        [file] = save(drawing, results, "compared")
    return file


def _rows(times: pd.DataFrame, against: str, cases: Sequence[str]) -> pd.DataFrame:
    """Return a row a comparison, the control's first, with the `name` and the `colour` of each, and its
    `changes`, those of its blocks in per cent, in the order of time.
    """
    table = differences(times, against)
    table["is_control"] = table["series"] == against + AGAIN
    table = table.sort_values(["is_control", "x", "series"], ascending=[False, False, False])
    names = list(dict.fromkeys(table.loc[~table["is_control"], "series"]))
    shades = {name: PALETTE[number % len(PALETTE)] for number, name in enumerate(reversed(names))}
    labels = [f"{cases[int(row.x)]}, {row.series}" if cases else row.series for row in table.itertuples()]
    first, others = (times[(times["series"] == against) == side] for side in (True, False))
    pairs = log_ratios(first, others, match=("x",), by=("series",))
    each = dict(iter(pairs.groupby(["series", "x"])["log_ratio"]))
    return table.assign(
        name=labels,
        colour=[shades.get(name, FAINT) for name in table["series"]],
        changes=[100 * np.expm1(each[row.series, row.x]) for row in table.itertuples()],
    )


def _figure(times: pd.DataFrame, table: pd.DataFrame, against: str, by: Stated) -> Figure:
    is_one_case = times["x"].nunique() == 1
    heights = [0.6 + _ROW * len(table)] + ([_BLOCKS_PANEL] if is_one_case else [])
    figure, grid = new_grid(sum(heights), len(heights), height_ratios=heights)
    panels = grid[:, 0]
    _intervals(panels[0], table, by)
    panels[0].set_xlabel(f"change of time against {against}, %; dots: blocks; shaded: the margin")
    if is_one_case:
        _blocks(panels[1], table, by)
        panels[1].set(xlabel="block, in the order of time", ylabel="change of time, %")
    return figure


def _intervals(axes: Axes, table: pd.DataFrame, by: Stated) -> None:
    dots = []
    for height, row in enumerate(table.itertuples()):
        known = row.verdict if row.verdict != INCONCLUSIVE else "not settled"
        said = "control" if row.is_control else known
        dots.append(of_ratio(row, height, row.name, Look(row.colour), said))
        below, pale = np.full(len(row.changes), height - 0.28), lighten(row.colour, 0.6)
        axes.plot(row.changes, below, "o", color=pale, markersize=2, zorder=2)
    forest(axes, dots, list(table["name"]), by.margin)


def _blocks(axes: Axes, table: pd.DataFrame, by: Stated) -> None:
    shade(axes, -100 * by.margin, 100 * by.margin, 0, upright=True)
    for row in table.itertuples():
        label = f"{row.name} (control)" if row.is_control else row.name
        axes.plot(
            range(1, len(row.changes) + 1), row.changes, marker="o", markersize=2.5, linewidth=0.8,
            color=row.colour, label=label,
        )  # fmt: skip
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.legend(fontsize=7, frameon=False, ncols=min(4, len(table)), loc="upper left")
    axes.margins(y=0.25)
