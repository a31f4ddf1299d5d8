"""Several processes of tests at once: none waits for another's measurements, and what they fork is loaded."""

import os

import analysis.cli
import analysis.commands.programs_compared  # noqa: F401


def pytest_configure() -> None:
    """Give each process that tests a lock of its own, in the place of the one that a host has."""
    os.environ["CAROM_LOCK"] = str(os.getpid())
