"""What the differences between the points of a curve say of its shape."""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, permutations
from typing import Literal

from analysis.statistics.intervals import Centre, measure
from analysis.statistics.looks import ERROR, share
from analysis.support.values import Floats, Interval

SHAPES = ("falls then rises", "rises only", "falls only", "flat")
"""Of these at most one is true of a curve."""


@dataclass(frozen=True)
class Curves:
    """The logarithms of a curve's points, blocks x points, in the order of time, of a planned look.

    A difference of two points has the noise of those two points alone: an end may be several times as noisy
    as the rest, and what a block suffers cancels.
    """

    logs: Floats

    @property
    def points(self) -> int:
        """How many points the curve has."""
        return self.logs.shape[1]

    @cached_property
    def means(self) -> Floats:
        """The mean of each point over the blocks."""
        return self.logs.mean(axis=0)

    @property
    def lowest(self) -> int:
        """The point of the least mean."""
        return int(self.means.argmin())

    def interval_above_lowest(self, point: int) -> Interval:
        """Return how far a point lies above the lowest, which was found by looking: the intervals of an end
        against all others hold together, those of both ends, and of all looks, in 95 % of studies
        (Bonferroni).
        """
        if point == self.lowest:
            return Interval(0.0, 0.0, 0.0)
        level = 1 - ERROR * share(len(self.logs)) / max(1, 2 * (self.points - 1))
        return self._difference(point, self.lowest).interval(level)

    def shape(self, bound: float) -> tuple[str, float]:
        """Return which of `SHAPES` is best supported, by differences of more than `bound`, and its p-value
        over all looks and shapes.

        *falls then rises*: some point inside lies below both ends; *rises only*: the last point lies above
        the first, and the first above none; *falls only*: the other way round; *flat*: no two points differ.
        What needs several differences at once has the greatest of their p-values (intersection-union: Berger,
        Technometrics 24, 1982), what needs any one of the points inside the least times their number.
        """
        p = {
            "falls then rises": self._inside(bound),
            "rises only": self._only_away_from(0, self.points - 1, bound),
            "falls only": self._only_away_from(self.points - 1, 0, bound),
            "flat": max(
                (self._p(*two, bound, "less") for two in permutations(range(self.points), 2)), default=1.0
            ),
        }
        best = min(SHAPES, key=lambda shape: p[shape])
        return best, len(SHAPES) * p[best] / share(len(self.logs))

    def _inside(self, bound: float) -> float:
        last = self.points - 1
        found = [
            max(self._p(0, point, bound, "greater"), self._p(last, point, bound, "greater"))
            for point in range(1, last)
        ]
        return len(found) * min(found, default=1.0)

    def _only_away_from(self, start: int, end: int, bound: float) -> float:
        never = [self._p(start, point, bound, "less") for point in range(self.points) if point != start]
        return max(self._p(end, start, bound, "greater"), *never)

    def _p(self, one: int, other: int, bound: float, alternative: Literal["less", "greater"]) -> float:
        return self._difference(one, other).p_value(bound, alternative)

    def _difference(self, one: int, other: int) -> Centre:
        first, second = sorted((one, other))
        found = self._differences[first, second]
        return found if one == first else found.mirrored()

    @cached_property
    def _differences(self) -> dict[tuple[int, int], Centre]:
        pairs = combinations(range(self.points), 2)
        return {(one, other): measure(self.logs[:, one] - self.logs[:, other]) for one, other in pairs}
