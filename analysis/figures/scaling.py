"""Time, speed-up and efficiency over threads, with the machine's limits and the universal scalability law."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.captions import differing, opening
from analysis.figures.kinds import curve, published_curve, ratio_axis, ratio_curve
from analysis.figures.labels import SIGNS, from_zero, key, note, plain_ticks
from analysis.figures.style import BLUE, FAINT, ORANGE, Data, Drawing, Look, lighten, looks, new_figure
from analysis.figures.sweeps import stacked
from analysis.records.studies import Study
from analysis.statistics import scalability
from analysis.statistics.bootstrap import summarise
from analysis.statistics.scalability import ScalabilityLaw, log_ratios_by_x, speed_up
from analysis.statistics.verdicts import judge
from analysis.support.wording import count, exact, interval, interval_of, number

THREADS = (1, 2, 4, 8, 16, 32, 64, 128, 256)


def scaling(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw time, speed-up against ideal, and efficiency over threads, a curve a series and scene; the law is
    fitted to a single one. None without records whose x is the number of threads.
    """
    times = data.study.times_of(experiment)
    times = times[times["x_name"] == "threads"]
    if times.empty:
        return None
    times = _by_curve(times)
    published = data.published.experiment(experiment)
    figure, panels = new_figure(2.6, columns=3)
    shown = looks(sorted(times["series"].unique()))
    parts = {str(series): part for series, part in times.groupby("series")}
    measured = {series: _series(panels, part, shown[series]) for series, part in parts.items()}
    entries = [_entry(series, part, shown[series], len(parts) > 1) for series, part in parts.items()]
    law = scalability.fit(times, data.study.hardware_threads) if len(parts) == 1 else None
    most = max(table["speed_up"].max() for table in measured.values())
    if len(published):
        x, speed = published["x"], published["seconds"].iloc[0] / published["seconds"]
        for axes, y in zip(panels, (1 / speed, speed, speed * x.iloc[0] / x), strict=True):
            published_curve(axes, x, y, Look(BLUE))
        most = max(most, speed.max())
        entries.append(("● published", lighten(BLUE, 0.4)))
    ideal = np.geomspace(1, 1.1 * most, 50)
    panels[1].plot(times["x"].min() * ideal, ideal, color=FAINT, linestyle="--", linewidth=0.9, zorder=1)
    panels[2].axhline(1, color=FAINT, linestyle="--", linewidth=0.9, zorder=1)
    entries.append(("- - ideal", FAINT))
    if law:
        n = np.geomspace(1, times["x"].max(), 100)
        for axes, y in zip(panels[1:], (law.speed_up(n), law.speed_up(n) / n), strict=True):
            axes.plot(n, y, color=ORANGE, linewidth=0.9, zorder=2.5)
        entries.append(("— universal scalability law", ORANGE))
    first = count(int(times["x"].min()), "thread")
    labels = f"time relative to {first}", f"speed-up over {first}", "efficiency"
    for axes, label in zip(panels, labels, strict=True):
        _thread_axis(axes, [*times["x"], *published["x"]])
        from_zero(axes)
        limits(axes, data.study, named=axes is panels[0])
        axes.set_ylabel(label)
    key(figure, entries)
    return Drawing(
        figure, opening(times, subject) + _sentences(data.study, measured, law, len(published) > 0)
    )


def _by_curve(times: pd.DataFrame) -> pd.DataFrame:
    """Return the times with a series for each scene, if there are several."""
    scenes = times["scene_name"]
    if scenes.nunique() < 2:
        return times
    one = times["series"].nunique() == 1
    return times.assign(series=scenes if one else times["series"] + ", " + scenes)


def _series(panels: Sequence[Axes], times: pd.DataFrame, look: Look) -> pd.DataFrame:
    """Draw one series and return its speed-ups."""
    series, first = times["series"].iloc[0], float(times["x"].min())
    speed_ups = speed_up(times).assign(series=series)
    summary = summarise(times, ["series", "x"])
    ends = ["median", "low", "high"]
    relative = summary.assign(**summary[ends] / summary.loc[summary["x"] == first, "median"].iloc[0])
    ends = ["speed_up", "low", "high"]
    efficiency = speed_ups.assign(**speed_ups[ends].mul(first / speed_ups["x"], axis=0))
    for axes, table in zip(panels, (relative, speed_ups, efficiency), strict=True):
        curve(axes, table, look, "median" if table is relative else "speed_up")
    return speed_ups


