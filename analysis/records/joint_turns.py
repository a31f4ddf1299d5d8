"""Of many contenders that took turns in one process, one value each instead of their rounds."""

from functools import cache

import numpy as np
import pandas as pd

from analysis.statistics.neighbours import FEWEST, contender_logs
from analysis.statistics.pairs import rounds_of
from analysis.statistics.turns import location

PLACES = "places"
"""The column of where each turn stood among those of all contenders of its process."""

_ROUNDS = rounds_of("steps_seconds")
_PROCESS = ["experiment", "session", "node", "block", "binary_sha256", "scene", "threads"]


def joined(times: pd.DataFrame) -> pd.DataFrame:
    """Return the times with one turn instead of all of them, where `FEWEST` contenders or more took turns and
    all of them are there: what `contender_logs` makes of the process.
    """
    many = times[times[PLACES].map(len) >= 1]
    rounds = dict(times[_ROUNDS])
    for _, process in many.groupby(_PROCESS, dropna=False, sort=False):
        count = len(process)
        if count < FEWEST or process[PLACES].map(len).nunique() > 1:
            continue
        places = np.stack(list(process[PLACES]))
        if (np.sort(places, axis=None) != np.arange(places.size)).any():
            continue
        logs = _logs(np.log(np.stack(list(process[_ROUNDS]))).tobytes(), places.tobytes(), count)
        rounds.update({row: np.array([np.exp(log)]) for row, log in zip(process.index, logs, strict=True)})
    return times.assign(**{_ROUNDS: pd.Series(rounds, dtype=object)}).drop(columns=PLACES)


@cache
def _logs(logs: bytes, places: bytes, count: int) -> tuple[float, ...]:
    """Return the logarithm of each contender's turn. A study that grows is looked at again and again."""
    turns = np.frombuffer(logs).reshape(count, -1)
    order = np.argsort(np.frombuffer(places, dtype=np.int64).reshape(count, -1), axis=None)
    whose = (order // turns.shape[1]).reshape(turns.shape[1], count)
    return tuple((location(turns.mean(axis=0)) + contender_logs(turns, whose)).tolist())
