"""How much of the machine other programs took while the commands ran."""

import contextlib
import os
import resource
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_STAT = Path("/proc/stat")
_IDLE = (3, 4)
"""Of the numbers of a processor there, those of a time with nothing to do, or of waiting for disks."""
_TOLD = 8
"""How many of them there are before the guests' times, which the first two hold already."""

_LEAST = 0.05
"""The share of the processors below which others are not worth a word."""
_ROOM = 0.5
"""With so many processors idle on average, the others had room beside the commands."""


@dataclass
class Others:
    """Adds up what happened on the processors that may be used, while somebody was `watching`."""

    seconds: float = 0.0
    ticks: float = 0.0
    """Of all processors together, of the kernel's clock; `idle` of them with nothing to do."""
    idle: float = 0.0
    own: float = 0.0
    """Processor seconds of this process, and of what it started and waited for."""

    @contextlib.contextmanager
    def watching(self) -> Iterator[None]:
        """Count what happens inside."""
        began, (ticks, idle), own = time.monotonic(), _ticks(), _own_seconds()
        try:
            yield
        finally:
            all_ticks, all_idle = _ticks()
            self.seconds += time.monotonic() - began
            self.own += _own_seconds() - own
            self.ticks += all_ticks - ticks
            self.idle += all_idle - idle

    @property
    def idle_processors(self) -> float:
        """How many had nothing to do on average, as far as the system tells."""
        return _processors() * self.idle / self.ticks if self.ticks > 0 else 0.0

    def busy(self) -> float | None:
        """How many processors others kept busy on average, the host of a virtual machine among them; None
        where the system does not tell. What a command has a daemon do, as `docker run` does, is of others.
        """
        if self.ticks <= 0:
            return None
        busy = _processors() * (1 - self.idle / self.ticks)
        return max(0.0, busy - self.own / self.seconds)

    @property
    def are_in_the_way(self) -> bool:
        """Whether they took so much that commands had to wait for a processor."""
        return (self.busy() or 0.0) >= _LEAST * _processors() and self.idle_processors <= _ROOM

    def remark(self) -> str | None:
        """What is to be said of them, if they were in the way of the commands."""
        took = f"other programs took {self.busy() or 0.0:.1f} of its {_processors()} processors meanwhile"
        return f"the machine was busy: {took}" if self.are_in_the_way else None


def _processors() -> int:
    return len(os.sched_getaffinity(0))


def _ticks() -> tuple[float, float]:
    """All ticks and the idle ones since the machine started, on the usable processors (proc_stat(5))."""
    usable = {f"cpu{number}" for number in os.sched_getaffinity(0)}
    ticks = idle = 0.0
    with contextlib.suppress(OSError):
        for line in _STAT.read_text(encoding="ascii").splitlines():
            name, *numbers = line.split()
            if name in usable:
                times = [float(one) for one in numbers[:_TOLD]]
                ticks += sum(times)
                idle += sum(times[at] for at in _IDLE)
    return ticks, idle


def _own_seconds() -> float:
    both = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in both)
