"""The types of what is worked out: arrays, rows, estimates with an interval, and tables for the report. Rows
of a TOML file are read here, too.
"""

import tomllib
from collections.abc import Callable, Hashable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Row = Mapping[Hashable, Any]
Table = tuple[str, Mapping[str, Any]]
"""A table of the report: which one it is, and the facts that it tells."""
T = TypeVar("T")


class Interval(NamedTuple):
    """An estimate with its interval; infinite ends where too few samples allow none."""

    estimate: float
    low: float
    high: float


def rows_in(file: Path, key: str, kind: Callable[..., T]) -> list[T]:
    """Return the tables under a key of a TOML file, each as what it is made into."""
    return [kind(**table) for table in tomllib.loads(file.read_text(encoding="utf-8"))[key]]
