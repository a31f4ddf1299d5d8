"""Alternatives in the order of their times, those that cannot be told apart bracketed together; and which
choices no other beats in both of two costs.
"""

from collections.abc import Collection, Sequence
from itertools import combinations
from string import ascii_lowercase

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from analysis.statistics.pairs import log_ratios
from analysis.statistics.verdicts import MARGIN, judge

APART = ("faster", "slower")


def ranking(times: pd.DataFrame, margin: float = MARGIN) -> pd.DataFrame:
    """Return a row a series, the fastest first: `series`, `seconds` (median over processes), `bracket`, and
    `place`, the least and the greatest that it may have.

    All pairs are compared within blocks and corrected for their number (see `verdicts.judge`). Two series
    without a letter of `bracket` in common differ by more than the margin; what has one in common cannot be
    told apart, or differs by less (all pairs displayed as lines: Piepho, J. Comput. Graph. Stat. 13, 2004).
    """
    seconds = times.groupby("series")["steps_seconds"].median().sort_values(kind="stable")
    names = [str(name) for name in seconds.index]
    apart = _apart(times, names, margin)
    letters = brackets(names, apart)
    rows = []
    for name in names:
        better = sum((other, name) in apart for other in names)
        worse = sum((name, other) in apart for other in names)
        rows.append((name, seconds[name], letters[name], (1 + better, len(names) - worse)))
    return pd.DataFrame(rows, columns=["series", "seconds", "bracket", "place"])


def _apart(processes: pd.DataFrame, names: Sequence[str], margin: float) -> set[tuple[str, str]]:
    """Return the pairs of which the first is faster than the second beyond doubt."""
    parts = {name: processes[processes["series"] == name] for name in names}
    pairs = [
        log_ratios(parts[one], parts[two], match=("x",)).assign(one=one, two=two)
        for one, two in combinations(names, 2)
    ]
    if not pairs:
        return set()
    verdicts = judge(pd.concat(pairs), ["one", "two"], margin)
    decided = verdicts[verdicts["verdict"].isin(APART)]
    return {
        (row.one, row.two) if row.verdict == "slower" else (row.two, row.one) for row in decided.itertuples()
    }


def brackets(names: Sequence[str], apart: Collection[tuple[str, str]]) -> dict[str, str]:
    """Return letters for each of the ordered names, one a longest stretch in which no two are apart."""
    different = {frozenset(pair) for pair in apart}
    stretches: list[tuple[int, int]] = []
    for first in range(len(names)):
        last = first
        while last + 1 < len(names) and not any(
            frozenset((names[last + 1], names[one])) in different for one in range(first, last + 1)
        ):
            last += 1
        if not stretches or last > stretches[-1][1]:
            stretches.append((first, last))
    letters = [f"{letter}{rounds or ''}" for rounds in range(len(stretches)) for letter in ascii_lowercase]
    named = list(zip(letters, stretches, strict=False))
    return {
        name: "".join(letter for letter, (first, last) in named if first <= number <= last)
        for number, name in enumerate(names)
    }


def front(error: ArrayLike, time: ArrayLike) -> NDArray[np.bool_]:
    """Return which points are on the Pareto front: no other has at most their error and at most their time.

    Of points that are equal in both, the first is on it. A point whose error or time is NaN never is.
    """
    errors, times = np.asarray(error, dtype=float), np.asarray(time, dtype=float)
    on_front = np.zeros(len(errors), dtype=bool)
    least = np.inf
    for index in np.lexsort((times, errors)):
        if np.isfinite(errors[index]) and times[index] < least:
            on_front[index] = True
            least = times[index]
    return on_front
