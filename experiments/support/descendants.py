"""What children leave behind: processes that outlived them, and belong to this process then."""

import contextlib
import ctypes
import os
import signal
import time
from functools import cache
from pathlib import Path

_PR_SET_CHILD_SUBREAPER = 36
_PRCTL = ctypes.CDLL(None, use_errno=True).prctl

_LONGEST_SECONDS = 5.0
"""How long the end of what was killed is waited for: the kernel may keep one that reads from a dead disk."""


_KEEPER, _PATIENCE = "carom-keeper", 2.0
"""What looks after a program that is measured, and the seconds that it has to end that by itself."""


def _name(number: int) -> str:
    with contextlib.suppress(OSError):
        return Path(f"/proc/{number}/comm").read_text(encoding="ascii", errors="replace").strip()
    return ""


@cache
def adopt_orphans() -> None:
    """From now on whatever a descendant leaves behind becomes a child of this process, not of the system's
    first one, also what has a session of its own.
    """
    _PRCTL(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def hear_of_ends() -> None:
    """Let the kernel tell how children end. Whoever started this process may have told it not to (SIGCHLD
    ignored), and Python takes every end that it does not hear of for a success.
    """
    if signal.getsignal(signal.SIGCHLD) is signal.SIG_IGN:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)


def children() -> frozenset[int]:
    """The ids of this process's children; none where the kernel does not list them."""
    found: set[int] = set()
    for path in Path("/proc/self/task").glob("*/children"):
        with contextlib.suppress(OSError):
            found.update(map(int, path.read_text(encoding="ascii").split()))
    return frozenset(found)


def end_all_but(known: frozenset[int]) -> None:
    """End the children that are not among the known ones, and what they leave behind in turn."""
    began = time.monotonic()
    until = began + _LONGEST_SECONDS
    while (others := children() - known) and time.monotonic() < until:
        for number in others:
            with contextlib.suppress(ChildProcessError):
                os.waitpid(number, os.WNOHANG)
            if time.monotonic() - began < _PATIENCE and _name(number) == _KEEPER:
                continue  # it ends what it looks after, and removes its control group
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(number, signal.SIGKILL)
        time.sleep(0.001)
