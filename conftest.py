"""Tests of several processes at once: none waits for the measurements of another's."""

import os
import tempfile
from pathlib import Path

import pytest


def pytest_configure() -> None:
    """Give each process of pytest-xdist a folder of its own for what a host has once, the lock."""
    worker = os.environ.get("PYTEST_XDIST_WORKER")
    if worker is not None:
        folder = Path(tempfile.gettempdir()) / f"carom-tests-{os.getuid()}-{worker}"
        folder.mkdir(exist_ok=True)
        os.environ["TMPDIR"] = tempfile.tempdir = str(folder)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Keep the tests of a file in one process, and those of all files that read the whole report, which takes
    the longest to make.
    """
    for item in items:
        shared = "page" in getattr(item, "fixturenames", ())
        item.add_marker(pytest.mark.xdist_group("report" if shared else str(item.path)))
