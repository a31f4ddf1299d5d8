"""Programs that are stopped now and then, against the same programs without a pause."""

import pandas as pd

from analysis.statistics.intervals import FEWEST, centre
from analysis.statistics.pairs import log_ratios

WITHOUT = "without a pause"
STOPPED_BY = {"cgroup": "stopped by a control group", "subreaper": "stopped by signals"}
"""What the other ways are called, by label."""


def ratios(times: pd.DataFrame) -> pd.DataFrame:
    """Return a row a program (`series`) and way (`label`): its log ratio in slices to that without a pause
    (`ratio`, an Interval), the number of `blocks`, the median `seconds` without a pause, and whether it took
    turns (`sliced`).
    """
    rows = []
    for series, group in times.sort_values("series_number").groupby("series", sort=False):
        reference = group[group["label"] == WITHOUT]
        seconds = float(reference["steps_seconds"].median())
        for label in STOPPED_BY:
            candidate = group[group["label"] == label]
            ratios = log_ratios(reference, candidate)["log_ratio"]
            if len(ratios) >= FEWEST:
                sliced = bool(candidate["in_turns"].mean() > 0.5)
                rows.append((series, label, centre(ratios, 0.95), len(ratios), seconds, sliced))
    return pd.DataFrame(rows, columns=["series", "label", "ratio", "blocks", "seconds", "sliced"])
