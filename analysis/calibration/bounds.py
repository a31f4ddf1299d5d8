"""Exact bounds of a share: Clopper and Pearson, Biometrika 26, 1934."""

from scipy import stats


def upper_bound(hits: float, tries: float, error: float = 0.05) -> float:
    """Return the share above which so few hits in independent tries have a chance below `error`, or 1."""
    if tries <= hits:
        return 1.0
    return float(stats.beta.ppf(1 - error, hits + 1, tries - hits))


def interval(hits: float, tries: float, error: float = 0.05) -> tuple[float, float]:
    """Return the two-sided exact interval of a share; between the whole numbers it goes on smoothly."""
    low = float(stats.beta.ppf(error / 2, hits, tries - hits + 1)) if hits > 0 else 0.0
    return low, upper_bound(hits, tries, error / 2)
