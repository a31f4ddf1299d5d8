"""Programs that are stopped now and then, against the same programs without a pause: do both ways agree?"""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.ways import said
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
    new_figure,
)
from analysis.statistics.intervals import FEWEST, Interval, centre
from analysis.statistics.pairs import log_ratios, process_medians
from analysis.support.wording import number

KIND = "pauses"
"""The kind of the experiments whose series each have these labels."""

WITHOUT = "without a pause"
WAYS = {"cgroup": ("stopped by a control group", BLUE), "subreaper": ("stopped by signals", VERMILLION)}
"""By label: what the way is called, and its colour."""


def pauses(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the time of each program in slices over its time without a pause, by what stopped it."""
    found = ratios(data.study.times_of(experiment))
    if found.empty:
        return None
    programs = list(found["series"].drop_duplicates())
    figure, [axes] = new_figure(1.0 + 0.32 * max(len(programs), 4))
    _ratios(axes, found, programs)
    key(axes, [(name, colour) for name, colour in WAYS.values()])
    opened = opening(data.study.times_of(experiment), subject, PROCESSES)
    caption = (
        f"{opened} Time in slices against time without a pause, by pairs within blocks, with 95 % "
        "intervals. A hollow dot is a program that was found to mind being stopped, and so was not."
    )
    return Drawing(figure, caption, tables=[_table(found, programs)])


def ratios(times: pd.DataFrame) -> pd.DataFrame:
    """Return a row a program (`series`) and way (`label`): its log ratio in slices to that without a pause
    (`ratio`, an Interval), the number of `blocks`, the median `seconds` without a pause, and whether it took
    turns (`sliced`).
    """
    processes = process_medians(times)
    rows = []
    for series, group in processes.sort_values("series_number").groupby("series", sort=False):
        reference = group[group["label"] == WITHOUT]
        for label in WAYS:
            candidate = group[group["label"] == label]
            pairs = log_ratios(reference, candidate)
            if len(pairs) >= FEWEST:
                rows.append(
                    {
                        "series": series,
                        "label": label,
                        "ratio": centre(pairs["log_ratio"], 0.95),
                        "blocks": len(pairs),
                        "seconds": float(reference["steps_seconds"].median()),
                        "sliced": bool(candidate["in_turns"].mean() > 0.5),
                    }
                )
    return pd.DataFrame(rows, columns=["series", "label", "ratio", "blocks", "seconds", "sliced"])


def _ratios(axes: Axes, found: pd.DataFrame, programs: list[str]) -> None:
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    for height, program in enumerate(reversed(programs)):
        for aside, (label, (name, colour)) in zip((0.15, -0.15), WAYS.items(), strict=True):
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


def _table(found: pd.DataFrame, programs: list[str]) -> Table:
    rows = []
    for program in programs:
        of_it = found[found["series"] == program].set_index("label")
        rows.append(
            [
                Cell(program),
                Cell(number(of_it["seconds"].iloc[0])),
                *(Cell(_told(of_it, label)) for label in WAYS),
                Cell(str(of_it["blocks"].max())),
            ]
        )
    columns = ["program", "s without a pause", *(name for name, _ in WAYS.values()), "blocks"]
    return Table(
        "Time in slices against time without a pause, with 95 % intervals over the blocks", columns, rows
    )


def _told(of_it: pd.DataFrame, label: str) -> str:
    if label not in of_it.index:
        return "not measured"
    ratio: Interval = of_it.loc[label, "ratio"]
    return said(ratio) + ("" if of_it.loc[label, "sliced"] else " (not stopped)")
