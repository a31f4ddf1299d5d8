"""Where Carom itself is: a checkout, or the folder that it is installed in."""

from pathlib import Path

ROOT = Path(__file__).parents[1]

BUILDS = ROOT / "build"
"""The folder of Carom's programs, one folder a compiler."""