def _entry(series: str, times: pd.DataFrame, look: Look, several: bool) -> tuple[str, str]:
    first = times["x"].min()
    seconds = times.loc[times["x"] == first, "steps_seconds"].median()
    said = f"{number(seconds)} s on {count(int(first), 'thread')}"
    return f"{SIGNS[look.marker]} {series if several else 'measured'}, {said}", look.colour


def oversubscription(data: Data) -> Drawing | None:
    """Draw time over threads in multiples of the machine's hardware threads, against as many as it has."""
    times = data.study.times_of("oversubscription")
    if times.empty:
        return None
    hardware = data.study.hardware_threads
    figure, (above, below) = stacked("threads", 3.4)
    curve(above, summarise(times, ["x"]), Look(BLUE))
    above.set_ylabel("time of the steps, s")
    from_zero(above)
    reference = times[times["x"] == times.loc[times["x"] <= hardware, "x"].max()]
    table = judge(log_ratios_by_x(reference, times[times["x"] > hardware]), ["x"])
    own = reference[["x"]].drop_duplicates().assign(ratio=1.0, low=np.nan, high=np.nan)
    ratios = pd.concat([own, table], ignore_index=True) if len(table) else own
    ratio_axis(below, ratios, "all hardware threads")
    ratio_curve(below, ratios, Look(BLUE))
    _thread_axis(below, sorted(times["x"].unique()), times["x"].unique())
    limits(above, data.study, named=True)
    limits(below, data.study, named=False)
    said = differing((f"{x / hardware:g} times as many:" for x in table["x"]), table)
    caption = opening(times, "Time with more threads than the machine has hardware threads")
    against = f" Against {count(hardware, 'thread')}, as many as there are: {said}." if said else ""
    return Drawing(figure, caption + against)


def limits(axes: Axes, study: Study, named: bool) -> None:
    """Draw the machine's cores and hardware threads as lines, named if asked."""
    cores, hardware = study.cores, study.hardware_threads
    marks = {hardware: "hardware\nthreads"}
    if cores is not None:
        marks = {hardware: "cores and\nhardware threads"} if cores == hardware else {cores: "cores", **marks}
    for position, name in marks.items():
        if not axes.get_xlim()[0] <= position <= axes.get_xlim()[1]:
            continue
        axes.axvline(position, color=FAINT, linewidth=0.7, linestyle=":", zorder=1)
        if named:
            look: Any = {"rotation": 90, "fontsize": 6, "color": FAINT, "va": "top"}
            above = ("data", "axes fraction")
            note(axes, f"{position} {name}", (position, 0.98), (2, 0), xycoords=above, **look)


def _thread_axis(axes: Axes, values: list[float], ticks: Iterable[float] = THREADS) -> None:
    axes.set_xscale("log", base=2)
    axes.set_xlabel("threads")
    plain_ticks(axes.xaxis, [tick for tick in ticks if min(values) <= tick <= max(values)])
    axes.minorticks_off()


def _sentences(
    study: Study, measured: dict[str, pd.DataFrame], law: ScalabilityLaw | None, published: bool
) -> str:
    """Say each series' greatest speed-up, the machine's limits, and the law if there is one series."""
    said, cores = "", study.cores or study.hardware_threads
    for series, table in measured.items():
        (best,) = table.loc[[table["speed_up"].idxmax()]].itertuples()
        unlikely = scalability.doubt(best.speed_up, min(best.x, cores) / table["x"].min())
        said += (
            f" Greatest speed-up{f' of {series}' if len(measured) > 1 else ''} "
            f"{interval_of(best, 'speed_up')} with {exact(best.x)} threads{unlikely and f' ({unlikely})'}."
        )
    said += (
        f" The machine has {study.cores or 'an unknown number of'} cores and {study.hardware_threads} "
        "hardware threads (dotted)."
    )
    if published:
        own = "its own single thread (10 cores, 20 hardware threads)"
        said += f" Lighter: the published series, relative to {own}."
    if len(measured) > 1:
        return said
    said += " The universal scalability law is "
    if law is None:
        return f"{said}not fitted: it needs four thread counts up to the hardware threads."
    return (
        f"{said}fitted up to the hardware threads ({law.points} points): contention "
        f"{interval(law.contention)}, coherency {interval(law.coherency)}."
    )
