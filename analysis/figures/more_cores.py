"""The speed-up of the fastest variant over threads: measured, and foretold by a model of its step."""

import math

import pandas as pd
from matplotlib.axes import Axes

from analysis.derived.ladder import named, scene_title
from analysis.derived.more_cores import foretold, measured_speed_ups, steps_by_phase
from analysis.figures.curves import curve
from analysis.figures.hover import Told, tell
from analysis.figures.labels import key, note, plain_ticks
from analysis.figures.style import BLUE, FAINT, VERMILLION, Data, Drawing, Look, new_figure
from analysis.support.values import Table, table_of
from analysis.support.wording import count, exact, interval_of, listed, number

TOLD = (2, 8, 16, 64)


def more_cores(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw a panel a scene, and the largest ten times as large; None without runs on one and more threads."""
    runs, phases = data.study.of(experiment, "runs", "phases")
    steps = steps_by_phase(runs, phases)
    if steps.empty:
        return None
    told, measured = foretold(steps, data.study.limits), measured_speed_ups(phases)
    if told.empty:
        return None
    told = told.assign(speed_up=_speed_up(told))
    scenes = list(dict.fromkeys(told["scene_name"]))[:-1]
    figure, panels = new_figure(2.5, columns=len(scenes))
    for axes, scene in zip(panels, scenes, strict=True):
        _panel(axes, told[told["scene_name"] == scene], measured[measured["scene_name"] == scene])
        axes.set_title(" ", pad=16)
        name = scene_title(named(runs), scene) if scene in set(steps["scene_name"]) else scene
        note(axes, name, (0, 1), (0, 4), xycoords="axes fraction", fontsize=6.5)
    panels[0].set_ylabel("speed-up relative to one thread")
    key(panels[0], [("● measured", BLUE), ("— foretold", VERMILLION), ("- - ideal", FAINT)], raised=16)
    table = _table(told, measured)
    return Drawing(figure, _caption(subject, told, measured, runs), tables=[table])


def _speed_up(told: pd.DataFrame) -> pd.Series:
    alone = told[told["threads"] == 1].set_index("scene_name")["seconds"]
    return told["scene_name"].map(alone) / told["seconds"]


def _panel(axes: Axes, told: pd.DataFrame, measured: pd.DataFrame) -> None:
    rows = told.sort_values("threads")
    (line,) = axes.plot(rows["threads"], rows["speed_up"], color=VERMILLION, linewidth=1.1, zorder=2.5)
    tell(
        line,
        [
            Told("foretold", exact(row["threads"]), f"{number(row['speed_up'])} ({row['bounds']})")
            for row in rows.to_dict("records")
        ],
    )
    ends = [1, rows["threads"].max()]
    axes.plot(ends, ends, color=FAINT, linestyle="--", linewidth=0.9, zorder=1)
    if not measured.empty:
        curve(axes, measured.rename(columns={"threads": "x"}), Look(BLUE), "speed_up")
    axes.set_xscale("log", base=2)
    axes.set_yscale("log", base=2)
    axes.set_xlabel("threads")
    ticks = [2**power for power in range(math.floor(math.log2(ends[1])) + 1)][::2]
    plain_ticks(axes.xaxis, ticks)
    plain_ticks(axes.yaxis, ticks)
    axes.minorticks_off()
    axes.set_ylim(0.7, 1.1 * ends[1])


def _table(told: pd.DataFrame, measured: pd.DataFrame) -> Table:
    """A row a scene: a step on one thread, and the speed-ups, foretold and measured."""
    largest = int(measured["threads"].max()) if len(measured) else 0
    threads = sorted({*TOLD, largest} - {0})
    rows = []
    for scene, of in told.groupby("scene_name", sort=False):
        alone = of.loc[of["threads"] == 1, "seconds"].iloc[0]
        one = of.set_index("threads")["speed_up"]
        found = measured[measured["scene_name"] == scene].set_index("threads")
        cells = [
            f"{number(one[p])}; {interval_of(found.loc[p], 'speed_up')}"
            if p in found.index
            else number(one[p])
            for p in threads
        ]
        rows.append([str(scene), number(1e3 * alone), *cells])
    title = "Milliseconds of a step on one thread, and the speed-up over it: foretold; measured where it was:"
    return table_of(title, ["Scene", "ms on 1", *(count(p, "thread") for p in threads)], rows)


def _caption(subject: str, told: pd.DataFrame, measured: pd.DataFrame, runs: pd.DataFrame) -> str:
    both = measured.merge(told, on=["scene_name", "threads"], suffixes=("", "_told")).dropna(
        subset=["speed_up"]
    )
    apart = (both["speed_up_told"] / both["speed_up"] - 1).abs()
    said = (
        f" Measured on {listed(sorted(both['threads'].unique()), ', ')} threads, the model is off by "
        f"{number(100 * apart.median(), 2)} % in the median of {count(len(both), 'point')} and by "
        f"{number(100 * apart.max(), 2)} % at most."
        if len(both)
        else ""
    )
    bound = sorted(told.loc[told["bounds"] == "memory", "scene_name"].unique())
    memory = f" Memory is foretold to bound {listed(bound)}." if bound else ""
    profiled = count(runs["file"].nunique(), "profiled run")
    return (
        f"{subject[0].upper()}{subject[1:]} ({profiled}). The model takes the phases of a step on one "
        f"thread, what loops cost with two discs, and how long strips take from core to core on two."
        f"{said}{memory}"
    )
