"""What is compared, measured in turns and in processes of their own: the ratios of both ways, and how soon
either knows them. And programs that are stopped now and then, against the same ones without a pause.
"""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.pauses import STOPPED_BY
from analysis.derived.pauses import ratios as pause_ratios
from analysis.derived.ways import APART, TURNS, Comparison, comparisons, overall, said
from analysis.figures.captions import PROCESSES, opening
from analysis.figures.hover import Told, tell
from analysis.figures.style import (
    BLUE,
    FAINT,
    VERMILLION,
    Cell,
    Data,
    Drawing,
    Table,
    key,
    logarithmic_ticks,
    new_figure,
)
from analysis.support.wording import number

COLOURS = {TURNS: BLUE, APART: VERMILLION}
_COLOUR_OF_STOP = dict(zip(STOPPED_BY, (BLUE, VERMILLION), strict=True))


def ways(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the ratios of an experiment both ways, and the width of their intervals over the time spent."""
    found = comparisons(data.study, experiment)
    if not found:
        return None
    figure, (left, right) = new_figure(1.0 + 0.42 * max(len(found), 4), columns=2, widths=[1.1, 1.0])
    _ratios(left, found)
    _widths(right, found)
    key(right, list(COLOURS.items()))
    caption = (
        f"{opening(data.study.times_of(experiment), subject, PROCESSES)} Ratios of the times of the steps "
        "with 95 % intervals, and, a line a comparison, half of these as blocks came, over the time that "
        f"they took. Ratios by turns are {said(overall(found))} off those apart, on average."
    )
    return Drawing(figure, caption, tables=[_table(found)])


def _ratios(axes: Axes, found: list[Comparison]) -> None:
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    for height, one in enumerate(reversed(found)):
        for way, aside in ((TURNS, 0.13), (APART, -0.13)):
            value = one.log_ratio(way)
            estimate, low, high = (100 * (np.exp(end) - 1) for end in (value.estimate, value.low, value.high))
            axes.plot([low, high], [height + aside] * 2, color=COLOURS[way], linewidth=1.4)
            (dot,) = axes.plot(estimate, height + aside, "o", color=COLOURS[way], markersize=4)
            tell(dot, [Told(f"{one.name}, {way}", said(value))])
    axes.set_yticks(range(len(found)), [one.name.replace(": ", "\n") for one in reversed(found)])
    axes.tick_params(axis="y", length=0)
    axes.set(ylim=(-0.5, len(found) - 0.5), xlabel="time against the other, %")


def _widths(axes: Axes, found: list[Comparison]) -> None:
    axes.set(xscale="log", yscale="log", xlabel="time spent, s", ylabel="half of the interval, %")
    for way, colour in COLOURS.items():
        for one in found:
            table = one.half_widths(way)
            (line,) = axes.plot(table["seconds"], 100 * table["half"], color=colour, linewidth=0.9)
            tell(line, [_told(one, way, row) for _, row in table.iterrows()])
    for axis in (axes.xaxis, axes.yaxis):
        logarithmic_ticks(axis)


def _told(one: Comparison, way: str, row: pd.Series) -> Told:
    return Told(f"{one.name}, {way}", f"{number(row['seconds'])} s", f"{number(100 * row['half'])} %")


def _table(found: list[Comparison]) -> Table:
    rows = [
        [
            Cell(one.name),
            *(Cell(said(one.log_ratio(way))) for way in (TURNS, APART)),
            Cell(said(one.bias)),
            Cell(str(len(one.pairs))),
            *(Cell(number(one.seconds[way])) for way in (TURNS, APART)),
        ]
        for one in found
    ]
    columns = [
        "comparison", TURNS, APART, "by turns against apart", "blocks",
        f"s a block, {TURNS}", f"s a block, {APART}",
    ]  # fmt: skip
    return Table("The same comparisons both ways, with 95 % intervals over the blocks", columns, rows)


def pauses(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the time of each program in slices over its time without a pause, by what stopped it."""
    found = pause_ratios(data.study.times_of(experiment))
    if found.empty:
        return None
    programs = list(found["series"].drop_duplicates())
    figure, [axes] = new_figure(1.0 + 0.32 * max(len(programs), 4))
    _pause_ratios(axes, found, programs)
    key(axes, [(name, _COLOUR_OF_STOP[label]) for label, name in STOPPED_BY.items()])
    opened = opening(data.study.times_of(experiment), subject, PROCESSES)
    caption = (
        f"{opened} Time in slices against time without a pause, by pairs within blocks, with 95 % "
        "intervals. A hollow dot is a program that was found to mind being stopped, and so was not."
    )
    return Drawing(figure, caption, tables=[_pause_table(found, programs)])


def _pause_ratios(axes: Axes, found: pd.DataFrame, programs: list[str]) -> None:
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    for height, program in enumerate(reversed(programs)):
        for aside, (label, name) in zip((0.15, -0.15), STOPPED_BY.items(), strict=True):
            colour = _COLOUR_OF_STOP[label]
            for row in found[(found["series"] == program) & (found["label"] == label)].itertuples():
                value = row.ratio
                ends = [100 * (np.exp(end) - 1) for end in (value.low, value.high, value.estimate)]
                axes.plot(ends[:2], [height + aside] * 2, color=colour, linewidth=1.4)
                inside = colour if row.sliced else "white"
                (dot,) = axes.plot(ends[2], height + aside, "o", color=colour, mfc=inside, markersize=4)
                tell(dot, [Told(f"{program}, {name}", said(value))])
    axes.set_yticks(range(len(programs)), list(reversed(programs)))
    axes.tick_params(axis="y", length=0)
    axes.set(ylim=(-0.5, len(programs) - 0.5), xlabel="time in slices against time without a pause, %")


def _pause_table(found: pd.DataFrame, programs: list[str]) -> Table:
    rows = []
    for program in programs:
        of_it = found[found["series"] == program].set_index("label")
        rows.append(
            [
                Cell(program),
                Cell(number(of_it["seconds"].iloc[0])),
                *(Cell(_pause_told(of_it, label)) for label in STOPPED_BY),
                Cell(str(of_it["blocks"].max())),
            ]
        )
    columns = ["program", "s without a pause", *STOPPED_BY.values(), "blocks"]
    return Table(
        "Time in slices against time without a pause, with 95 % intervals over the blocks", columns, rows
    )


def _pause_told(of_it: pd.DataFrame, label: str) -> str:
    if label not in of_it.index:
        return "not measured"
    ratio = of_it.loc[label, "ratio"]
    return said(ratio) + ("" if of_it.loc[label, "sliced"] else " (not stopped)")
