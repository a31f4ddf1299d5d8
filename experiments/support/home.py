"""Where Carom itself is: a checkout, or the folder that it is installed in."""

import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]

BUILDS = ROOT / "build"
"""The folder of its programs, one folder a compiler."""


def analysis(*words: str) -> list[str]:
    """The command that starts the analysis package, whatever stands in the working folder."""
    return [sys.executable, "-P", "-m", "analysis", *words]
