"""What each contender takes of many that took turns: each turn is compared with those just before it.

A round of twenty contenders takes a second, and the machine's speed changes within fifty milliseconds. Two
turns of one round have then hardly more in common than two of different rounds, but neighbours have. So the
logarithms of all turns of a process are fitted together, as a contender's own value, what its round has in
common (all of them do the same steps in it), and noise that is a first-order autoregression in time. By
generalised least squares (Prais and Winsten, Cowles Commission Discussion Paper 383, 1954), bent as Huber
does (Ann. Math. Stat. 35, 1964), so that bursts spoil little.
"""

import numpy as np

from analysis.statistics.turns import BEND, spread
from analysis.support.values import Floats

Order = np.ndarray[tuple[int, int], np.dtype[np.int64]]
"""Rounds x contenders: whose turn was when."""

FEWEST = 5
"""Contenders from which this is better than rounds; the turns of few are close together in a round."""

CORRELATIONS = (0.0, 0.4, 0.8)
"""Of the noise of a turn with that of the next; a process has the one that makes its turns likeliest. A wrong
one costs width alone, since intervals come of the differences between processes."""

_FITS = 8
"""Of weights; four change nothing that matters."""


def contender_logs(logs: Floats, order: Order) -> Floats:
    """Return the logarithm of each contender's time, about 0 on average over the contenders, given those of
    its turns, contenders x rounds.
    """
    fits = [_fit(logs, order, correlation) for correlation in CORRELATIONS]
    return min(fits, key=lambda fit: fit[0])[1]


def _fit(logs: Floats, order: Order, correlation: float) -> tuple[float, Floats]:
    """Return how unlikely the turns are with that correlation, and the contenders' logarithms."""
    rounds, count = order.shape
    first = np.sqrt(1 - correlation**2)
    who = np.zeros((rounds, count, count))
    np.put_along_axis(who, order[:, :, None], 1.0, axis=2)
    turns = logs.T[np.arange(rounds)[:, None], order]
    both = np.concatenate([who, turns[:, :, None]], axis=2)
    # Innovations: a round begins anew, and what it has in common is less in all turns but its first.
    both[:, 1:] -= correlation * both[:, :-1]
    both[:, 0] *= first
    common = np.full(count, 1 - correlation)
    common[0] = first
    weights, found, reach = np.ones((rounds, count)), np.zeros(count), 0.0
    for _ in range(_FITS):
        shared = weights * common
        means = np.einsum("rt,rtc->rc", shared, both) / (shared @ common)[:, None]
        flat = (both - common[:, None] * means[:, None, :]).reshape(-1, count + 1)
        scaled = (flat[:, :-1] * weights.reshape(-1, 1)).T
        # What all contenders have in common is the rounds': the shortest solution is about 0.
        found = np.linalg.lstsq(scaled @ flat[:, :-1], scaled @ flat[:, -1], rcond=1e-9)[0]
        left = (flat[:, -1] - flat[:, :-1] @ found).reshape(rounds, count)
        reach = BEND * spread(left)
        if reach == 0:
            break
        weights = np.minimum(1.0, reach / np.maximum(np.abs(left), 1e-300))
    unlikely = turns.size * np.log(max(reach, 1e-300)) - rounds * np.log(first)
    return float(unlikely), found - found.mean()
