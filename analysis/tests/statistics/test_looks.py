"""Comparisons that are looked at until they are decided."""

import numpy as np
import pytest
from numpy.typing import NDArray

from analysis.statistics.looks import LOOKS, last_look, next_look, share
from analysis.statistics.verdicts import MARGIN, judge_one

Floats = NDArray[np.float64]

COMPARISONS = 30
LAST = LOOKS[-1]


def normal(generator: np.random.Generator) -> Floats:
    return generator.normal(0, 0.03, (COMPARISONS, LAST))


def unlike(generator: np.random.Generator) -> Floats:
    deviations = np.exp(generator.normal(np.log(0.02), 0.7, (COMPARISONS, 1)))
    return deviations * generator.normal(0, 1, (COMPARISONS, LAST))


def bursts(generator: np.random.Generator) -> Floats:
    shape = (COMPARISONS, LAST)
    return generator.normal(0, 0.015, shape) + generator.normal(0, 0.2, shape) * (
        generator.random(shape) < 0.05
    )


def two_speeds(generator: np.random.Generator) -> Floats:
    """Turns that both see the machine change its speed by 2.3, by chance not both at once."""
    slow = generator.random((COMPARISONS, LAST, 2)) < 0.1
    half_slow = np.log(2.3) / 2 * slow
    return half_slow[..., 0] - half_slow[..., 1] + generator.normal(0, 0.02, (COMPARISONS, LAST))


NOISES = (normal, unlike, bursts, two_speeds)


def decided(row: Floats) -> str:
    """Return the verdict of a comparison that goes on until it is settled."""
    verdicts = (judge_one(row[:look]).verdict for look in LOOKS)
    return next((one for one in verdicts if one != "inconclusive"), "inconclusive")


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("effect", [0.0, 0.019, 0.021, 0.05])
def test_looking_until_it_is_decided_errs_in_at_most_one_in_twenty(noise: object, effect: float) -> None:
    generator = np.random.default_rng(5)
    truth = "equivalent" if effect < MARGIN else "slower"
    assert callable(noise)
    found = [decided(row + np.log1p(effect)) for _ in range(4) for row in noise(generator)]
    assert sum(verdict not in (truth, "inconclusive") for verdict in found) <= 0.05 * len(found)
    if effect == 0.05:  # one and a half margins beyond the border
        assert found.count("slower") >= 0.9 * len(found)


def test_what_is_looked_at_once_has_the_whole_of_the_error() -> None:
    logs = np.random.default_rng(10).normal(0, 0.03, (1000, 60))
    once = [judge_one(row, once=True) for row in logs]
    misses = np.mean([not one.low < 1 < one.high for one in once])
    assert 0.03 <= misses <= 0.065
    among_looks = judge_one(logs[0])
    assert once[0].low > among_looks.low
    assert once[0].not_faster < among_looks.not_faster * share(48), "none depends on another"


def test_the_shares_of_all_looks_are_a_whole() -> None:
    looks = [LOOKS[0]]
    while looks[-1] < 1_000_000:
        looks.append(next_look(looks[-1]))
    assert tuple(looks[: len(LOOKS)]) == LOOKS
    assert sum(map(share, looks)) == pytest.approx(1, abs=1e-6)
    assert share(7) == share(6)
    assert [last_look(count) for count in (0, 5, 6, 8, 9, 71, 72)] == [0, 5, 6, 6, 9, 48, 72]
