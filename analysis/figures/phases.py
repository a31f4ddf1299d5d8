"""Where the time goes: the phases of a step, and what each thread does in them, from profiled runs."""

from typing import Any

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.limits import busy_shares
from analysis.figures.labels import key, name_rows
from analysis.figures.style import BLUE, GREEN, ORANGE, VERMILLION, Data, Drawing, lighten, new_figure
from analysis.support.wording import count, number, scene_in_words, share

PHASE_COLOURS = {"move": ORANGE, "bin": GREEN, "find": BLUE, "resolve": VERMILLION}


def profile(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw each phase's share of a step's wall time, and how much of it the threads are busy."""
    table, threads = data.study.of(experiment, "phases", "threads")
    if table.empty:
        return None
    series = list(dict.fromkeys(table.sort_values("series_number", kind="stable")["series"]))[::-1]
    figure, (left, right) = new_figure(0.8 + 0.42 * len(series), columns=2, widths=[1.15, 1])
    shares = phase_shares(table)
    _stacked(left, shares, series)
    key(left, [(f"■ {phase}", colour) for phase, colour in PHASE_COLOURS.items()])
    left.set(xlabel="share of the wall time of a step, %", xlim=(0, 100))
    busy = busy_shares(threads, ["series", "phase", "file"])
    _busy(right, busy.groupby(["series", "phase"]).median().unstack("phase"), series)
    right.set(xlabel="busy time of the threads in the phase, %", xlim=(0, 100))
    return Drawing(figure, _caption(subject, table, shares, threads))


def phase_shares(table: pd.DataFrame) -> pd.DataFrame:
    """Return series x phase: the median over the profiled runs of the phase's part of the wall time."""
    walls = table.pivot_table(index=["series", "file"], columns="phase", values="wall_seconds", aggfunc="sum")
    shares = walls.div(walls.sum(axis=1), axis=0).groupby("series").median()
    return shares[[phase for phase in PHASE_COLOURS if phase in shares]]


def imbalance(threads: pd.DataFrame) -> pd.Series:
    """Return per series and phase the greatest over the mean busy time of a thread, median over runs."""
    busy = threads.groupby(["series", "phase", "file"])["busy_seconds"]
    return (busy.max() / busy.mean()).groupby(["series", "phase"]).median()


def _stacked(axes: Axes, shares: pd.DataFrame, series: list[str]) -> None:
    for height, name in enumerate(series):
        left = 0.0
        for phase in shares.columns:
            width = 100 * float(shares.loc[name, phase])
            look: Any = {"color": PHASE_COLOURS[phase], "edgecolor": "white", "linewidth": 0.5}
            axes.barh(height, width, left=left, height=0.6, **look)
            if width >= 6:
                at = left + width / 2, height
                axes.annotate(f"{width:.0f}", at, color="white", ha="center", va="center", fontsize=7)
            left += width
    name_rows(axes, series)


def _busy(axes: Axes, busy: pd.DataFrame, series: list[str]) -> None:
    """One thin bar a phase, in the phases' order from above, over a pale bar of the whole."""
    shown = [phase for phase in PHASE_COLOURS if phase in busy.columns]
    thickness = 0.7 / max(len(shown), 1)
    for height, name in enumerate(series):
        for rank, phase in enumerate(shown):
            y, colour = height + 0.35 - thickness * (rank + 0.5), PHASE_COLOURS[phase]
            for width, shade in ((100, lighten(colour, 0.8)), (100 * float(busy.loc[name, phase]), colour)):
                axes.barh(y, width, color=shade, height=thickness * 0.85)
    name_rows(axes, [""] * len(series))


def _caption(subject: str, table: pd.DataFrame, shares: pd.DataFrame, threads: pd.DataFrame) -> str:
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
    uneven = imbalance(threads)
    series, phase = uneven.idxmax()
    return (
        f"{subject} ({where}, {threads_used}), from {runs} apart from the timed ones (medians). {first}: "
        f"{said}; {share(serial)} of it outside parallel loops. Right: busy time against waiting at "
        f"barriers. Greatest load imbalance (maximum over mean of the threads): {number(uneven.max())} in "
        f"{phase} of {series}."
    )
