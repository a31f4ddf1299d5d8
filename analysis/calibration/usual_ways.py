"""What the usual ways of comparing two programs say of the same stream.

Each takes the single times of a stretch of rounds. Where one program is measured first and then the other,
the times of the first are those of one stretch and the times of the other those of the next. All contenders
take turns in the stream, so that ten times of one are spread over ten rounds of all.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from analysis.calibration.streams import Stream
from analysis.support.values import Floats

Said = NDArray[np.int64]
"""Of each study: 1 slower, -1 faster, 0 no difference."""

TIMES = 10
"""Of each of the two."""

ERROR = 0.05
TRIES = 5
MOST_STARTS = 2000


def u_test(first: Floats, second: Floats) -> Said:
    """Return what Mann-Whitney's U says at 0.05, as Google Benchmark's compare.py does; studies are rows."""
    p = stats.mannwhitneyu(first, second, alternative="two-sided", axis=1).pvalue
    return _direction(np.median(second, axis=1) - np.median(first, axis=1), p < ERROR)


def welch(first: Floats, second: Floats) -> Said:
    """Return what Welch's t test says at 0.05."""
    p = stats.ttest_ind(first, second, equal_var=False, axis=1).pvalue
    return _direction(second.mean(axis=1) - first.mean(axis=1), p < ERROR)


def least(first: Floats, second: Floats, more: float = 0.0) -> Said:
    """Return which has the least time, where it is less by more than this part."""
    change = np.log(second.min(axis=1) / first.min(axis=1))
    return _direction(change, np.abs(change) > np.log1p(more))


def ranges(first: Floats, second: Floats) -> Said:
    """Return which is slower by mean and deviation, as hyperfine prints them, where they do not overlap."""
    change = second.mean(axis=1) - first.mean(axis=1)
    reach = first.std(axis=1, ddof=1) + second.std(axis=1, ddof=1)
    return _direction(change, np.abs(change) > reach)


def pairs(first: Floats, second: Floats) -> Said:
    """Return what Student's t says at 0.05 of times that are pairs."""
    differences = second - first
    p = stats.ttest_1samp(differences, 0, axis=1).pvalue
    return _direction(differences.mean(axis=1), p < ERROR)


def _direction(change: Floats, differs: NDArray[np.bool_]) -> Said:
    return np.where(differs, np.sign(change), 0).astype(np.int64)


@dataclass(frozen=True)
class Way:
    """One usual way: what it says of times, how many rounds it takes, and how often it is tried again."""

    name: str
    says: Callable[[Floats, Floats], Said]
    interleaved: bool = False
    tries: int = 1

    @property
    def rounds(self) -> int:
        """Of the stream, at most."""
        return TIMES * self.tries * (1 if self.interleaved else 2)

    def studies(self, times: Floats, starts: Sequence[int]) -> Said:
        """Return what it says of the studies that begin at these rounds; `times` has a row a round, the
        reference's and the candidate's.
        """
        said = np.zeros(len(starts), dtype=np.int64)
        for one in range(self.tries):
            begin = np.asarray(starts, dtype=np.int64) + one * self.rounds // self.tries
            first = begin[:, np.newaxis] + np.arange(TIMES)
            second = first if self.interleaved else first + TIMES
            again = self.says(times[first, 0], times[second, 1])
            said = np.where(said == 0, again, said)
        return said


WAYS = (
    Way("ten, then ten: U test (compare.py)", u_test),
    Way("ten, then ten: Welch's t", welch),
    Way("the same U test, up to five times", u_test, tries=TRIES),
    Way("ten, then ten: least time", least),
    Way("ten, then ten: least time, 1 % less", partial(least, more=0.01)),
    Way("ten, then ten: mean ± deviation apart", ranges),
    Way("ten interleaved pairs: t", pairs, interleaved=True),
)


COUNTED = ["condition", "way", "more", "studies", "hits", "disjoint"]


def all_ways(streams: Sequence[Stream]) -> pd.DataFrame:
    """Return a row for each stream, way and comparison with the first contender: `condition`, `way`, `more`,
    how many `studies`, how many of them were `hits`, which say slower, or faster where neither does more, and
    how many would not overlap (`disjoint`).
    """
    rows = []
    for stream in streams:
        flat = stream.seconds.reshape(-1, len(stream.more))
        for way in WAYS:
            places = max(0, len(flat) - way.rounds + 1)
            starts = range(0, places, max(1, places // MOST_STARTS))
            for candidate, more in list(enumerate(stream.more))[1:]:
                said = way.studies(flat[:, [0, candidate]], starts) if starts else np.zeros(0)
                hits = int(((said > 0) | ((said < 0) & (more == 0))).sum())
                rows.append((stream.condition, way.name, more, len(said), hits, len(flat) // way.rounds))
    return pd.DataFrame(rows, columns=COUNTED)
