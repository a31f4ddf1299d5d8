"""How numbers are said: one way for captions, claims, the report and the terminal."""

import math
from collections.abc import Iterable
from typing import Any

from analysis.support.values import Interval

NO_BREAK = "\u00a0"
NO_INTERVAL = "(too few blocks for an interval)"


def number(value: float, digits: int = 3) -> str:
    """Return the value with so many significant digits and no exponent, thousands grouped."""
    if not math.isfinite(value):
        return "∞" if value > 0 else "−∞" if value < 0 else "unknown"
    if value == 0:
        return "0"
    rounded = float(f"{abs(value):.{digits - 1}e}")  # 0.9999 becomes 1.00, not 1.000
    decimals = max(0, digits - 1 - math.floor(math.log10(rounded)))
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


def interval(value: Interval) -> str:
    """Return an estimate with its 95 % interval, if it has one, e.g. `0.98 [0.95, 1.01]`."""
    estimate, low, high = (number(end) for end in value)
    return f"{estimate} [{low}, {high}]" if math.isfinite(value.high) else f"{estimate} {NO_INTERVAL}"


def interval_of(row: Any, value: str = "median") -> str:  # noqa: ANN401 - a row of a table, or a ratio
    """Return what a row has as `value`, `low`, `high` as an estimate with its interval."""
    return interval(Interval(getattr(row, value), row.low, row.high))


def scene_in_words(particles: float, area_fraction: float) -> str:
    """Return what tells a scene from the others: discs and area fraction."""
    return f"{exact(particles)} discs at area fraction {area_fraction:.2f}"


def change(row: Any) -> str:  # noqa: ANN401 - as above
    """Return a ratio as a change with its interval, e.g. `−4.6 % [−5.1 %, −4.0 %]`."""
    if not math.isfinite(row.high):
        return f"{percent(row.ratio - 1)} {NO_INTERVAL}"
    return f"{percent(row.ratio - 1)} [{percent(row.low - 1)}, {percent(row.high - 1)}]"


def in_all(row: Any) -> str:  # noqa: ANN401 - as above
    """Return by how much all time together differs; an en dash where that is not known."""
    return percent(row.totals - 1) if math.isfinite(row.totals) else "–"


def spreads(row: Any) -> str:  # noqa: ANN401 - as above
    """Return by how much one start differs from the next, and one round."""
    return f"{share(row.start, 1)}, {share(row.round, 1)}" if math.isfinite(row.round) else "–"


def blocks(row: Any) -> str:  # noqa: ANN401 - as above
    """Return on how many pairs of processes a ratio rests."""
    return count(row.blocks, "block")


def count(amount: int, noun: str) -> str:
    """Return the amount with its noun, in the plural where it is one."""
    plural = f"{noun}es" if noun.endswith("s") else f"{noun}s"
    return f"{exact(amount)}{NO_BREAK}{noun if amount == 1 else plural}"
