"""How numbers are said: one way for captions, claims, the report and the terminal."""

import math
from collections.abc import Hashable, Iterable, Mapping
from typing import Any, Protocol

import pandas as pd

NO_BREAK = "\u00a0"
NO_INTERVAL = "(too few blocks for an interval)"


class Estimated(Protocol):
    """An estimate between two ends, as `statistics.intervals.Interval` is."""

    @property
    def estimate(self) -> float:
        """The middle."""

    @property
    def low(self) -> float:
        """The lower end."""

    @property
    def high(self) -> float:
        """The upper end."""


def number(value: float, digits: int = 3) -> str:
    """Return the value with so many significant digits and no exponent, thousands grouped."""
    if not math.isfinite(value):
        return "∞" if value > 0 else "−∞" if value < 0 else "unknown"
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    text = f"{abs(value):,.{decimals}f}".replace(",", NO_BREAK)
    return f"−{text}" if value < 0 else text


def exact(value: float) -> str:
    """Return a given value (a swept parameter) as it is, thousands grouped, without trailing zeros."""
    return f"{value:,.10g}".replace(",", NO_BREAK)


def percent(fraction: float, digits: int = 1) -> str:
    """Return a fraction as a signed percentage, e.g. `+4.6 %`."""
    if not math.isfinite(fraction):
        return number(fraction)
    return f"{fraction * 100:+.{digits}f}{NO_BREAK}%".replace("-", "−")


def factor(ratio: float) -> str:
    """Return a ratio as a factor, e.g. `×5.67`; an en dash for one that is not known."""
    return f"×{number(ratio)}" if math.isfinite(ratio) else "–"


def listed(values: Iterable[float | str], between: str = ", ") -> str:
    """Return values side by side, numbers as they are."""
    return between.join(value if isinstance(value, str) else exact(value) for value in values)


def share(fraction: float, digits: int = 0) -> str:
    """Return a fraction as a percentage without sign, e.g. `55 %`."""
    return f"{fraction * 100:.{digits}f}{NO_BREAK}%"


def interval(value: Estimated, digits: int = 3) -> str:
    """Return an estimate with its 95 % interval, if it has one, e.g. `0.98 [0.95, 1.01]`."""
    return _between(value.estimate, value.low, value.high, digits)


def interval_of(row: Mapping[Hashable, Any] | pd.Series, value: str = "median") -> str:
    """Return the columns `value`, `low`, `high` of a row as an estimate with its interval."""
    return _between(row[value], row["low"], row["high"], 3)


def _between(estimate: float, low: float, high: float, digits: int) -> str:
    if not math.isfinite(high):
        return f"{number(estimate, digits)} {NO_INTERVAL}"
    return f"{number(estimate, digits)} [{number(low, digits)}, {number(high, digits)}]"


def scene_in_words(particles: float, area_fraction: float) -> str:
    """Return what tells a scene from the others: discs and area fraction."""
    return f"{exact(particles)} discs at area fraction {area_fraction:.2f}"


def change(row: Mapping[str, Any]) -> str:
    """Return a row of `verdicts.judge` as a change with its 95 % interval, e.g. `−4.6 % [−5.1 %, −4.0 %]`,
    if it has one.
    """
    if not math.isfinite(row["high"]):
        return f"{percent(row['ratio'] - 1)} {NO_INTERVAL}"
    low, high = (percent(row[end] - 1) for end in ("low", "high"))
    return f"{percent(row['ratio'] - 1)} [{low}, {high}]"


def blocks(row: Mapping[str, Any]) -> str:
    """Return on how many pairs of processes a row rests."""
    return count(row["blocks"], "block")


def count(amount: int, noun: str) -> str:
    """Return the amount with its noun, in the plural where it is one."""
    plural = f"{noun}es" if noun.endswith("s") else f"{noun}s"
    return f"{exact(amount)}{NO_BREAK}{noun if amount == 1 else plural}"
