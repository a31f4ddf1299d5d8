"""What is compared, measured in turns and in processes of their own: the ratios of both ways, and how soon
either knows them. And programs that are stopped now and then, against the same ones without a pause.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.pauses import ratios as pause_ratios
from analysis.derived.ways import APART, TURNS, Comparison, comparisons, overall, said
from analysis.figures.captions import PROCESSES, opening
from analysis.figures.hover import Told, point
from analysis.figures.labels import SIGNS, key, logarithmic_ticks, name_rows
from analysis.figures.style import BLUE, FAINT, VERMILLION, Data, Drawing, Look, new_figure
from analysis.support.values import Interval, Table, table_of
from analysis.support.wording import number

LOOKS = {TURNS: Look(BLUE), APART: Look(VERMILLION, "s", "--")}


def ways(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the ratios of an experiment both ways, and the width of their intervals over the time spent."""
    found = comparisons(data.study, experiment)
    if not found:
        return None
    figure, (left, right) = new_figure(1.0 + 0.42 * max(len(found), 4), columns=2, widths=[1.1, 1.0])
    _ratios(left, found)
    _widths(right, found)
    key(right, [(f"{SIGNS[look.marker]} {way}", look.colour) for way, look in LOOKS.items()])
    caption = (
        f"{opening(data.study.times_of(experiment), subject, PROCESSES)} Ratios of the times of the steps "
        "with 95 % intervals, and, a line a comparison, half of these as blocks came, over the time that "
        f"they took. Ratios by turns are {said(overall(found))} off those apart, on average."
    )
    return Drawing(figure, caption, tables=[_table(found)])


def _ratios(axes: Axes, found: list[Comparison]) -> None:
    _rows(axes, [one.name.replace(": ", "\n") for one in reversed(found)])
    for height, one in enumerate(reversed(found)):
        for way, aside in ((TURNS, 0.13), (APART, -0.13)):
            _interval(axes, one.log_ratio(way), height + aside, f"{one.name}, {way}", LOOKS[way])
    axes.set_xlabel("time against the other, %")


def _rows(axes: Axes, names: Sequence[str]) -> None:
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    name_rows(axes, names)
    axes.set_ylim(-0.5, len(names) - 0.5)


def _interval(axes: Axes, value: Interval, height: float, name: str, look: Look, inside: str = "") -> None:
    """Draw a log ratio in per cent."""
    estimate, low, high = 100 * (np.exp(value) - 1)
    axes.plot([low, high], [height, height], color=look.colour, linewidth=1.4)
    dot: Any = {"color": look.colour, "mfc": inside or look.colour, "markersize": 4}
    point(axes, estimate, height, look.marker, Told(name, said(value)), **dot)


def _widths(axes: Axes, found: list[Comparison]) -> None:
    axes.set(xscale="log", yscale="log", xlabel="time spent, s", ylabel="half of the interval, %")
    for way, look in LOOKS.items():
        for one in found:
            widths = one.half_widths(way)
            drawn: Any = {"color": look.colour, "linestyle": look.dashes, "linewidth": 0.9}
            axes.plot(widths["seconds"], 100 * widths["half"], **drawn)
    for axis in (axes.xaxis, axes.yaxis):
        logarithmic_ticks(axis)


def _table(found: list[Comparison]) -> Table:
    rows = [
        [
            one.name, *(said(one.log_ratio(way)) for way in (TURNS, APART)), said(one.bias),
            str(len(one.pairs)), *(number(one.seconds[way]) for way in (TURNS, APART)),
        ]
        for one in found
    ]  # fmt: skip
    spent = (f"s a block, {way}" for way in (TURNS, APART))
    columns = ["comparison", TURNS, APART, "by turns against apart", "blocks", *spent]
    return table_of("The same comparisons both ways, with 95 % intervals over the blocks", columns, rows)


def pauses(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the time of each program in slices over its time without a pause."""
    found = pause_ratios(data.study.times_of(experiment))
    if found.empty:
        return None
    figure, [axes] = new_figure(1.0 + 0.32 * max(len(found), 4))
    _rows(axes, list(found["series"])[::-1])
    for height, row in enumerate(found[::-1].itertuples()):
        _interval(axes, row.ratio, height, row.series, Look(BLUE), "" if row.sliced else "white")
    axes.set_xlabel("time in slices against time without a pause, %")
    opened = opening(data.study.times_of(experiment), subject, PROCESSES)
    caption = (
        f"{opened} Time in slices against time without a pause, by pairs within blocks, with 95 % "
        "intervals. A hollow dot is a program that was found to mind being stopped, and so was not."
    )
    return Drawing(figure, caption, tables=[_pause_table(found)])


def _pause_table(found: pd.DataFrame) -> Table:
    rows = []
    for row in found.itertuples():
        told = said(row.ratio) + ("" if row.sliced else " (not stopped)")
        rows.append([row.series, number(row.seconds), told, str(row.blocks)])
    columns = ["program", "s without a pause", "in slices", "blocks"]
    title = "Time in slices against time without a pause, with 95 % intervals over the blocks"
    return table_of(title, columns, rows)
