"""A model of a step of the fastest variant on more threads than were measured, and what was measured.

The model takes the phases of a step on one thread, what the loops themselves cost on more (the steps of two
discs, which have no work), and the machine's memory:

    T(p) = move ceil(B / p) / B + bin / p + find ceil(S / p) / S + resolve 2 ceil(S / 2p) / S
           + 2 s h + loops(p) + (r - 1) resolve_loop(p),    and at least BYTES n / bandwidth(p)

for n discs in B blocks of 256, S strips of four rows of boxes as wide as a disc, and s sweeps. A sweep runs
every other strip at a time. Between the two halves of a sweep strips are handed from core to core, in a time
h that no number of threads makes shorter; it is what the resolve of the scene with most sweeps a disc takes
longer on two threads than the rest of the model says. The resolve's loop begins r times a step: on several
threads 1, 2, 4 and then 8 sweeps run as one. That discs pass from core to core between the phases, too, is
not in the model.
"""

import math

import numpy as np
import pandas as pd

from analysis.derived.ladder import named
from analysis.statistics.pairs import log_ratios
from analysis.statistics.verdicts import judge
from analysis.support.wording import exact

PHASES = ["move", "bin", "find", "resolve"]
ROWS_OF_A_STRIP = 4
DISCS_OF_A_BLOCK = 256
SWEEPS_AT_ONCE = 8
BYTES = 250
"""Of a disc, through memory in a step: the sort's two copies of it read and written (128), its place in
float, its boxes and marks, and its contacts, written once and read.
"""
FORETOLD = (1, 2, 4, 8, 16, 32, 64)
LARGER = (10, 100)


def steps_by_phase(runs: pd.DataFrame, phases: pd.DataFrame) -> pd.DataFrame:
    """Return the seconds of a step, a row a scene and number of threads and a column a phase, medians of the
    profiled runs, with the `particles`, `side`, `radius` and `sweeps` of a step. Empty without records.
    """
    rows = named(phases).assign(seconds=phases["wall_seconds"] / (phases["steps"] * phases["substeps"]))
    if rows.empty:
        return pd.DataFrame()
    table = rows.pivot_table(
        index=["scene_name", "threads"], columns="phase", values="seconds", aggfunc="median"
    )
    sweeps = named(runs).assign(sweeps=runs["sweeps"] / (runs["steps"] * runs["substeps"]))
    scenes = sweeps.groupby("scene_name")[["particles", "side", "radius", "sweeps"]].first()
    return table.reset_index().join(scenes, on="scene_name")


def measured_speed_ups(phases: pd.DataFrame) -> pd.DataFrame:
    """Return `scene_name`, `threads`, `speed_up`, `low`, `high`: over one thread, within blocks."""
    keys = ["scene_name", "threads", "node", "block", "session", "file"]
    whole = named(phases).groupby(keys, dropna=False)["wall_seconds"].sum().rename("steps_seconds")
    times = whole.reset_index()
    tables = []
    for (scene, threads), candidate in times[times["threads"] > 1].groupby(["scene_name", "threads"]):
        reference = times[(times["scene_name"] == scene) & (times["threads"] == 1)]
        pairs = log_ratios(reference, candidate)
        tables.append(pairs.assign(scene_name=scene, threads=threads))
    if not tables:
        return pd.DataFrame(columns=["scene_name", "threads", "speed_up", "low", "high"])
    table = judge(pd.concat(tables), ["scene_name", "threads"])
    # A time ratio becomes a speed-up: its ends change places.
    found = table.assign(speed_up=1 / table["ratio"], low=1 / table["high"], high=1 / table["low"])
    found = found[["scene_name", "threads", "speed_up", "low", "high"]]
    return found.replace([0, np.inf], np.nan)


def foretold(steps: pd.DataFrame, limits: pd.DataFrame) -> pd.DataFrame:
    """Return `scene_name`, `particles`, `threads`, `seconds` of a step and what `bounds` it (work or memory),
    for each scene of `steps_by_phase`, and for the largest one with LARGER times as many discs in a box as
    much larger.

    Takes the machine's limits. Empty without the scene of two discs (one at quick scale) on two threads.
    """
    loops = steps[steps["particles"] <= 2].set_index("threads")[PHASES]
    scenes = steps[(steps["threads"] == 1) & (steps["particles"] > 2)].sort_values("particles")
    if 1 not in loops.index or len(loops) < 2 or scenes.empty:
        return pd.DataFrame(columns=["scene_name", "particles", "threads", "seconds", "bounds"])
    threads = sorted({*FORETOLD, *steps["threads"]})
    rows = [scene for _, scene in scenes.iterrows()]
    hand_over = _hand_over(rows, steps, loops)
    rows += [_grown(rows[-1], times) for times in LARGER]
    told = [
        {"scene_name": scene["scene_name"], "particles": scene["particles"], "threads": p}
        | _step(scene, p, loops, hand_over, limits)
        for scene in rows
        for p in threads
    ]
    return pd.DataFrame(told)


