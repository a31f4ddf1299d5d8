"""The tables as Markdown, for a page."""

from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from analysis.calibration.tables import FOUND_WITHIN_SECONDS, TO_BE_FOUND

Row = Mapping[Hashable, Any]


def markdown(
    by_stream: pd.DataFrame, by_truth: pd.DataFrame, found: pd.DataFrame, compared: pd.DataFrame
) -> str:
    """Return the tables as Markdown."""
    return "\n\n".join([_errors(by_stream), _truths(by_truth), _power(found), _compared(compared)])


_COUNTS = [
    *("comparisons", "decided", "wrong", "interval misses", "disjoint: wrong", "at most (95 %)"),
    *("stretches: wrong", "at most (95 %)"),
]


def _errors(table: pd.DataFrame) -> str:
    rows = [[row["kind"], row["condition"], *_counts(row)] for row in table.to_dict("records")]
    return "Wrong verdicts:\n\n" + _table(["contenders", "machine", *_COUNTS], rows)


def _truths(table: pd.DataFrame) -> str:
    rows = [[_more(row["more"]), *_counts(row)] for row in table.to_dict("records")]
    return "By the true difference, all streams together:\n\n" + _table(["more work", *_COUNTS], rows)


def _counts(row: Row) -> list[str]:
    tries = row["studies"]
    parts = {name: row[name] / tries if tries else np.nan for name in ("wrong", "missed")}
    counts = [f"{row[name]:.0f} ({_share(part)})" for name, part in parts.items()]
    apart = f"{row['disjoint_wrong']:.0f} of {row['disjoint']:.0f}"
    once = f"{row['stretches_wrong']:.0f} of {row['stretches']:.0f}"
    bounds = [apart, _share(row["bound"]), once, _share(row["stretch_bound"])]
    return [f"{tries:.0f}", _share(row["decided"]), *counts, *bounds]


def _power(table: pd.DataFrame) -> str:
    rows = [
        [
            row["kind"],
            row["condition"],
            _share(row["found"]),
            *(_seconds(row[name]) for name in ("half", "nine_of_ten", "longest")),
        ]
        for row in table.to_dict("records")
    ]
    within = f"within {FOUND_WITHIN_SECONDS:g} s"
    head = ["contenders", "machine", within, "half, s", "nine of ten, s", "longest study, s"]
    return f"A true {_more(TO_BE_FOUND)} found:\n\n" + _table(head, rows)


def _compared(table: pd.DataFrame) -> str:
    parts = []
    for condition, group in table.groupby("condition", sort=False):
        shares = group.pivot_table(index="way", columns="more", values="said", sort=False, dropna=False)
        head = ["way", *(_more(float(one)) for one in shares.columns)]
        by_way = zip(shares.index, shares.to_numpy(), strict=True)
        rows = [[str(way), *(_share(one) for one in row)] for way, row in by_way]
        parts.append(f"Said to differ, {condition}:\n\n" + _table(head, rows))
    return "\n\n".join(parts)


def _more(more: float) -> str:
    return "none" if more == 0 else f"{100 * more:g} %"


def _share(share: float) -> str:
    return "–" if np.isnan(share) else f"{100 * share:.1f} %"


def _seconds(seconds: float) -> str:
    return "not in sight" if np.isinf(seconds) else f"{seconds:.2g}"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
