"""Verdicts on ratios against a margin stated beforehand: faster, slower, equivalent or inconclusive."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analysis.statistics.intervals import centre, p_value

MARGIN = 0.02
ERROR = 0.05
COLUMNS = ["ratio", "low", "high", "decision_low", "decision_high", "blocks", "p", "verdict"]


def judge(
    pairs: pd.DataFrame, by: list[str], margin: float = MARGIN, value: str = "log_ratio"
) -> pd.DataFrame:
    """Return one row a group of `by` with its ratio, intervals and verdict, Holm-corrected over the whole
    table.

    Columns: `ratio` (candidate / reference) with `low`, `high` (95 %) and `decision_low`, `decision_high`
    (90 %, the interval that two one-sided 5 % tests use), `blocks`, `p`, `verdict`.

    *faster*: the ratio is below 1 / (1 + margin); *slower*: above 1 + margin; *equivalent*: between the two
    (Schuirmann, J. Pharmacokinet. Biopharm. 15, 1987: two one-sided tests). Exactly one of the three is
    true, so the best supported is tested at 5 % (partitioning principle), then corrected over the rows
    (Holm, Scand. J. Stat. 6, 1979). What is not established is *inconclusive*.
    """
    rows: list[dict[str, Any]] = []
    for key, group in pairs.groupby(by, sort=True):
        rows.append({**dict(zip(by, key, strict=True)), **judge_one(group[value], margin)})
    table = pd.DataFrame(rows, columns=[*by, *COLUMNS])
    return corrected(table)


def corrected(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table with its p-values Holm-corrected and its verdicts withdrawn where they no longer
    stand.
    """
    p = holm(table["p"])
    verdicts = np.where(np.array(p) <= ERROR, table["verdict"], "inconclusive")
    return table.assign(p=p, verdict=verdicts)


def judge_one(log_ratios: ArrayLike, margin: float = MARGIN) -> dict[str, Any]:
    """Return the row of one comparison standing alone: the columns that `judge` adds."""
    values = np.asarray(log_ratios, dtype=float)
    bound = np.log1p(margin)
    verdict, p = decide(
        faster=p_value(values, -bound, "less"),
        slower=p_value(values, bound, "greater"),
        equivalent=max(p_value(values, -bound, "greater"), p_value(values, bound, "less")),
    )
    shown, decisive = centre(values, 0.95), centre(values, 1 - 2 * ERROR)
    return {
        "ratio": float(np.exp(shown.estimate)),
        "low": float(np.exp(shown.low)),
        "high": float(np.exp(shown.high)),
        "decision_low": float(np.exp(decisive.low)),
        "decision_high": float(np.exp(decisive.high)),
        "blocks": len(values),
        "p": p,
        "verdict": verdict,
    }


def decide(faster: float, slower: float, equivalent: float) -> tuple[str, float]:
    """Return the verdict and its p-value, given the p-value against each of the three being untrue."""
    support = {"faster": faster, "slower": slower, "equivalent": equivalent}
    best = min(support, key=lambda verdict: support[verdict])
    return best if support[best] <= ERROR else "inconclusive", support[best]


def not_faster(log_ratios: ArrayLike, margin: float = MARGIN) -> bool:
    """Tell whether it is established that the candidate is not faster than the reference by more than the
    margin.
    """
    return p_value(log_ratios, -np.log1p(margin), "greater") <= ERROR


def holm(p_values: Sequence[float] | pd.Series) -> list[float]:
    """Return the p-values adjusted by Holm's step-down method, in the order given."""
    p = np.asarray(p_values, dtype=float)
    order = np.argsort(p)
    adjusted = np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1)).clip(max=1.0)
    result = np.empty_like(p)
    result[order] = adjusted
    return [float(value) for value in result]
