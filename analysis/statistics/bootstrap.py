"""The median with an interval that respects how the samples came about: session > process > repetition."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Floats = NDArray[np.float64]

REPLICATES = 2000
SEED = 20240229


def summarise(
    times: pd.DataFrame, by: list[str], value: str = "steps_seconds", level: float = 0.95
) -> pd.DataFrame:
    """Return per group of `by`: `median`, `low`, `high` of `value`, and how many sessions, processes,
    samples.

    The median is that of the processes' medians. The interval is the percentile interval of a hierarchical
    bootstrap (Davison and Hinkley, "Bootstrap Methods and their Application", 1997, section 3.8): sessions
    are drawn with replacement, then processes within each, then repetitions within each. With a single
    process there is nothing to resample above the repetitions and the interval covers those alone.
    """
    rows = []
    for key, group in times.groupby(by, sort=True):
        padded = _padded(group, value)
        medians = _row_medians(padded.reshape(-1, padded.shape[2]))
        low, high = np.quantile(_replicates(padded), [(1 - level) / 2, (1 + level) / 2])
        rows.append(
            {
                **dict(zip(by, key, strict=True)),
                "median": float(_row_medians(medians[np.newaxis])[0]),
                "low": float(low),
                "high": float(high),
                "sessions": padded.shape[0],
                "processes": group["file"].nunique(),
                "samples": len(group),
            }
        )
    return pd.DataFrame(rows, columns=[*by, "median", "low", "high", "sessions", "processes", "samples"])


def _padded(group: pd.DataFrame, value: str) -> Floats:
    """Arrange the samples as sessions x processes x repetitions, NaN where a row is shorter than the
    longest.
    """
    session = pd.factorize(group["session"])[0]
    process = group.groupby("session")["file"].transform(lambda files: pd.factorize(files)[0]).to_numpy()
    repetition = group.groupby(["session", "file"]).cumcount().to_numpy()
    padded = np.full((session.max() + 1, process.max() + 1, repetition.max() + 1), np.nan)
    padded[session, process, repetition] = group[value].to_numpy(dtype=float)
    return padded


def _replicates(padded: Floats) -> Floats:
    """Return the statistic of each bootstrap replicate; the seed is fixed, so the same data give the same
    interval.
    """
    generator = np.random.default_rng(SEED)
    counts = (~np.isnan(padded)).sum(axis=2)
    processes = (counts > 0).sum(axis=1)
    sessions, most_processes, most_repetitions = padded.shape
    session = generator.integers(sessions, size=(REPLICATES, sessions, 1))
    position = np.arange(most_processes)
    process = (generator.random((REPLICATES, sessions, most_processes)) * processes[session]).astype(int)
    count = counts[session, process]
    drawn = (generator.random((*process.shape, most_repetitions)) * count[..., None]).astype(int)
    samples = padded[session[..., None], process[..., None], drawn]
    samples[np.arange(most_repetitions) >= count[..., None]] = np.nan
    medians = _row_medians(samples.reshape(-1, most_repetitions)).reshape(process.shape)
    medians[position >= processes[session]] = np.nan
    return _row_medians(medians.reshape(REPLICATES, -1))


def _row_medians(rows: Floats) -> Floats:
    """Return the median of each row without its NaN; NaN for a row of nothing else. Faster than
    np.nanmedian.
    """
    ordered = np.sort(rows, axis=1)
    count = (~np.isnan(ordered)).sum(axis=1)
    index = np.arange(len(ordered))
    lower, upper = np.maximum((count - 1) // 2, 0), np.minimum(count // 2, ordered.shape[1] - 1)
    medians: Floats = (ordered[index, lower] + ordered[index, upper]) / 2
    return medians
