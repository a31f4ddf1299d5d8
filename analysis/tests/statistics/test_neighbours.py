"""Many contenders in turns: what each takes, by the turns just before its own."""

import numpy as np
import pytest

from analysis.statistics.neighbours import Order, contender_logs
from analysis.support.values import Floats

CONTENDERS, ROUNDS = 20, 6
EFFECTS = np.linspace(-0.05, 0.05, CONTENDERS)
WORK = np.linspace(0.5, -0.5, ROUNDS)
"""What the rounds have in common."""


def drawn(random: np.random.Generator, noise: Floats) -> tuple[Floats, Order]:
    """The logarithms of turns with noise in the order of time, and that order."""
    order = np.array([random.permutation(CONTENDERS) for _ in range(ROUNDS)])
    logs = np.add.outer(EFFECTS, WORK)
    logs[order.ravel(), np.repeat(np.arange(ROUNDS), CONTENDERS)] += noise
    return logs, order


def autoregression(random: np.random.Generator, correlation: float) -> Floats:
    """Noise of standard deviation 1 and a correlation from turn to turn."""
    values = random.normal(size=CONTENDERS * ROUNDS)
    for at in range(1, len(values)):
        values[at] = correlation * values[at - 1] + np.sqrt(1 - correlation**2) * values[at]
    return values


def test_without_noise_the_effects_come_out() -> None:
    logs, order = drawn(np.random.default_rng(1), np.zeros(CONTENDERS * ROUNDS))
    assert contender_logs(logs, order) == pytest.approx(EFFECTS, abs=1e-9)


@pytest.mark.parametrize(
    ("correlation", "least", "most"), [(0.0, 0.93, 1.0), (0.5, 1.1, 1.6), (0.8, 1.5, 3.0), (0.95, 1.9, 4.0)]
)
def test_slow_noise_spoils_less_than_by_rounds(correlation: float, least: float, most: float) -> None:
    random = np.random.default_rng(2)
    by_rounds, by_neighbours = [], []
    for _ in range(100):
        logs, order = drawn(random, 0.1 * autoregression(random, correlation))
        by_rounds.append(logs.mean(axis=1) - logs.mean() - EFFECTS)
        by_neighbours.append(contender_logs(logs, order) - EFFECTS)
    gain = np.std(by_rounds) / np.std(by_neighbours)
    assert least < gain < most
    error = np.std(by_neighbours, axis=0) / np.sqrt(100)
    assert np.abs(np.mean(by_neighbours, axis=0) / error).max() < 4, "it is right on average"


def test_a_burst_spoils_little() -> None:
    random = np.random.default_rng(3)
    noise = 0.01 * random.normal(size=CONTENDERS * ROUNDS)
    state = random.bit_generator.state
    clean, order = drawn(random, noise)
    noise[37] += np.log(10)
    random.bit_generator.state = state
    burst, _ = drawn(random, noise)
    moved = np.abs(contender_logs(burst, order) - contender_logs(clean, order))
    assert moved.max() < 0.02, "a turn ten times as long is a sixth of 2.3 in a mean"
