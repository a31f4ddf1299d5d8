"""What a claim is about as numbers: ratios, each as published and as measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, isfinite, nan
from typing import Any

from analysis.statistics.verdicts import MARGIN
from analysis.support.values import Interval

EXPONENT = "exponent"
NOT_MEASURED = Interval(nan, -inf, inf)


@dataclass(frozen=True)
class Effect:
    """A ratio: of times, if `what` does not name something else.

    `here` is what was measured, with infinite ends where no interval is known and NaN without records;
    `published` is NaN where the study tells no number. Between the two ratios of `within` there is no
    difference that matters.
    """

    what: str
    here: Interval = NOT_MEASURED
    published: float = nan
    within: tuple[float, float] = (1 / (1 + MARGIN), 1 + MARGIN)

    @property
    def is_exponent(self) -> bool:
        """Whether it is no ratio of times but the exponent of a curve, which is 1 for a straight line."""
        return self.what == EXPONENT

    @property
    def is_measured(self) -> bool:
        """Whether there are records of it."""
        return isfinite(self.here.estimate)

    @property
    def has_interval(self) -> bool:
        """Whether there were enough blocks for an interval."""
        return isfinite(self.here.high) and isfinite(self.here.low)


def effect_of(
    what: str, row: Mapping[Any, Any] | None, published: float = nan, margin: float = MARGIN
) -> Effect:
    """Return the effect of a row of `verdicts.judge`, or of one that was not measured."""
    within = 1 / (1 + margin), 1 + margin
    if row is None:
        return Effect(what, NOT_MEASURED, published, within)
    ends = float(row["low"]), float(row["high"])
    known = all(map(isfinite, ends))
    # Infinite on both sides if on one.
    return Effect(what, Interval(float(row["ratio"]), *(ends if known else (-inf, inf))), published, within)
