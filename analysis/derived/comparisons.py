"""What an experiment compares with what, by which margin and error, and what each difference comes to."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.statistics.intervals import FEWEST, centre
from analysis.statistics.looks import ERROR, share
from analysis.statistics.pairs import log_ratios, process_medians
from analysis.statistics.verdicts import MARGIN, judge

PUBLISHED = "published"


@dataclass(frozen=True)
class Stated:
    """What a question states of its verdicts before anything is measured: the least difference that matters,
    as a fraction, and the greatest share of studies in which any verdict of a table may be wrong.
    """

    margin: float = MARGIN
    error: float = ERROR


USUAL = Stated()


def stated(records: pd.DataFrame) -> Stated:
    """Return what the latest record of an experiment states; the defaults where it states nothing, as records
    did before questions could.
    """
    return Stated(_latest(records, "margin", 1, MARGIN), _latest(records, "error", 0.5, ERROR))


def reference(times: pd.DataFrame) -> str:
    """Return the series that the others are compared with: the one that the question names. Without one it is
    the only one of the published variant, or else the first in the question's file.

    It never depends on the times, or the verdicts would be biased.
    """
    latest = times.sort_values("recorded_at", kind="stable").iloc[-1]
    if latest["reference"] in set(times["series"]):
        return str(latest["reference"])
    published = times.loc[times["variant"] == PUBLISHED, "series"].unique()
    if len(published) == 1:
        return str(published[0])
    return str(times.sort_values(["series_number", "series"], na_position="last")["series"].iloc[0])


def differences(times: pd.DataFrame, against: str) -> pd.DataFrame:
    """Return a row of `verdicts.judge` for every other series and x, compared within blocks with the series
    `against` at the same x, Holm-corrected over all of them, by the margin and the error that are stated.
    """
    processes, by = process_medians(times), stated(times)
    first, others = (processes[(processes["series"] == against) == side] for side in (True, False))
    pairs = [
        log_ratios(first, part, match=("x",)).assign(series=name) for name, part in others.groupby("series")
    ]
    columns = ["series", "x", "log_ratio"]
    table = pd.concat(pairs) if pairs else pd.DataFrame(columns=columns)
    found = judge(table, ["series", "x"], by.margin)
    return found if by.error == ERROR else _at(found, table, by)


def _at(found: pd.DataFrame, pairs: pd.DataFrame, by: Stated) -> pd.DataFrame:
    """Return the table of `judge` with the intervals and verdicts of another error than `ERROR`.

    A p-value is the smallest error at which an interval decides, and it decides for what its centre lies in.
    """
    groups = {key: group["log_ratio"] for key, group in pairs.groupby(["series", "x"])}
    rows = []
    for row in found.to_dict("records"):
        values = groups[row["series"], row["x"]][: row["blocks"]]
        interval = centre(values, 1 - by.error * share(row["blocks"]))
        decided = row["p"] <= by.error and row["blocks"] >= FEWEST
        ends = {"low": float(np.exp(interval.low)), "high": float(np.exp(interval.high))}
        rows.append({**row, **ends, "verdict": _side(row["ratio"], by.margin) if decided else "inconclusive"})
    return pd.DataFrame(rows, columns=found.columns)


def _side(ratio: float, margin: float) -> str:
    if ratio < 1 / (1 + margin):
        return "faster"
    return "slower" if ratio > 1 + margin else "equivalent"


def _latest(records: pd.DataFrame, tag: str, most: float, default: float) -> float:
    """Return the number that the latest record has for a tag; the default for none, or for one that is none
    between 0 and `most`.
    """
    if records.empty:
        return default
    value = pd.to_numeric(records.sort_values("recorded_at", kind="stable")[tag].tail(1), errors="coerce")
    found = float(value.iloc[0])
    return found if 0 < found <= most else default
