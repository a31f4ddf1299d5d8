"""What the fuzzers of readers share: a file that holds some bytes, and a test that goes on for a while."""

import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from hypothesis import HealthCheck, settings

ROUND = 1000


@contextmanager
def in_a_file(content: bytes) -> Iterator[Path]:
    """Give a file that holds the bytes; hypothesis cannot share pytest's folders between its examples."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "file")
        path.write_bytes(content)
        yield path


def for_a_while(test: Callable[[], None]) -> None:
    """Run a test made by `given` again and again for CAROM_FUZZ_SECONDS, or 60, and print how often.

    Each round begins at another place: hypothesis draws its seed anew.
    """
    seconds = float(os.environ.get("CAROM_FUZZ_SECONDS", "60"))
    until = time.monotonic() + seconds
    rounds = 0
    checks = [HealthCheck.too_slow, HealthCheck.data_too_large]
    once = settings(max_examples=ROUND, database=None, deadline=None, suppress_health_check=checks)(test)
    while rounds == 0 or time.monotonic() < until:
        once()
        rounds += 1
    print(f"{rounds * ROUND} inputs in {seconds:g} s")
