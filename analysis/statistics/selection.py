"""Comparisons of which some are picked after a look at all of them: the best of many, the farthest off."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analysis.statistics.intervals import Centre, Interval, measure
from analysis.statistics.looks import ERROR, seen, share
from analysis.statistics.verdicts import MARGIN, decide, verdict_row


def pairs_of(candidates: int) -> int:
    """Return how many comparisons there are between so many candidates."""
    return candidates * (candidates - 1) // 2


def interval_among(log_ratios: ArrayLike, comparisons: int) -> Interval:
    """Return the interval of one of so many comparisons, a value of `log_ratios` a block in order of time.

    The intervals of all of them, and of all looks, hold together in at least 95 % of studies (Bonferroni), so
    that it does not matter how the one that is shown was picked.
    """
    found, blocks = _centre(log_ratios)
    return found.interval(1 - ERROR * share(blocks) / comparisons)


def judge_among(log_ratios: ArrayLike, comparisons: int, margin: float = MARGIN) -> dict[str, Any]:
    """Return the columns of `verdicts.judge` for one of so many comparisons, by its `interval_among`.

    Who compares the best of k candidates with the others has picked one of all `pairs_of(k)` comparisons.
    """
    found, blocks = _centre(log_ratios)
    bound = np.log1p(margin)
    faster, slower = found.p_value(-bound, "less"), found.p_value(bound, "greater")
    within = max(found.p_value(-bound, "greater"), found.p_value(bound, "less"))
    verdict, p = decide(faster, slower, within, blocks, share(blocks) / comparisons)
    return verdict_row(interval_among(log_ratios, comparisons), blocks, min(p, 1.0), verdict)


def _centre(log_ratios: ArrayLike) -> tuple[Centre, int]:
    """Return the centre up to the last look, and its blocks; its error is no less than their deviation tells.

    The error by quantiles is far too small by chance in one study of a hundred where a machine has two
    speeds. One comparison can bear that; of a hundred, the one in which it happened is picked.
    """
    values = seen(np.asarray(log_ratios, dtype=float))
    found = measure(values)
    if np.isnan(found.error):
        return found, len(values)
    deviation = float(values.std(ddof=1) / np.sqrt(len(values)))
    return replace(found, error=max(found.error, deviation)), len(values)
