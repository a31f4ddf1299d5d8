"""Programs that are stopped now and then, against the same programs without a pause."""

import pandas as pd

from analysis.statistics.intervals import FEWEST, centre
from analysis.statistics.pairs import log_ratios

IN_SLICES, WITHOUT = "in slices", "without a pause"
"""What the two ways are called, by label."""


def ratios(times: pd.DataFrame) -> pd.DataFrame:
    """Return a row a program (`series`): its log ratio in slices to that without a pause (`ratio`, an
    Interval), the number of `blocks`, the median `seconds` without a pause, and whether it took turns
    (`sliced`).
    """
    rows = []
    for series, group in times.sort_values("series_number").groupby("series", sort=False):
        reference, candidate = (group[group["label"] == label] for label in (WITHOUT, IN_SLICES))
        ratios = log_ratios(reference, candidate)["log_ratio"]
        if len(ratios) >= FEWEST:
            seconds = float(reference["steps_seconds"].median())
            sliced = bool(candidate["in_turns"].mean() > 0.5)
            rows.append((series, centre(ratios, 0.95), len(ratios), seconds, sliced))
    return pd.DataFrame(rows, columns=["series", "ratio", "blocks", "seconds", "sliced"])
