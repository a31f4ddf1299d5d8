"""Where the other parts of Carom are: its programs, and the package that analyses."""

import sys

from support.home import ROOT

BUILDS = ROOT / "build"
"""The folder of its programs, one folder a compiler."""


def analysis(*words: str) -> list[str]:
    """The command that starts the analysis package, whatever stands in the working folder, and as far from
    the user's own Python settings as this process.
    """
    return [sys.executable, "-I" if sys.flags.isolated else "-P", "-m", "analysis", *words]
