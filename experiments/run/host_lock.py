"""One program that computes at a time on one host: two at once would disturb each other's measurements."""

import contextlib
import fcntl
import os
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.site import clean_environment
from experiments.run.progress import warn
from experiments.support import process
from experiments.support.process import Completed
from support.errors import InputError


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
    """Wait until no other runner of this user measures on this host, and keep others waiting meanwhile.

    Runners of other results folders count, and so do tasks of a cluster whose nodes are one host. The kernel
    lets go of it with its process, however that ends. Raises InputError where the lock cannot be made.
    """
    path = Path(tempfile.gettempdir()) / f"carom-{os.getuid()}.lock"
    try:
        lock = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
    except OSError as error:
        raise InputError(
            f"{path}: cannot be opened: {error.strerror}; TMPDIR chooses another folder"
        ) from error
    try:
        WAITS.until_free(lock)
        os.truncate(lock, 0)
        os.pwrite(lock, f"{os.getpid()}".encode(), 0)
        yield
    finally:
        os.close(lock)


@dataclass
class Waits:
    """How long this process waited for other measurements, in seconds; it is said once."""

    seconds: float = 0.0
    is_said: bool = False

    def until_free(self, lock: int) -> None:
        """Wait for the lock, and say so the first time."""
        with contextlib.suppress(BlockingIOError):
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        if not self.is_said:
            holder = os.pread(lock, 20, 0).decode("ascii", "replace") or "not known"
            warn(f"carom: waits for another measurement (process {holder})")
            self.is_said = True
        began = time.monotonic()
        fcntl.flock(lock, fcntl.LOCK_EX)
        self.seconds += time.monotonic() - began


WAITS = Waits()
