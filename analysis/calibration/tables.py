"""Tables of what came of the studies."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from analysis.calibration.bounds import interval, upper_bound
from analysis.calibration.streams import Stream
from analysis.calibration.studies import DECIDED
from analysis.calibration.usual_ways import COUNTED

OURS = "Carom"
FOUND_WITHIN_SECONDS = 60.0
TO_BE_FOUND = 0.05

STREAM = ["kind", "condition"]
ERRORS = [
    *("studies", "decided", "wrong", "missed", "disjoint", "disjoint_wrong", "bound"),
    *("stretches", "stretches_wrong", "stretch_bound"),
]


def errors(studies: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Return a row a group of studies: how many overlap (`studies`), what part of them `decided`, how many
    were `wrong` and how many had an interval that `missed` the truth; how many are `disjoint` and how many of
    those were wrong (`disjoint_wrong`), with the exact `bound` (95 %) that this puts on the share. The
    comparisons of one stretch share a contender: of the `stretches` themselves, each counted once, how many
    have anything wrong (`stretches_wrong`), and the bound of that (`stretch_bound`).
    """
    rows = []
    for key, group in studies.groupby(list(by), sort=False):
        apart, over = group[group["disjoint"]], group[~group["disjoint"]]
        stretches = apart.groupby([*STREAM, "start"])["wrong"].any()
        decided, wrong = float(over["verdict"].isin(DECIDED).mean()), int(over["wrong"].sum())
        counts = (len(over), decided, wrong, int((~over["covered"]).sum()))
        rows.append((*key, *counts, *_bounded(apart["wrong"]), *_bounded(stretches)))
    return pd.DataFrame(rows, columns=[*by, *ERRORS])


def _bounded(wrong: pd.Series) -> tuple[int, int, float]:
    hits = int(wrong.sum())
    return len(wrong), hits, upper_bound(hits, len(wrong))


def power(studies: pd.DataFrame, more: float = TO_BE_FOUND) -> pd.DataFrame:
    """Return a row a stream: of the overlapping studies of a candidate with so much more work, the part that
    found it slower in `FOUND_WITHIN_SECONDS` (`found`), and by how many seconds half, and nine of ten, had.
    """
    asked = studies[(studies["more"] == more) & ~studies["disjoint"]]
    rows = []
    for key, group in asked.groupby(STREAM, sort=False):
        until = group["seconds"].where(group["verdict"] == "slower", np.inf)
        half, nine_of_ten = np.quantile(until, (0.5, 0.9), method="higher")
        found, longest = (until <= FOUND_WITHIN_SECONDS).mean(), group["seconds"].max()
        rows.append((*key, len(group), found, half, nine_of_ten, longest))
    return pd.DataFrame(rows, columns=[*STREAM, "studies", "found", "half", "nine_of_ten", "longest"])


def ours_and_theirs(studies: pd.DataFrame, ways: pd.DataFrame, streams: Sequence[Stream]) -> pd.DataFrame:
    """Return a row for each condition, way and amount of more work, over all kinds: `said` is the part of the
    studies that said there is a difference, be it in either direction where there is none, and that the
    candidate is slower where it does more; `low` and `high` are the exact interval of that share in as many
    tries as would not overlap.
    """
    counted = pd.concat([_ours(studies, streams), ways], ignore_index=True)
    rows = []
    for key, sums in counted.groupby(["condition", "way", "more"], sort=False).sum().iterrows():
        tries, hits, disjoint = (int(one) for one in sums)
        said = hits / tries if tries else np.nan
        ends = interval(said * disjoint, disjoint) if tries and disjoint else (np.nan, np.nan)
        rows.append((*key, tries, said, *ends))
    return pd.DataFrame(rows, columns=["condition", "way", "more", "studies", "said", "low", "high"])


def _ours(studies: pd.DataFrame, streams: Sequence[Stream]) -> pd.DataFrame:
    """Return Carom's studies with the first contender, counted as those of the usual ways are."""
    blocks = {(one.kind, one.condition): one.blocks for one in streams}
    rows = []
    over = studies[~studies["disjoint"] & (studies["reference"] == 0)]
    for (kind, condition, more), group in over.groupby([*STREAM, "more"], sort=False):
        hits = group["verdict"].isin(["slower"] if more else ["slower", "faster"]).sum()
        disjoint = int(blocks[kind, condition] / group["blocks"].mean())
        rows.append((condition, OURS, more, len(group), hits, disjoint))
    return pd.DataFrame(rows, columns=COUNTED)
