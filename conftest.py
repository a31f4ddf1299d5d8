"""Tests of several processes at once: none waits for the measurements of another's."""

import os
import tempfile
from pathlib import Path


def pytest_configure() -> None:
    """Give each process of pytest-xdist a folder of its own for what a host has once, the lock."""
    worker = os.environ.get("PYTEST_XDIST_WORKER")
    if worker is not None:
        folder = Path(tempfile.gettempdir()) / f"carom-tests-{os.getuid()}-{worker}"
        folder.mkdir(exist_ok=True)
        os.environ["TMPDIR"] = tempfile.tempdir = str(folder)
