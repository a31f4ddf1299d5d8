"""Tables that grow by a record at a time and cost a few bytes a cell, whatever stands in it.

A column holds each of its values once, and for each row the number of its value: of a hundred thousand
records nearly all have the same processor, scene and compiler.
"""

import math
from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Integers = NDArray[np.intp]
Booleans = NDArray[np.bool_]
Packed = dict[str, Any]
"""What JSON and arrays of numbers can hold: each value of a column, and the rows' numbers."""

_NOT_IN_JSON = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}


@dataclass(slots=True)
class Column:
    """The values of a column."""

    values: list[Any] = field(default_factory=list)
    """Each once, in the order in which they came."""
    rows: "array[int]" = field(default_factory=lambda: array("i"))
    """Of each row the place of its value."""
    _places: dict[tuple[type, Any], int] = field(default_factory=dict)

    def place(self, value: Any) -> int:  # noqa: ANN401 - a cell is any value
        """Return the place of a value; 1, 1.0 and True are three."""
        key = (type(value), value)
        found = self._places.get(key)
        if found is None:
            found = self._places[key] = len(self.values)
            self.values.append(value)
        return found

    def at(self, rows: Integers) -> pd.Series:
        """Return these rows, typed as pandas types a column of these values and no others."""
        places = np.frombuffer(self.rows, dtype=np.intc)[rows]
        used = np.flatnonzero(np.bincount(places, minlength=len(self.values)))
        new_place = np.zeros(len(self.values), dtype=np.intp)
        new_place[used] = np.arange(len(used))
        distinct = pd.DataFrame([{"value": self.values[place]} for place in used], columns=["value"])["value"]
        return distinct.take(new_place[places]).reset_index(drop=True)

    def kept(self, rows: Integers) -> Self:
        """Return the column of these rows alone."""
        places = np.frombuffer(self.rows, dtype=np.intc)[rows]
        return type(self)(list(self.values), array("i", places.tobytes()), dict(self._places))

    def packed(self) -> Packed:
        """Return it for `unpacked`."""
        values = [
            {"float": str(value)} if isinstance(value, float) and not math.isfinite(value) else value
            for value in self.values
        ]
        rows = np.frombuffer(self.rows, dtype=np.intc).astype(np.min_scalar_type(len(values)))
        return {"values": values, "rows": rows}

    @classmethod
    def unpacked(cls, told: Packed) -> Self:
        """Return what was packed. Raises ValueError, KeyError or TypeError for anything else."""
        values = [_NOT_IN_JSON[one["float"]] if isinstance(one, dict) else one for one in told["values"]]
        rows = array("i", np.asarray(told["rows"], dtype=np.intc).tobytes())
        if len(rows) and not 0 <= min(rows) <= max(rows) < len(values):
            raise ValueError("a row has a value that is not there")
        return cls(values, rows, {(type(value), value): place for place, value in enumerate(values)})


class Rows:
    """A table with the columns named, of which a row may lack any: it is NaN there."""

    def __init__(self, names: Sequence[str]) -> None:
        self._columns = {name: Column() for name in names}
        self._length = 0

    def __len__(self) -> int:
        return self._length

    def extend(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Append rows; what has no column is left out."""
        for row in rows:
            for name, column in self._columns.items():
                value = row.get(name, math.nan)
                column.rows.append(column.place(value.item() if isinstance(value, np.generic) else value))
            self._length += 1

    def at(self, rows: Integers, names: Sequence[str]) -> dict[str, pd.Series]:
        """Return these rows of these columns."""
        return {name: self._columns[name].at(rows) for name in names}

    def column(self, name: str) -> list[Any]:
        """Return the value of each row."""
        column = self._columns[name]
        return [column.values[place] for place in column.rows]

    def keep(self, wanted: Booleans) -> None:
        """Drop all other rows."""
        rows = np.flatnonzero(wanted)
        self._columns = {name: column.kept(rows) for name, column in self._columns.items()}
        self._length = len(rows)

    def packed(self) -> dict[str, Packed]:
        """Return it for `unpacked`."""
        return {name: column.packed() for name, column in self._columns.items()}

    @classmethod
    def unpacked(cls, names: Sequence[str], told: Mapping[str, Packed]) -> Self:
        """Return what was packed. Raises ValueError, KeyError or TypeError for anything else."""
        found = cls(names)
        found._columns = {name: Column.unpacked(told[name]) for name in names}
        lengths = {len(column.rows) for column in found._columns.values()}
        [found._length] = lengths or {0}
        return found
