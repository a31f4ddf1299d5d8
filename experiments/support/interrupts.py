"""Signals that ask a verb to stop become an exception, so that what it has is kept and told."""

import contextlib
import os
import signal
from collections.abc import Iterator
from types import FrameType

from experiments.support.descendants import hear_of_ends
from support.errors import Interrupted

# Slurm sends SIGUSR1 or SIGUSR2 ahead of a task's time limit, the kernel SIGXCPU at that of `ulimit -t`.
_SIGNALS = (
    signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2,
    signal.SIGXCPU, signal.SIGALRM,
)  # fmt: skip


_asked: list[int] = []
"""The signals that came."""


def stop_at_signals() -> None:
    """Raise `Interrupted` at each of these signals, but for one that is ignored: `nohup` relies on that. One
    that came before, and which the program held back, is the end at once: nothing has begun.
    """
    hear_of_ends()
    heard = {number for number in _SIGNALS if signal.getsignal(number) is not signal.SIG_IGN}
    for number in heard:
        signal.signal(number, _interrupt)
    if early := heard & signal.sigpending():
        os._exit(128 + min(early))
    signal.pthread_sigmask(signal.SIG_SETMASK, ())


@contextlib.contextmanager
def signals_held() -> Iterator[None]:
    """Let those that come inside be heard behind it: what is loaded by halves cannot be loaded again."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def stop_if_asked() -> None:
    """Raise again what nobody has heard: Python ignores what a signal raises while it forks."""
    if _asked:
        raise Interrupted(_asked[-1])


def _interrupt(number: int, frame: FrameType | None) -> None:
    del frame
    _asked.append(number)
    raise Interrupted(number)
