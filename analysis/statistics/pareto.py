"""Which choices no other choice beats in both of two costs."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


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
