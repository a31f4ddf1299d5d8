"""Profiled phases against what the machine can do at most: the least time that each could take."""

import numpy as np
import pandas as pd

from analysis.derived.unavoidable import unavoidable

KEYS = ["scene_name", "series", "phase"]
COPY, ARITHMETIC = "copy", "arithmetic"
RATES = ["level", "size", "copy_rate", "arithmetic_rate"]


def against_limits(
    runs: pd.DataFrame, phases: pd.DataFrame, threads: pd.DataFrame, limits: pd.DataFrame
) -> pd.DataFrame:
    """Return one row a scene, series and phase, medians over the profiled runs.

    Takes one experiment's tables and the machine's limits. Columns, in nanoseconds per disc and step:
    `wall`; `busy`, of it, what the threads do not wait; `copy` and `arithmetic`, the least that the
    unavoidable bytes and operations take at the best measured rates; `least`, the greater of the two, and
    which that is as `bound`. `reached` is least / wall. Besides: `level` of memory that holds a step, its
    `copy_rate`, `arithmetic_rate` (per second), `bytes` and `operations` per disc and step. Empty without
    limits of as many threads, or fewer.
    """
    rows = phases[["file", *KEYS, "particles", "steps", "substeps", "threads", "wall_seconds"]]
    rows = rows.merge(unavoidable(runs), on=["file", "phase"])
    busy = busy_shares(threads, ["file", "phase"]).reset_index()
    rows = rows.merge(busy, on=["file", "phase"], how="left")
    sizes = zip(rows["threads"], rows["working_set"], strict=True)
    best = [_best(limits, count, size) for count, size in sizes]
    rows = rows.join(pd.DataFrame(best, columns=RATES, index=rows.index))
    rows = rows.dropna(subset=["copy_rate", "arithmetic_rate"])
    discs_and_steps = rows["particles"] * rows["steps"] * rows["substeps"]
    rows = rows.assign(
        wall=1e9 * rows["wall_seconds"] / discs_and_steps,
        copy=1e9 * rows["bytes"] / rows["copy_rate"] / rows["particles"],
        arithmetic=1e9 * rows["operations"] / rows["arithmetic_rate"] / rows["particles"],
        bytes=rows["bytes"] / rows["particles"],
        operations=rows["operations"] / rows["particles"],
    )
    rows = rows.assign(
        busy=rows["wall"] * rows["busy_share"].fillna(1), least=rows[[COPY, ARITHMETIC]].max(axis=1)
    )
    rows = rows.assign(reached=rows["least"] / rows["wall"])
    numbers = [
        "wall", "busy", COPY, ARITHMETIC, "least", "reached", "copy_rate", "arithmetic_rate", "bytes",
        "operations",
    ]  # fmt: skip
    groups = rows.groupby(KEYS, sort=False)
    table = groups[numbers].median().join(groups[["level", "size", "threads", "particles"]].first())
    bound = np.where(table[COPY] >= table[ARITHMETIC], COPY, ARITHMETIC)
    return table.assign(bound=bound, runs=groups["file"].nunique()).reset_index()


def busy_shares(threads: pd.DataFrame, by: list[str]) -> pd.Series:
    """Return `busy_share` by columns: busy over busy and waiting time, summed over the threads."""
    summed = threads.groupby(by)[["busy_seconds", "waiting_seconds"]].sum()
    whole = summed.sum(axis=1)
    return (summed["busy_seconds"] / whole.where(whole > 0)).rename("busy_share")


def _best(limits: pd.DataFrame, threads: int, working_set: float) -> tuple[str | None, float, float, float]:
    """Return the level of memory and the size that a working set is compared with, its copy rate, and the
    rate of arithmetic, each the best measured on as many threads; on the most measured if the run had more.

    The size is the largest measured that is not above the working set: a smaller one is copied no slower, so
    that the rate stays a limit.
    """
    known = limits[limits["threads"] <= threads]
    known = known[known["threads"] == known["threads"].max()]
    copies, arithmetic = (known[known["limit"] == limit] for limit in (COPY, ARITHMETIC))
    if copies.empty or arithmetic.empty:
        return None, np.nan, np.nan, np.nan
    sizes = copies["working_set_bytes"]
    size = sizes[sizes <= max(working_set, sizes.min())].max()
    chosen = copies[sizes == size]
    copy_rate, arithmetic_rate = float(chosen["best"].max()), float(arithmetic["best"].max())
    return str(chosen["level"].iloc[0]), float(size), copy_rate, arithmetic_rate
