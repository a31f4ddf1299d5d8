"""Paired ratios: two configurations measured in one block of the interleaving, by one session on one node."""

import numpy as np
import pandas as pd

PAIR = ["node", "block", "session"]
"""What two records of a pair have in common: nothing else was measured together."""


def process_medians(times: pd.DataFrame, value: str = "steps_seconds") -> pd.DataFrame:
    """Return one row a process (a record): its columns of context and the median of its repetitions as
    `value`.

    A process is one sample of whatever changes from start to start (placement in memory, the machine's mood);
    its repetitions are not independent of each other.
    """
    medians = times.groupby("file", sort=False)[value].median()
    first = times.drop_duplicates("file").set_index("file")
    return first.assign(**{value: medians}).reset_index()


def join_replicates(times: pd.DataFrame) -> pd.DataFrame:
    """Return the times with the replicates that a block has of one point, by series and x, as one process:
    the geometric mean of theirs. What the block suffers they share, so that they are no samples of it; times
    without replicates are returned as they are.
    """
    keys = ["series", "x", *PAIR]
    processes = process_medians(times)
    if not processes.duplicated(keys).any():
        return times
    logs = np.log(processes["steps_seconds"]).groupby([processes[key] for key in keys]).transform("mean")
    return processes.assign(steps_seconds=np.exp(logs)).drop_duplicates(keys)


def log_ratios(
    reference: pd.DataFrame,
    candidate: pd.DataFrame,
    match: tuple[str, ...] = (),
    value: str = "steps_seconds",
) -> pd.DataFrame:
    """Return a row a pair: the columns of `match`, those of `PAIR` and `log_ratio` = ln(candidate /
    reference).

    Takes a row a process on either side; of the replicates that a block has of one configuration it takes the
    mean logarithm, since the median of several lies below a single time wherever noise is skewed. Drift from
    block to block cancels in the ratio, which is why blocks and not samples are the unit of every interval. A
    process without a partner of its own session has no ratio: the machine may have been another since.
    """
    keys = [*match, *PAIR]
    joined = _per_block(reference, keys, value).merge(
        _per_block(candidate, keys, value),
        left_index=True,
        right_index=True,
        suffixes=("_reference", "_candidate"),
    )
    ratios = joined["log_candidate"] - joined["log_reference"]
    return ratios.rename("log_ratio").reset_index()


def without_partner(runs: pd.DataFrame) -> pd.DataFrame:
    """Return the runs, a row each, that are in no ratio: of what they are compared with, nothing was measured
    in their block by their session.

    Compared are the series of a scene at one x, or the values of x where a single series has that x.
    """
    scene = runs["scene_name"].fillna("")
    place = [scene, runs["x"]]
    several = runs["series"].groupby(place).transform("nunique") > 1
    together = [scene, *(runs[key] for key in PAIR)]
    beside = runs["series"].groupby([*together, runs["x"]]).transform("nunique")
    along = runs["x"].groupby(together).transform("nunique")
    has_others = several | (runs["x"].groupby(scene).transform("nunique") > 1)
    return runs[has_others & (beside.where(several, along) < 2)]


def _per_block(processes: pd.DataFrame, keys: list[str], value: str) -> pd.DataFrame:
    logs = processes.assign(log=np.log(processes[value]))
    return logs.groupby(keys).agg({"log": "mean"})
