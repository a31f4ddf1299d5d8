"""Where the time goes: the phases of a step, and what each thread does in them, from profiled runs."""

import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.style import (
    BLUE,
    GREEN,
    ORANGE,
    VERMILLION,
    Data,
    Drawing,
    key,
    lighten,
    new_figure,
)
from analysis.support.wording import count, number, scene_in_words, share

PHASE_COLOURS = {"move": ORANGE, "bin": GREEN, "find": BLUE, "resolve": VERMILLION}


def profile(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw each phase's share of a step's wall time, and how much of it the threads are busy."""
    table = data.study.phases[data.study.phases["experiment"] == experiment]
    if table.empty:
        return None
    threads = data.study.threads[data.study.threads["experiment"] == experiment]
    series = list(dict.fromkeys(table.sort_values("series_number", kind="stable")["series"]))[::-1]
    figure, (left, right) = new_figure(0.8 + 0.42 * len(series), columns=2, widths=[1.15, 1])
    shares = phase_shares(table)
    _stacked(left, shares, series)
    key(left, [(f"■ {phase}", colour) for phase, colour in PHASE_COLOURS.items()])
    left.set(xlabel="share of the wall time of a step, %", xlim=(0, 100))
    busy = busy_shares(threads)
    _busy(right, busy, series)
    right.set(xlabel="busy time of the threads in the phase, %", xlim=(0, 100))
    return Drawing(figure, _caption(subject, table, shares, threads))


def phase_shares(table: pd.DataFrame) -> pd.DataFrame:
    """Return series x phase: the median over the profiled runs of the phase's share of the wall time (0 to
    1).
    """
    walls = table.pivot_table(index=["series", "file"], columns="phase", values="wall_seconds", aggfunc="sum")
    shares = walls.div(walls.sum(axis=1), axis=0)
    return (
        shares.groupby("series")
        .median()
        .reindex(columns=[phase for phase in PHASE_COLOURS if phase in shares])
    )


def busy_shares(threads: pd.DataFrame) -> pd.DataFrame:
    """Return series x phase: busy over busy and waiting time, summed over threads, median over runs (0 to
    1).
    """
    summed = threads.groupby(["series", "phase", "file"])[["busy_seconds", "waiting_seconds"]].sum()
    busy = summed["busy_seconds"] / summed.sum(axis=1)
    return busy.groupby(["series", "phase"]).median().unstack("phase")


def imbalance(threads: pd.DataFrame) -> pd.Series:
    """Return per series and phase the load imbalance: greatest over mean busy time of a thread, median over
    runs.
    """
    busy = threads.groupby(["series", "phase", "file"])["busy_seconds"]
    return (busy.max() / busy.mean()).groupby(["series", "phase"]).median()


def _stacked(axes: Axes, shares: pd.DataFrame, series: list[str]) -> None:
    for height, name in enumerate(series):
        left = 0.0
        for phase in shares.columns:
            width = 100 * float(shares.loc[name, phase])
            axes.barh(
                height,
                width,
                left=left,
                color=PHASE_COLOURS[phase],
                height=0.6,
                edgecolor="white",
                linewidth=0.5,
            )
            if width >= 6:
                axes.annotate(
                    f"{width:.0f}",
                    (left + width / 2, height),
                    color="white",
                    ha="center",
                    va="center",
                    fontsize=7,
                )
            left += width
    axes.set_yticks(range(len(series)), series)
    axes.tick_params(axis="y", length=0)


def _busy(axes: Axes, busy: pd.DataFrame, series: list[str]) -> None:
    """One thin bar a phase, in the phases' order from above, over a pale bar of the whole."""
    shown = [phase for phase in PHASE_COLOURS if phase in busy.columns]
    thickness = 0.7 / max(len(shown), 1)
    for height, name in enumerate(series):
        for rank, phase in enumerate(shown):
            y = height + 0.35 - thickness * (rank + 0.5)
            axes.barh(y, 100, color=lighten(PHASE_COLOURS[phase], 0.8), height=thickness * 0.85)
            axes.barh(
                y, 100 * float(busy.loc[name, phase]), color=PHASE_COLOURS[phase], height=thickness * 0.85
            )
    axes.set_yticks(range(len(series)), [""] * len(series))
    axes.tick_params(axis="y", length=0)


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
