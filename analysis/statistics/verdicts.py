"""Verdicts on ratios against a margin stated beforehand: faster, slower, equivalent or inconclusive."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analysis.statistics.intervals import FEWEST, measure
from analysis.statistics.looks import ERROR, seen, share
from analysis.statistics.stopping import unstopped
from analysis.support.values import Floats, Interval

MARGIN = 0.02
COLUMNS = ["ratio", "low", "high", "blocks", "p", "verdict", "alone"]


def judge(pairs: pd.DataFrame, by: list[str], margin: float = MARGIN, error: float = ERROR) -> pd.DataFrame:
    """Return one row a group of `by` with its ratio, interval and verdict, Holm-corrected over the whole
    table.

    Columns: `ratio` (candidate / reference) with its 95 % interval `low`, `high`, which decides and is shown,
    `blocks`, `p`, `verdict`; `alone` is p before the correction over the rows.

    *faster*: the interval lies below 1 / (1 + margin); *slower*: above 1 + margin; *equivalent*: between the
    two. A verdict is wrong only where the interval misses the truth, in at most 5 % of all, wherever that
    lies: the smallest effect that matters is a region, not two tests at 5 % each (Schuirmann, J.
    Pharmacokinet. Biopharm. 15, 1987, whose 90 % interval errs in 5 % on either side; Westlake, Biometrics
    32, 1976, whose 95 % interval is used here). `p` is the smallest error at which the interval decides; it
    is corrected over the looks (see `looks`), as the interval is, and over the rows (Holm, Scand. J. Stat. 6,
    1979). What is not established, and anything from fewer than `FEWEST` blocks, is *inconclusive*. The
    pairs of a group are in the order of time. With another `error` than 5 % the intervals are of its level.
    """
    rows = [
        dict(zip(by, key, strict=True))
        | judge_one(group["log_ratio"], margin, error, biases=group.get("bias"), stops=group.get("stops"))
        for key, group in pairs.groupby(by, sort=True)
    ]
    table = pd.DataFrame(rows, columns=[*by, *COLUMNS])
    return corrected(table, error)


def corrected(table: pd.DataFrame, error: float = ERROR) -> pd.DataFrame:
    """Return the table with p-values Holm-corrected and verdicts withdrawn where they no longer stand."""
    p = holm(table["p"])
    verdicts = np.where(np.array(p) <= error, table["verdict"], "inconclusive")
    return table.assign(p=p, verdict=verdicts)


def judge_one(
    log_ratios: ArrayLike,
    margin: float = MARGIN,
    error: float = ERROR,
    *,
    once: bool = False,
    biases: ArrayLike | None = None,
    stops: ArrayLike | None = None,
) -> dict[str, Any]:
    """Return the row of one comparison standing alone: the columns that `judge` adds, and `denials`.

    The log ratios are in the order of time; those up to the last planned look count. `once`: how many values
    there are was settled before the first of them, and each has a seed of its own: they are looked at once,
    the whole of the error is this look's, and none depends on the one before. `biases`: by how much each log
    ratio is too great because of how it was measured, NaN where not known. Where half of them are known, and
    the middle of the means of each two is more than two of its standard errors from 0, the verdict has to
    stand with and without it, and the interval reaches over both: turns of every second block begin at other
    steps, so that unlike steps leave the mean of two. `stops`: how often a run of the programs was stopped;
    where some blocks have far more, the ratio is that of no stops at all (see `stopping`).
    """
    values = np.asarray(log_ratios, dtype=float)
    values = values if once else seen(values)
    if stops is not None and len(values) >= FEWEST:
        values, factor = unstopped(values, np.asarray(stops, dtype=float)[: len(values)])
        if factor > 1:
            return _judged(values, margin, error, once, factor)
    known = np.empty(0) if biases is None else np.asarray(biases, dtype=float)[: len(values)]
    known = known[~np.isnan(known)]
    row = _judged(values, margin, error, once)
    of_two = known[: known.size // 2 * 2].reshape(-1, 2).mean(axis=1)
    if not 0 < len(values) <= 2 * known.size or not _is_sure(of_two):
        return row
    return _both(row, _judged(values - np.median(of_two), margin, error, once))


def _is_sure(biases: Floats) -> bool:
    """Whether their middle is none by chance; the error of a median is that of a mean times a fourth more."""
    if len(biases) < 2:
        return False
    error = np.sqrt(np.pi / 2) * biases.std(ddof=1) / np.sqrt(len(biases))
    return bool(abs(np.median(biases)) > 2 * error)


def _judged(values: Floats, margin: float, error: float, once: bool, factor: float = 1.0) -> dict[str, Any]:
    bound, blocks = np.log1p(margin), len(values)
    part = 1.0 if once else share(blocks)
    found = measure(values, independent=once, factor=factor)
    faster, slower = found.p_value(-bound, "less"), found.p_value(bound, "greater")
    not_faster, not_slower = found.p_value(-bound, "greater"), found.p_value(bound, "less")
    verdict, p = decide(faster, slower, max(not_faster, not_slower), blocks, part, error)
    row = verdict_row(found.interval(1 - error * part), blocks, p, verdict)
    return {**row, **denials(faster, slower, not_faster, not_slower, blocks, part)}


def _both(one: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Return the row of what both rows say: the hull of their intervals, the greater of their p-values."""
    greater = {key: max(one[key], other[key]) for key in one if key not in ("ratio", "low", "verdict")}
    verdict = one["verdict"] if one["verdict"] == other["verdict"] else "inconclusive"
    return {**one, **greater, "low": min(one["low"], other["low"]), "verdict": verdict}


