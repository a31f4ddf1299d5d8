"""Cold caches at each turn whose cost is known: found, and kept out of verdicts."""

import numpy as np
import pytest

from analysis.statistics.turns import bias, excess
from analysis.statistics.verdicts import judge_one

STEPS, ROUNDS, RUNS, BLOCKS = 40, 10, 4, 9
EACH = [STEPS // ROUNDS] * (ROUNDS * RUNS)
"""Steps of each turn."""


def process(
    generator: np.random.Generator, cold: float, noise: float = 0.02
) -> tuple[list[float], list[float]]:
    """Return the turns and first steps of runs whose steps grow by half; a turn loses `cold` of its time."""
    steps = np.linspace(1, 1.5, STEPS) * np.exp(generator.normal(0, noise, (RUNS, STEPS)))
    each = steps.reshape(RUNS, ROUNDS, -1)
    each[..., 0] += cold * each.sum(axis=2)
    return list(each.sum(axis=2).ravel()), list(each[..., 0].ravel())


def test_a_known_cost_is_found_though_steps_grow() -> None:
    found = excess(*process(np.random.default_rng(1), 0.03, noise=0.002), EACH, ROUNDS)
    none = excess(*process(np.random.default_rng(1), 0.0, noise=0.002), EACH, ROUNDS)
    assert found == pytest.approx(0.03 / 1.03, abs=0.002)
    assert abs(none) < 0.002
    assert bias(none, found) == pytest.approx(np.log(1.03), abs=0.002)


def test_where_it_cannot_be_told_nothing_is_said() -> None:
    assert np.isnan(excess([1.0, 1.0], [None, None], [1, 1], 2))
    assert np.isnan(excess([4.0], [1.0], [4], 1))
    assert np.isnan(bias(np.nan, 0.0))


def test_steps_of_unlike_work_are_no_cost_of_turns() -> None:
    """Every second step takes a half more; turns of two steps begin with another one in every second run."""
    work = np.tile([1.5, 1.0], 6)
    shifted = np.split(work, [1, 3, 5, 7, 9])
    turns = [*np.split(work, 6), *shifted]
    firsts = [float(one[0]) if len(one) > 1 else None for one in turns]
    found = excess([float(one.sum()) for one in turns], firsts, [len(one) for one in turns], 6)
    assert abs(found) < 0.05
    alone = excess([2.5] * 6, [1.5] * 6, [2] * 6, 6)
    assert alone == pytest.approx(0.2), "a run by itself cannot tell"


def test_a_bias_that_changes_its_sign_with_every_block_widens_nothing() -> None:
    ratios = np.random.default_rng(5).normal(0.1, 0.005, BLOCKS)
    assert judge_one(ratios, biases=np.resize([0.05, -0.05], BLOCKS)) == judge_one(ratios)


def test_what_turns_cost_one_of_two_equals_is_no_verdict() -> None:
    """The former rule: the ratio as it was measured. One pays 3 % a turn, the other nothing."""
    generator = np.random.default_rng(2)
    former = now = 0
    for _ in range(100):
        ratios, biases = np.empty(BLOCKS), np.empty(BLOCKS)
        for block in range(BLOCKS):
            reference, candidate = (process(generator, cold) for cold in (0.0, 0.03))
            ratios[block] = np.log(sum(candidate[0]) / sum(reference[0]))
            biases[block] = bias(*(excess(*side, EACH, ROUNDS) for side in (reference, candidate)))
        former += judge_one(ratios).verdict == "slower"
        now += judge_one(ratios, biases=biases).verdict in ("slower", "faster")
    assert former > 50
    assert now <= 5


def test_a_true_difference_beyond_the_bias_is_still_found() -> None:
    ratios = np.random.default_rng(3).normal(0.1, 0.005, BLOCKS)
    row = judge_one(ratios, biases=np.random.default_rng(4).normal(0.01, 0.002, BLOCKS))
    assert row.verdict == "slower"
    assert row.low < 1.09 < row.high
    few = np.r_[np.full(BLOCKS - 2, np.nan), 0.5, 0.5]
    for unknown in (np.full(BLOCKS, np.nan), few):
        assert judge_one(ratios, biases=unknown) == judge_one(ratios), "not known, not said"
