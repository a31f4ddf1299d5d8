"""The types of what is worked out: arrays, rows, estimates with an interval, and tables for the report. Rows
of a TOML file are read here, too.
"""

import tomllib
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Row = Mapping[Hashable, Any]
T = TypeVar("T")


class Interval(NamedTuple):
    """An estimate with its interval; infinite ends where too few samples allow none."""

    estimate: float
    low: float
    high: float


@dataclass(frozen=True)
class Cell:
    """What stands in one place of a table; `mark` is its class in the style sheet: holds, fails, open."""

    text: str
    mark: str = ""


@dataclass(frozen=True)
class Table:
    """A table of the report: what it says, its columns, and a row of cells each."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Cell]]


def rows_in(file: Path, key: str, kind: Callable[..., T]) -> list[T]:
    """Return the tables under a key of a TOML file, each as what it is made into."""
    return [kind(**table) for table in tomllib.loads(file.read_text(encoding="utf-8"))[key]]


def table_of(title: str, columns: Sequence[str], rows: Iterable[Iterable[Cell | str]]) -> Table:
    """Return a table of cells and of texts, which have no mark."""
    return Table(
        title, columns, [[Cell(one) if isinstance(one, str) else one for one in row] for row in rows]
    )