def error_of_picked(candidates: int) -> float:
    """Return the error of one of all comparisons between so many candidates, for `judge_one`: who compares
    the best of them with another has picked one of all pairs. All together may err in 5 % (Bonferroni).
    """
    return ERROR / max(1, candidates * (candidates - 1) // 2)


def verdict_row(log_ratio: Interval, blocks: int, p: float, verdict: str) -> dict[str, Any]:
    """Return the columns that `judge` adds, of an interval of a log ratio."""
    return dict(zip(COLUMNS, (*np.exp(log_ratio).tolist(), blocks, p, verdict, p), strict=True))


def denials(
    faster: float, slower: float, not_faster: float, not_slower: float, blocks: int, part: float | None = None
) -> dict[str, float]:
    """Return the p-values of what denies each verdict, given those of four one-sided tests: the smallest
    error at which the interval has no part in what the verdict says, whatever else it reaches into.
    """
    contrary = {"not_faster": not_faster, "not_slower": not_slower, "not_equivalent": min(faster, slower)}
    return {name: two_sided(p, blocks, part) for name, p in contrary.items()}


def decide(
    faster: float,
    slower: float,
    equivalent: float,
    blocks: int,
    part: float | None = None,
    error: float = ERROR,
) -> tuple[str, float]:
    """Return the verdict and its p-value, given the one-sided p-value against each of the three being untrue.

    They are doubled: at most `error` is where the two-sided interval lies within what the verdict says.
    """
    support = {"faster": faster, "slower": slower, "equivalent": equivalent}
    best = min(support, key=lambda verdict: support[verdict])
    p = two_sided(support[best], blocks, part)
    return best if p <= error else "inconclusive", p


def two_sided(p: float, blocks: int, part: float | None = None) -> float:
    """Return the p-value at which the two-sided interval decides what a one-sided test gives `p` for, over
    all looks, or over that `part` of the error; 1 from fewer than `FEWEST` blocks. It is not cut at 1, so
    that it tells how far a verdict is.
    """
    return 2 * p / (share(blocks) if part is None else part) if blocks >= FEWEST else 1.0


def holm(p_values: Sequence[float] | pd.Series) -> list[float]:
    """Return the p-values adjusted by Holm's step-down method, in the order given."""
    p = np.asarray(p_values, dtype=float)
    order = np.argsort(p)
    adjusted = np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1)).clip(max=1.0)
    result = np.empty_like(p)
    result[order] = adjusted
    return [float(value) for value in result]
