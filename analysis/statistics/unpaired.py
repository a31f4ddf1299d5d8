"""Ratios of two sets of processes that were not interleaved: two result folders, two machines."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analysis.statistics.looks import ERROR, share
from analysis.statistics.verdicts import MARGIN, decide, denials, verdict_row
from analysis.support.values import Interval


def judge_unpaired(reference: ArrayLike, candidate: ArrayLike, margin: float = MARGIN) -> dict[str, Any]:
    """Return the columns of `verdicts.judge_one` for candidate / reference, from the times of a process each.

    Uses Welch's t on the logarithms. Whatever changed between the two measurements besides the programs (the
    machine's mood on that day) is not in the interval: only interleaving can see it. `blocks` is the smaller
    number of processes.
    """
    first, second = np.log(np.asarray(reference, dtype=float)), np.log(np.asarray(candidate, dtype=float))
    fewest = min(len(first), len(second))
    estimate = float(second.mean() - first.mean()) if fewest else np.nan
    if fewest < 2:
        return verdict_row(Interval(estimate, -np.inf, np.inf), fewest, 1.0, "inconclusive")
    from scipy import stats  # takes half a second to load, and is seldom needed

    bound = np.log1p(margin)

    def p_value(shift: float, alternative: str) -> float:
        return float(stats.ttest_ind(second - shift, first, equal_var=False, alternative=alternative).pvalue)

    faster, slower = p_value(-bound, "less"), p_value(bound, "greater")
    not_faster, not_slower = p_value(-bound, "greater"), p_value(bound, "less")
    verdict, p = decide(faster, slower, equivalent=max(not_faster, not_slower), blocks=fewest)
    shown = stats.ttest_ind(second, first, equal_var=False).confidence_interval(1 - ERROR * share(fewest))
    row = verdict_row(Interval(estimate, float(shown.low), float(shown.high)), fewest, p, verdict)
    return {**row, **denials(faster, slower, not_faster, not_slower, fewest)}
