"""Tables of what came of the studies."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from analysis.calibration.bounds import interval, upper_bound
from analysis.calibration.streams import Stream
from analysis.calibration.studies import DECIDED, quantile_until_found

OURS = "Carom"
FOUND_WITHIN_SECONDS = 60.0
TO_BE_FOUND = 0.05

STREAM = ["kind", "condition"]


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
        wrong = int(apart["wrong"].sum())
        stretches = apart.groupby([*STREAM, "start"])["wrong"].any()
        rows.append(
            {
                **dict(zip(by, key, strict=True)),
                "studies": len(over),
                "decided": float(over["verdict"].isin(DECIDED).mean()),
                "wrong": int(over["wrong"].sum()),
                "missed": int((~over["covered"]).sum()),
                "disjoint": len(apart),
                "disjoint_wrong": wrong,
                "bound": upper_bound(wrong, len(apart)),
                "stretches": len(stretches),
                "stretches_wrong": int(stretches.sum()),
                "stretch_bound": upper_bound(int(stretches.sum()), len(stretches)),
            }
        )
    return pd.DataFrame(rows)


def power(studies: pd.DataFrame, more: float = TO_BE_FOUND) -> pd.DataFrame:
    """Return a row a stream: of the overlapping studies of a candidate with so much more work, the part that
    found it slower in `FOUND_WITHIN_SECONDS` (`found`), and by how many seconds half, and nine of ten, had.
    """
    asked = studies[(studies["more"] == more) & ~studies["disjoint"]]
    rows = []
    for key, group in asked.groupby(STREAM, sort=False):
        in_time = (group["verdict"] == "slower") & (group["seconds"] <= FOUND_WITHIN_SECONDS)
        rows.append(
            {
                **dict(zip(STREAM, key, strict=True)),
                "studies": len(group),
                "found": float(in_time.mean()),
                "half": quantile_until_found(group, 0.5),
                "nine_of_ten": quantile_until_found(group, 0.9),
                "longest": float(group["seconds"].max()),
            }
        )
    return pd.DataFrame(rows)


def ours_and_theirs(studies: pd.DataFrame, ways: pd.DataFrame, streams: Sequence[Stream]) -> pd.DataFrame:
    """Return a row for each condition, way and amount of more work, over all kinds: `said` is the part of the
    studies that said there is a difference, be it in either direction where there is none, and that the
    candidate is slower where it does more; `low` and `high` are the exact interval of that share in as many
    tries as would not overlap.
    """
    counted = pd.concat([_ours(studies, streams), ways], ignore_index=True)
    counted["hits"] = counted["slower"] + np.where(counted["more"] == 0, counted["faster"], 0)
    rows = []
    for key, group in counted.groupby(["condition", "way", "more"], sort=False):
        tries, disjoint = int(group["studies"].sum()), int(group["disjoint"].sum())
        said = float(group["hits"].sum()) / tries if tries else np.nan
        low, high = interval(said * disjoint, disjoint) if tries and disjoint else (np.nan, np.nan)
        named = dict(zip(("condition", "way", "more"), key, strict=True))
        rows.append({**named, "studies": tries, "said": said, "low": low, "high": high})
    return pd.DataFrame(rows)


def _ours(studies: pd.DataFrame, streams: Sequence[Stream]) -> pd.DataFrame:
    """Return Carom's studies with the first contender, counted as those of the usual ways are."""
    blocks = {(one.kind, one.condition): one.blocks for one in streams}
    rows = []
    over = studies[~studies["disjoint"] & (studies["reference"] == 0)]
    for (kind, condition, more), group in over.groupby([*STREAM, "more"], sort=False):
        rows.append(
            {
                "kind": kind,
                "condition": condition,
                "way": OURS,
                "more": more,
                "studies": len(group),
                "slower": int((group["verdict"] == "slower").sum()),
                "faster": int((group["verdict"] == "faster").sum()),
                "disjoint": int(blocks[kind, condition] / group["blocks"].mean()),
            }
        )
    return pd.DataFrame(rows)
