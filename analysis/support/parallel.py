"""Calls spread over the processors of this machine."""

import ctypes
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any, TypeVar

Result = TypeVar("Result")

_PR_SET_PDEATHSIG = 1

_function: Callable[[int], Any] | None = None


def in_parallel(function: Callable[[int], Result], count: int) -> Iterator[Result]:
    """Yield function(0), ..., function(count - 1) in this order, called in as many processes as processors.

    The processes are forks, so that the function may refer to anything; only its results are sent. What it
    raises is raised here.
    """
    processes = min(len(os.sched_getaffinity(0)), count)
    if processes < 2:
        yield from map(function, range(count))
        return
    with ProcessPoolExecutor(processes, get_context("fork"), _begin, (function,)) as pool:
        yield from pool.map(_call, range(count))


def _begin(function: Callable[[int], Any]) -> None:
    global _function
    _function = function
    # Ctrl-C reaches every process: the first tells, the others end with it, as they do if it is killed.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _call(number: int) -> Any:  # noqa: ANN401 - whatever the function returns
    assert _function is not None
    return _function(number)
