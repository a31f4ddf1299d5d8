"""Ratios of two sets of processes that were not interleaved: two result folders, two machines."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from analysis.statistics.verdicts import ERROR, MARGIN, decide


def judge_unpaired(reference: ArrayLike, candidate: ArrayLike, margin: float = MARGIN) -> dict[str, Any]:
    """Return the columns of `verdicts.judge` for candidate / reference, from the times of one process each.

    Uses Welch's t on the logarithms. Whatever changed between the two measurements besides the programs (the
    machine's mood on that day) is not in the interval: only interleaving can see it. `blocks` is the smaller
    number of processes.
    """
    first, second = np.log(np.asarray(reference, dtype=float)), np.log(np.asarray(candidate, dtype=float))
    fewest = min(len(first), len(second))
    if fewest < 2:
        ratio = float(np.exp(second.mean() - first.mean())) if fewest else np.nan
        unbounded = {"low": 0.0, "high": np.inf, "decision_low": 0.0, "decision_high": np.inf}
        return {"ratio": ratio, **unbounded, "blocks": fewest, "p": 1.0, "verdict": "inconclusive"}
    bound = np.log1p(margin)

    def p_value(shift: float, alternative: str) -> float:
        return float(stats.ttest_ind(second - shift, first, equal_var=False, alternative=alternative).pvalue)

    test = stats.ttest_ind(second, first, equal_var=False)
    shown, decisive = test.confidence_interval(0.95), test.confidence_interval(1 - 2 * ERROR)
    verdict, p = decide(
        faster=p_value(-bound, "less"),
        slower=p_value(bound, "greater"),
        equivalent=max(p_value(-bound, "greater"), p_value(bound, "less")),
    )
    return {
        "ratio": float(np.exp(second.mean() - first.mean())),
        "low": float(np.exp(shown.low)),
        "high": float(np.exp(shown.high)),
        "decision_low": float(np.exp(decisive.low)),
        "decision_high": float(np.exp(decisive.high)),
        "blocks": fewest,
        "p": p,
        "verdict": verdict,
    }
