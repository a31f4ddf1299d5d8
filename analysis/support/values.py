"""The types of what is worked out: arrays, rows, estimates with an interval, and tables for the report."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Row = Mapping[Hashable, Any]


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


def table_of(title: str, columns: Sequence[str], rows: Iterable[Iterable[Cell | str]]) -> Table:
    """Return a table of cells and of texts, which have no mark."""
    return Table(
        title, columns, [[Cell(one) if isinstance(one, str) else one for one in row] for row in rows]
    )
