"""The study's own times in the shape of records, so that one test reads both."""

import pandas as pd

from analysis.records.published import Published
from analysis.statistics.pairs import log_ratios
from analysis.statistics.verdicts import judge_one


def curve(published: Published, experiment: str) -> pd.DataFrame:
    """Return a published sweep as one process a point, all in one block; empty if the study has none."""
    times = published.experiment(experiment)
    columns = {"file": times["x"].astype(str), "steps_seconds": times["seconds"]}
    return times.assign(**columns, node="published", block=0, session="")


def ratio(published: Published, experiment: str, candidate: str, reference: str) -> float:
    """Return the published ratio of two series, paired by repetition; NaN if the study has not both."""
    times = published.experiment(experiment)
    sides = [
        times[times["series"] == series].assign(node="published", block=times["x"], session="")
        for series in (reference, candidate)
    ]
    if any(side.empty for side in sides):
        return float("nan")
    pairs = log_ratios(sides[0], sides[1], value="seconds")
    return float(judge_one(pairs["log_ratio"])["ratio"])
