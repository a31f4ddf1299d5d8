"""What an experiment compares with what, by which margin and error, and what each difference comes to."""

from dataclasses import dataclass

import pandas as pd

from analysis.statistics.looks import ERROR
from analysis.statistics.pairs import log_ratios, narrow
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


def differences(times: pd.DataFrame, against: str, by: Stated | None = None) -> pd.DataFrame:
    """Return a row of `verdicts.judge` for every other series and x, compared within blocks with the series
    `against` at the same x, Holm-corrected over all of them, by the margin and the error that are stated, or
    by those given.
    """
    return _judged(times, times["series"] == against, by or stated(times), match=("x",))


def differences_from(times: pd.DataFrame, chosen: pd.Series) -> pd.DataFrame:
    """Return a row of `verdicts.judge` for every series and x but that of the rows `chosen`, compared within
    blocks with these, Holm-corrected over all of them. What is chosen must not depend on the times.
    """
    return _judged(times, chosen, stated(times))


def _judged(times: pd.DataFrame, chosen: pd.Series, by: Stated, match: tuple[str, ...] = ()) -> pd.DataFrame:
    times = narrow(times, "series", "x")
    own = tuple(name for name in ("series", "x") if name not in match)
    # Both sides have these columns, of which only those of the candidates are told.
    table = log_ratios(times[chosen].drop(columns=list(own)), times[~chosen], match, by=own)
    return judge(table, ["series", "x"], by.margin, by.error)


def _latest(records: pd.DataFrame, tag: str, most: float, default: float) -> float:
    """Return the latest record's number for a tag; the default for none, or for one not up to `most`."""
    if records.empty:
        return default
    value = pd.to_numeric(records.sort_values("recorded_at", kind="stable")[tag].tail(1), errors="coerce")
    found = float(value.iloc[0])
    return found if 0 < found <= most else default
