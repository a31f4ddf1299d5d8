"""One program that computes at a time on one host: two at once would disturb each other's measurements."""

import contextlib
import errno
import os
import socket
import struct
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.site import clean_environment
from experiments.run.progress import warn
from experiments.support import process
from experiments.support.process import Completed
from support.errors import InputError

_AGAIN = 0.001
"""Seconds until it is tried again to begin, where somebody else was about to, or has just ended."""


def run_alone(
    command: Sequence[str],
    openmp: Iterable[tuple[str, str]],
    time_limit: float,
    folder: Path | None = None,
) -> Completed:
    """Run a program to its end with these OpenMP variables and no others, in a folder or where this process
    is, while no other one computes.

    The time limit, in seconds, counts from when it begins. Raises InputError like `host_lock`.
    """
    with host_lock():
        return process.run(command, clean_environment(dict(openmp)), time_limit, folder)


@contextlib.contextmanager
def host_lock() -> Iterator[None]:
    """Wait until no other runner measures on this host, and keep others waiting meanwhile.

    Runners of other users and results folders count, and so do tasks of a cluster whose nodes are one host.
    The lock is the name of a socket, without a file: the kernel lets go of it with its process, however that
    ends. A container with a network of its own has one of its own. Raises InputError within what another
    runner measures.
    """
    with WAITS.bound(f"\0carom {os.environ.get('CAROM_LOCK', '')}"):
        yield


@dataclass
class Waits:
    """How long this process waited for other measurements, in seconds; it is said once."""

    seconds: float = 0.0
    is_said: bool = False
    is_waiting: bool = False

    def bound(self, name: str) -> socket.socket:
        """The socket of that name, once nobody else has it."""
        lock = socket.socket(socket.AF_UNIX)
        while True:
            try:
                lock.bind(name)
                lock.listen()
                return lock
            except OSError as error:
                if error.errno != errno.EADDRINUSE:
                    raise
                self._wait(name)

    def _wait(self, name: str) -> None:
        """Wait for the end of whoever has the name, and say so the first time."""
        began = time.monotonic()
        with socket.socket(socket.AF_UNIX) as line, contextlib.suppress(ConnectionError):
            line.connect(name)
            holder = struct.unpack("3i", line.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12))[0]
            if holder in _ancestors():
                told = "and each would wait for the other: measure either by itself"
                raise InputError(f"runs within another measurement (process {holder}), {told}")
            if not self.is_said:
                warn(f"carom: waits for another measurement (process {holder or 'not known'})")
                self.is_said = True
            self.is_waiting = True
            try:
                line.recv(1)
            finally:  # a signal may end it
                self.is_waiting = False
                self.seconds += time.monotonic() - began
        time.sleep(_AGAIN)


def _ancestors() -> Iterator[int]:
    """This process, the one that started it, and so on."""
    number = os.getpid()
    while number > 0:
        yield number
        try:
            number = int(Path(f"/proc/{number}/stat").read_bytes().rpartition(b")")[2].split()[1])
        except OSError:
            return


WAITS = Waits()
