"""Where the other parts of Carom are: its programs, and the package that analyses."""

import sys

from support.home import ROOT

BUILDS = ROOT / "build"
"""The folder of its programs, one folder a compiler."""


def analysis(*words: str) -> list[str]:
    """The command that starts the analysis package, whatever stands in the working folder."""
    return [sys.executable, "-P", "-m", "analysis", *words]
