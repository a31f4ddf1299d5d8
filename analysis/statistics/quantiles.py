"""Quantiles and chances of the usual distributions, to the same bits as those of `scipy.stats`, which takes
half a second to load.
"""

from typing import Any

from numpy.typing import ArrayLike
from scipy import special


def student(chance: ArrayLike, freedom: ArrayLike) -> Any:  # noqa: ANN401 - a number, of arrays an array
    """Return what Student's t with so many degrees of freedom stays below with that chance."""
    return special.stdtrit(freedom, chance)


def student_beyond(value: float, freedom: int) -> float:
    """Return the chance that Student's t is above a value."""
    return float(special.stdtr(freedom, -value))


def normal(chance: ArrayLike) -> Any:  # noqa: ANN401 - as above
    """Return what a standard normal value stays below with that chance."""
    return special.ndtri(chance)


def normal_below(value: ArrayLike) -> Any:  # noqa: ANN401 - as above
    """Return the chance that a standard normal value is below one."""
    return special.ndtr(value)


def chi_squared(chance: ArrayLike, freedom: int) -> Any:  # noqa: ANN401 - as above
    """Return what a chi-squared value with so many degrees of freedom stays below with that chance."""
    return 2 * special.gammaincinv(freedom / 2, chance)