def _grown(scene: pd.Series, times: int) -> pd.Series:
    grown = scene.copy()
    grown[[*PHASES, "particles"]] = scene[[*PHASES, "particles"]] * times
    grown["side"] = scene["side"] * math.sqrt(times)
    millions = grown["particles"] / 1e6
    grown["scene_name"] = (
        f"{millions:g} million discs" if millions >= 1 else f"{exact(grown['particles'])} discs"
    )
    return grown


def _hand_over(scenes: list[pd.Series], steps: pd.DataFrame, loops: pd.DataFrame) -> float:
    """Return the seconds that half a sweep takes longer on two threads than its work; 0 if not measured."""
    scene = max(scenes, key=lambda one: one["sweeps"] / one["particles"])
    two = steps[(steps["scene_name"] == scene["scene_name"]) & (steps["threads"] == 2)]
    if two.empty:
        return 0.0
    expected = _resolve(scene, 2, loops, hand_over=0.0)
    return max(0.0, float(two["resolve"].iloc[0]) - expected) / (2 * float(scene["sweeps"]))


def _resolve(scene: pd.Series, threads: int, loops: pd.DataFrame, hand_over: float) -> float:
    if threads == 1:
        return float(scene["resolve"])
    strips = strips_of(scene["side"], scene["radius"])
    part = min(1.0, 2 * math.ceil(strips / (2 * threads)) / strips)
    begun = resolve_loops(scene["sweeps"]) * loops_over(loops, threads)["resolve"]
    return float(scene["resolve"] * part + 2 * scene["sweeps"] * hand_over + begun)


def _step(
    scene: pd.Series, threads: int, loops: pd.DataFrame, hand_over: float, limits: pd.DataFrame
) -> dict[str, object]:
    strips = strips_of(scene["side"], scene["radius"])
    blocks = math.ceil(scene["particles"] / DISCS_OF_A_BLOCK)
    parts = {
        "move": math.ceil(blocks / threads) / blocks,
        "bin": 1 / threads,
        "find": math.ceil(strips / threads) / strips,
    }
    extra = loops_over(loops, threads)
    seconds = sum(scene[phase] * part + extra[phase] * (threads > 1) for phase, part in parts.items())
    seconds += _resolve(scene, threads, loops, hand_over)
    moved = BYTES * scene["particles"]
    memory = moved / bandwidth(limits, threads) if exceeds_cache(scene, limits) else 0.0
    return {"seconds": max(seconds, memory), "bounds": "memory" if memory > seconds else "work"}


def strips_of(side: float, radius: float) -> int:
    """Return the number of strips of a box: four rows each, of boxes as wide as a disc at least."""
    return max(1, math.ceil(math.floor(side / (2 * radius)) / ROWS_OF_A_STRIP))


def resolve_loops(sweeps: float) -> float:
    """Return how many loops run so many sweeps on several threads: 1, 2, 4, then 8 of them at a time."""
    done, loops, at_once = 0, 0, 1
    while done < sweeps:
        done, loops, at_once = done + at_once, loops + 1, min(SWEEPS_AT_ONCE, done + at_once + 1)
    return loops


def loops_over(loops: pd.DataFrame, threads: int) -> dict[str, float]:
    """Return by phase what its loops cost on so many threads beyond one, in seconds: as measured, between two
    measured numbers in between, and beyond the greatest in proportion to the threads, as a barrier costs that
    counts all of them in one place.
    """
    extra = (loops - loops.loc[1]).clip(lower=0).sort_index()
    greatest = int(extra.index.max())
    at = min(threads, greatest)
    grown = max(1.0, threads / greatest)
    return {phase: grown * float(np.interp(at, extra.index, extra[phase])) for phase in PHASES}


def bandwidth(limits: pd.DataFrame, threads: int) -> float:
    """Return the bytes a second that so many threads copy in memory at most, as measured. Infinite where
    nobody measured it: a machine of more cores has another memory.
    """
    copies = limits[(limits["limit"] == "copy") & (limits["level"] == "memory")]
    if copies.empty or threads > copies["threads"].max():
        return math.inf
    best = copies.groupby("threads")["best"].max().sort_index()
    return float(np.interp(threads, best.index, best))


def exceeds_cache(scene: pd.Series, limits: pd.DataFrame) -> bool:
    """Tell whether a step of the scene works in more memory than the machine's last cache holds."""
    cached = limits.loc[(limits["limit"] == "copy") & (limits["level"] != "memory"), "working_set_bytes"]
    return bool(cached.empty or BYTES * scene["particles"] > cached.max())
