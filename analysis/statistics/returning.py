"""What a contender loses because it comes back to cold caches at each of its turns."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Excess:
    """By how many `seconds` the first step of a turn is longer than its neighbours, with its standard
    `error`, and the `share` of the time of the runs that all of the turns lose so.
    """

    seconds: float
    error: float
    share: float


def excess(
    seconds: Sequence[float], returning: Sequence[float | None], steps: Sequence[int], rounds: int
) -> Excess | None:
    """Return what the turns of one contender in one process lose; None where it cannot be told.

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
    if not lost.size:
        return None
    error = float(lost.std(ddof=1) / np.sqrt(lost.size)) if lost.size > 1 else float("nan")
    return Excess(float(lost.mean()), error, float(lost.mean() * turns.size / turns.sum()))


def bias(reference: float, candidate: float) -> float:
    """Return by how much turns make ln(candidate / reference) of a block greater, of the shares that either
    loses; NaN where one is not known.
    """
    if not max(reference, candidate) < 1:
        return float("nan")
    return float(np.log1p(-reference) - np.log1p(-candidate))
