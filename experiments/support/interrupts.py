"""Signals that ask a verb to stop become an exception, so that what it has is kept and told."""

import signal
from types import FrameType

from experiments.support.descendants import hear_of_ends
from support.errors import Interrupted

# Slurm sends SIGUSR1 ahead of a task's time limit.
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGUSR1)


def stop_at_signals() -> None:
    """Raise `Interrupted` at each of these signals, but for one that is ignored: `nohup` relies on that."""
    hear_of_ends()
    for number in _SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)


def _interrupt(number: int, frame: FrameType | None) -> None:
    del frame
    raise Interrupted(number)
