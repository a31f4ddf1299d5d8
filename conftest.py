"""Tests of several processes at once: none waits for the measurements of another's."""

import os


def pytest_configure() -> None:
    """Give each process that tests a lock of its own, in the place of the one that a host has."""
    os.environ["CAROM_LOCK"] = str(os.getpid())
