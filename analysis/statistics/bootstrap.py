"""The median with an interval that respects how the samples came about: session > process > repetition."""

import numpy as np
import pandas as pd
from scipy import special

from analysis.statistics.pairs import narrow, runs_of
from analysis.support.values import Floats

REPLICATES = 2000
SEED = 20240229
FEWEST = 4
"""Processes of which fewer tell no interval of their median."""


def summarise(
    times: pd.DataFrame, by: list[str], value: str = "steps_seconds", level: float = 0.95
) -> pd.DataFrame:
    """Return per group of `by`: `median`, `low`, `high` of `value`, and how many sessions, processes,
    samples. Takes a row a process.

    The median is that of the processes' medians. The interval comes from a hierarchical bootstrap (Davison
    and Hinkley, "Bootstrap Methods and their Application", 1997, section 3.8): sessions are drawn with
    replacement, then processes within each, then repetitions within each. Its percentiles are too narrow for
    few processes and are widened, in logarithms about the median, as much as Student's t is wider than the
    normal and a sample's deviation less than the true one (Hesterberg, Am. Stat. 69, 2015, section 4.1).
    Fewer than `FEWEST` processes give no interval: its ends are NaN.
    """
    rows = []
    for key, group in narrow(times, *by, value=value).groupby(by, sort=True):
        padded = _padded(group, value)
        medians = _row_medians(padded.reshape(-1, padded.shape[2]))
        median, processes = float(_row_medians(medians[np.newaxis])[0]), group["file"].nunique()
        ends = _widened(padded, median, processes, level)
        samples = int(np.isfinite(padded).sum())
        rows.append((*key, median, *ends, padded.shape[0], processes, samples))
    return pd.DataFrame(rows, columns=[*by, "median", "low", "high", "sessions", "processes", "samples"])


def _widened(padded: Floats, median: float, processes: int, level: float) -> tuple[float, float]:
    if processes < FEWEST:
        return np.nan, np.nan
    tail = (1 + level) / 2
    wider = special.stdtrit(processes - 1, tail) / special.ndtri(tail) * np.sqrt(processes / (processes - 1))
    # Of few processes the median has few values: between them, not at the nearest one, is the quantile (Ma,
    # Genton and Parzen, Ann. Inst. Stat. Math. 63, 2011).
    values, counts = np.unique(_replicates(padded), return_counts=True)
    levels = (np.cumsum(counts) - counts / 2) / counts.sum()
    low, high = median * (np.interp([1 - tail, tail], levels, values) / median) ** wider
    return float(low), float(high)


def _padded(group: pd.DataFrame, value: str) -> Floats:
    """Arrange the samples as sessions x processes x repetitions, NaN where there are fewer than the most."""
    runs = [np.atleast_1d(one) for one in group.get(runs_of(value), group[value])]
    session = pd.factorize(group["session"])[0]
    process = group.groupby("session").cumcount().to_numpy()
    padded = np.full((session.max() + 1, process.max() + 1, max(map(len, runs))), np.nan)
    for place, one in zip(zip(session, process, strict=True), runs, strict=True):
        padded[place][: len(one)] = one
    return padded


def _replicates(padded: Floats) -> Floats:
    """Return the statistic of each bootstrap replicate; the seed is fixed, so the same data give the same
    interval.

    Repetitions are not drawn one by one: of n draws with replacement the k-th smallest is the sample's
    quantile at a level that is distributed as Beta(k, n + 1 - k) (Maritz and Jarrett, "A note on estimating
    the variance of the sample median", 1978), so that a process costs the same for any number of them.
    """
    generator = np.random.default_rng(SEED)
    counts = (~np.isnan(padded)).sum(axis=2)
    processes = (counts > 0).sum(axis=1)
    sessions, most_processes, _ = padded.shape
    session = generator.integers(sessions, size=(REPLICATES, sessions, 1))
    process = (generator.random((REPLICATES, sessions, most_processes)) * processes[session]).astype(int)
    count = counts[session, process]
    lower = (count + 1) // 2
    level = generator.beta(lower, count + 1 - lower)
    # Of an even number the median lies between two: the second one is the least of those above the first.
    above = level + (1 - level) * generator.beta(1, np.maximum(count - lower, 1))
    ordered = np.sort(padded, axis=2)
    middle = [
        ordered[session, process, np.minimum((one * count).astype(int), count - 1)]
        for one in (level, np.where(count % 2, level, above))
    ]
    medians: Floats = (middle[0] + middle[1]) / 2
    medians[np.arange(most_processes) >= processes[session]] = np.nan
    return _row_medians(medians.reshape(REPLICATES, -1))


def _row_medians(rows: Floats) -> Floats:
    """Return the median of each row without its NaN, if it has more; faster than np.nanmedian."""
    ordered = np.sort(rows, axis=1)
    count = (~np.isnan(ordered)).sum(axis=1)
    index = np.arange(len(ordered))
    lower, upper = np.maximum((count - 1) // 2, 0), np.minimum(count // 2, ordered.shape[1] - 1)
    return (ordered[index, lower] + ordered[index, upper]) / 2
