"""One step of profiled runs as a Gantt picture: who works on what, and who waits."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.figures.labels import key, name_rows, note
from analysis.figures.phases import PHASE_COLOURS
from analysis.figures.style import FAINT, INK, Data, Drawing, lighten, new_grid
from analysis.records import timelines
from analysis.support.wording import count, number, scene_in_words, share

MOST = 6
MANY = 400
EDGED_FROM = 1 / 150
"""The narrowest chunk that gets a white edge, as a part of the axis; a narrower one would vanish in it."""


def timeline(data: Data) -> Drawing | None:
    """Draw the step of median length of every timeline in the results folder, at most six, on a common time
    axis. They do not say whose they are: they stand with the first study that has profiled runs.
    """
    profiled = (one for one in data.studies if not one.phases.empty)
    found = timelines.load(data.folder)[:MOST] if data.study is next(profiled, data.studies[0]) else []
    if not found:
        return None
    titles = [_in_words(one.title, data.study.runs) for one in found]
    steps = [timelines.one_step(one.spans) for one in found]
    longest = 1e3 * max(step["end"].max() for step in steps)
    rows = [int(step["thread"].nunique()) for step in steps]
    height = 0.6 + sum(0.45 + 0.22 * count for count in rows)
    figure, columns = new_grid(height, len(found), sharex=True, height_ratios=rows)
    grid = columns[:, 0]
    for axes, title, step in zip(grid, titles, steps, strict=True):
        _gantt(axes, step, longest)
        axes.set_title(" ", pad=3)
        note(axes, title, (0, 1), (0, 3), xycoords="axes fraction")
    entries = [(f"■ {phase}", colour) for phase, colour in PHASE_COLOURS.items()]
    key(grid[0], [*entries, ("■ waiting", FAINT), ("pale: serial part of the phase", INK)], raised=16)
    grid[-1].set_xlabel("time since the step began, ms")
    said = "; ".join(f"{title}: {_sentence(step)}" for title, step in zip(titles, steps, strict=True))
    runs = count(len(found), "profiled run")
    return Drawing(figure, f"The step of median length of {runs}, thread by thread. {said}.")


def _in_words(title: str, runs: pd.DataFrame) -> str:
    """Return a timeline's title with its scene in words instead of its file, where the records know it."""
    variant, _, rest = title.partition(", ")
    file, _, threads = rest.rpartition(", ")
    known = runs.loc[runs["scene"] == file, ["particles", "area_fraction"]].drop_duplicates()
    if len(known) != 1:
        return title
    return f"{variant}, {scene_in_words(*known.iloc[0])}, {threads}"


def _gantt(axes: Axes, step: pd.DataFrame, longest: float) -> None:
    threads = sorted(step["thread"].unique())
    working = "chunk" if (step["kind"] == "chunk").any() else "loop"
    for (kind, phase, thread), spans in step.groupby(["kind", "phase", "thread"]):
        bars = list(zip(1e3 * spans["begin"], 1e3 * (spans["end"] - spans["begin"]), strict=True))
        row = len(threads) - 1 - threads.index(thread)
        # Thousands of chunks would make the vector formats huge: those alone become pixels.
        style: dict[str, Any] = {"linewidth": 0, "rasterized": len(bars) > MANY}
        colour = PHASE_COLOURS.get(phase, FAINT)
        if kind == "phase":
            axes.broken_barh(bars, (-0.5, len(threads)), color=lighten(colour, 0.75), zorder=1, **style)
        elif kind == "wait":
            axes.broken_barh(bars, (row - 0.1, 0.2), color=FAINT, zorder=3, **style)
        elif kind == working:
            edged = np.median([width for _, width in bars]) > EDGED_FROM * longest
            style |= {"facecolor": colour, "edgecolor": "white", "linewidth": 0.3 if edged else 0}
            axes.broken_barh(bars, (row - 0.35, 0.7), zorder=2, **style)
    name_rows(axes, [f"thread {thread}" for thread in threads[::-1]])
    axes.set_ylim(-0.5, len(threads) - 0.5)
    axes.spines["left"].set_visible(False)


def _sentence(step: pd.DataFrame) -> str:
    seconds = (step["end"] - step["begin"]).groupby(step["kind"]).sum()
    phases = seconds.get("phase", 0.0)
    chunks = int((step["kind"] == "chunk").sum())
    waiting = seconds.get("wait", 0.0) / max(phases * step["thread"].nunique(), 1e-12)
    taken = f", {count(chunks, 'chunk')}" if chunks else ""
    return f"{number(1e3 * phases)} ms{taken}, {share(waiting)} of the threads' time waiting"
