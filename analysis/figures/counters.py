"""Quantities derived from counters, a figure a source, since sources are never mixed in one."""

from itertools import zip_longest

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.counters import QUANTITIES, derived
from analysis.figures.labels import name_rows, note
from analysis.figures.style import BLUE, INK, Data, Drawing, new_grid
from analysis.support.wording import count, number

COLUMNS = 3


def panels(data: Data, source: str, subject: str) -> Drawing | None:
    """Draw what one source counted of the published variants, a panel a quantity."""
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
    for height, row in zip(heights, rows.to_dict("records"), strict=True):
        known = not pd.isna(row["value"])
        said, end = (number(row["value"]), row["greatest"]) if known else ("not counted", 0)
        note(axes, said, (end, float(height)), (3, 0), va="center", fontsize=6.5)
    name_rows(axes, list(rows.index))
    axes.set_title(quantity, fontsize=7)
    axes.xaxis.set_visible(False)
    axes.spines["bottom"].set_visible(False)
