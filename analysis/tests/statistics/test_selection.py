"""What is said of the one that was picked from many, where all are equal. Seeds are fixed."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from analysis.statistics.looks import ERROR
from analysis.statistics.verdicts import error_of_picked, judge_one

Floats = NDArray[np.float64]
Noise = Callable[[np.random.Generator, tuple[int, int]], Floats]

EQUALS, STUDIES = 20, 100
LOOKS = (6, 9)
CHANCE = 0.044
"""Two standard errors of a rate of 5 % in so many studies."""


def quiet(generator: np.random.Generator, shape: tuple[int, int]) -> Floats:
    return generator.normal(0, 0.1, shape)


def two_speeds(generator: np.random.Generator, shape: tuple[int, int]) -> Floats:
    return np.log(2.3) * (generator.random(shape) < 0.3) + generator.normal(0, 0.007, shape)


def against_the_least(logs: Floats) -> Floats:
    """Return the log ratios of all others against the candidate with the least median, a row each."""
    least = int(np.median(logs, axis=1).argmin())
    ratios: Floats = np.delete(logs, least, axis=0) - logs[least]
    return ratios


def is_called_better(logs: Floats) -> bool:
    error = error_of_picked(len(logs))
    return any(judge_one(row, error=error).verdict == "slower" for row in against_the_least(logs))


@pytest.mark.parametrize("noise", [quiet, two_speeds])
def test_the_best_of_equals_is_not_called_better(noise: Noise) -> None:
    generator = np.random.default_rng(1)
    studies = [noise(generator, (EQUALS, LOOKS[-1])) for _ in range(STUDIES)]
    called = [any(is_called_better(study[:, :look]) for look in LOOKS) for study in studies]
    assert np.mean(called) <= 0.05 + CHANCE


@pytest.mark.parametrize("noise", [quiet, two_speeds])
def test_the_farthest_off_of_equals_has_an_interval_with_the_truth(noise: Noise) -> None:
    generator = np.random.default_rng(2)
    missed = 0
    for _ in range(STUDIES):
        ratios = noise(generator, (EQUALS, 2 * LOOKS[0])).reshape(EQUALS, 2, -1)
        differences = ratios[:, 0] - ratios[:, 1]
        farthest = differences[np.abs(differences.mean(axis=1)).argmax()]
        row = judge_one(farthest, error=ERROR / EQUALS)
        missed += not row.low < 1 < row.high
    assert missed <= (0.05 + CHANCE) * STUDIES


def test_of_two_candidates_there_is_one_comparison() -> None:
    assert [error_of_picked(number) for number in (1, 2, 3, 20)] == [ERROR, ERROR, ERROR / 3, ERROR / 190]
