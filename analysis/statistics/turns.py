"""What turns and stops cost, and what hardly minds a burst.

A contender that comes back to cold caches at each of its turns loses time (`excess`, `bias`). A program that
is stopped now and then finds its caches filled by others, and programs of large data mind that more than
those of small data. So blocks have slices of two lengths, and the ratio is taken to grow in proportion to the
number of stops: the line through both lengths is followed to none (`unstopped`).
"""

from collections.abc import Sequence

import numpy as np

from analysis.support.values import Floats

BEND = 1.5
"""Robust standard deviations beyond which a value counts no more than one at that distance."""

_OF_NORMAL = 1.4826
"""Standard deviations of a normal distribution in its median absolute deviation."""
_CLOSE, _MOST_STEPS = 1e-6, 50


def spread(values: Floats) -> float:
    """Return the robust standard deviation of the values, by the median distance from their median."""
    return _OF_NORMAL * float(np.median(np.abs(values - np.median(values))))


def location(values: Floats) -> float:
    """Return Huber's location of the values: their mean, but that one further from it than 1.5 robust
    standard deviations counts no more than one at that distance (Ann. Math. Stat. 35, 1964).
    """
    found = float(np.median(values))
    reach = BEND * spread(values)
    for _ in range(_MOST_STEPS if reach > 0 else 0):
        step = float(np.clip(values - found, -reach, reach).mean())
        found += step
        if abs(step) < _CLOSE * reach:
            break
    return found


def excess(
    seconds: Sequence[float], returning: Sequence[float | None], steps: Sequence[int], rounds: int
) -> float:
    """Return the share of the time of its runs that the turns of one contender in one process lose, as the
    first step of each is longer than its neighbours; NaN where it cannot be told.

    `seconds` and `steps` of the turns, run by run, each run of so many `rounds`; `returning`, the seconds of
    the first step of each turn, None where a turn is one step. A first step lies between the other steps of
    its turn and those of the turn before; it is compared with the line through the two, so that work that
    grows or shrinks over a run does not look like cold caches. First turns of a run have no turn before.
    Steps of unlike work do look like it, the other way round where turns begin half a turn later.
    """
    turns = np.asarray(seconds, dtype=float).reshape(-1, rounds)
    firsts = np.asarray(returning, dtype=float).reshape(-1, rounds)
    counts = np.asarray(steps, dtype=float).reshape(-1, rounds)
    rest = (turns - firsts) / np.where(counts > 1, counts - 1, np.nan)
    before, after = counts[:, :-1], counts[:, 1:]
    line = (rest[:, :-1] * after + rest[:, 1:] * before) / (before + after)
    lost = (firsts[:, 1:] - line)[~np.isnan(firsts[:, 1:] - line)]
    return float(lost.mean() * turns.size / turns.sum()) if lost.size else float("nan")


def bias(reference: float, candidate: float) -> float:
    """Return by how much turns make ln(candidate / reference) of a block greater, of the shares that either
    loses; NaN where one is not known.
    """
    if not max(reference, candidate) < 1:
        return float("nan")
    return float(np.log1p(-reference) - np.log1p(-candidate))


_LEAST = 2.0
"""So many times as many stops in blocks of short slices, or they tell too little of what a stop costs."""


def unstopped(log_ratios: Floats, stops: Floats) -> tuple[Floats, float]:
    """Return the log ratios less what the stops of their blocks cost, and the factor by which the error of
    their centre is greater because that cost was estimated from them; 1 where nothing can be told of it.

    The factor is that of the intercept of a straight line, of values that vary alike.
    """
    often = stops > np.sqrt(stops.min() * stops.max())
    if not often.any() or stops[often].mean() < _LEAST * stops[~often].mean():
        return log_ratios, 1.0
    between = float(stops[often].mean() - stops[~often].mean())
    cost = (location(log_ratios[often]) - location(log_ratios[~often])) / between
    share = often.mean()
    spread = share * (1 - share) * between**2
    return log_ratios - cost * stops, float(np.sqrt(1 + stops.mean() ** 2 / spread))
