"""What comes out of a child's pipes: bounded, and waited for in steps."""

import contextlib
import os
import select
import time

KEPT_BYTES = 1 << 22
"""Of what a child prints the end is kept: far more than anything that is read, far less than memory."""
_STEP_SECONDS = 0.5
_LATE_SECONDS = 2.0
"""Who waits in steps and wakes up so much too late stood still, as after Ctrl-Z or a cluster's SUSPEND."""
READ_BYTES = 1 << 16
_READS_AFTER_THE_END = 32
"""Twice what a pipe can hold: a descendant that goes on writing must not be listened to for ever."""


class Kept:
    """The end of what a child prints, and how much came before it."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self.dropped = 0

    def add(self, part: bytes) -> None:
        """What came next."""
        self._bytes += part
        if (surplus := len(self._bytes) - KEPT_BYTES) >= KEPT_BYTES:
            del self._bytes[:surplus]
            self.dropped += surplus

    @property
    def text(self) -> str:
        """What is kept; bytes that are no UTF-8 are replaced."""
        return self._bytes.decode(errors="replace")


class Allowance:
    """Seconds that a child may take, as far as this process is there to see them."""

    def __init__(self, seconds: float | None) -> None:
        self._left = float("inf") if seconds is None else seconds
        self._seen = time.monotonic()

    @property
    def step(self) -> float:
        """How long to wait, in seconds, before it is asked again whether they are used up."""
        return max(0.0, min(_STEP_SECONDS, self._left))

    def is_used_up(self) -> bool:
        """Counts what passed since it was last asked, of a step that ended far too late only the step."""
        now = time.monotonic()
        passed, self._seen = now - self._seen, now
        self._left -= passed if passed < _STEP_SECONDS + _LATE_SECONDS else _STEP_SECONDS
        return self._left <= 0


def drain(pipe: int, kept: Kept) -> None:
    """Read what a child that has ended left in a pipe."""
    os.set_blocking(pipe, False)
    with contextlib.suppress(BlockingIOError):
        for _ in range(_READS_AFTER_THE_END):
            if not (part := os.read(pipe, READ_BYTES)):
                return
            kept.add(part)


def line(pipe: int, time_limit: float) -> str | None:
    """One line out of a pipe; what there is of it where the pipe ends; None if it takes too long."""
    allowance, parts = Allowance(time_limit), bytearray()
    while not parts.endswith(b"\n"):
        if select.select([pipe], [], [], allowance.step)[0]:
            if not (part := os.read(pipe, READ_BYTES)):
                break
            parts += part
        if allowance.is_used_up() and not parts.endswith(b"\n"):
            return None
    return parts.decode(errors="replace")
