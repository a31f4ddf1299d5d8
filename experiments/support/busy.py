"""Loops that keep processors busy beside what is measured."""

import contextlib
import sys
from collections.abc import Iterator

from experiments.support.process import alongside


@contextlib.contextmanager
def busy(loops: int) -> Iterator[None]:
    """Let so many loops run until the block ends; they end with this process, too, however that ends."""
    with contextlib.ExitStack() as stack:
        for _ in range(loops):
            stack.enter_context(alongside([sys.executable, "-c", "while True: pass"]))
        yield
