"""Many contenders in turns: what each takes, by the turns just before its own."""

import numpy as np
import pandas as pd
import pytest

from analysis.records.joint_turns import joined
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


def process(contenders: int, rounds: int, block: int = 0) -> pd.DataFrame:
    """The rows of a process of contenders that took turns, in which contender 1 takes 10 % more than 0, on a
    machine whose speed changes after every tenth turn.
    """
    random = np.random.default_rng(block)
    order = np.array([random.permutation(contenders) for _ in range(rounds)])
    places = np.argsort(order, axis=1) + contenders * np.arange(rounds)[:, None]
    speed = np.repeat(1 + 0.5 * random.integers(2, size=contenders * rounds // 10 + 1), 10)
    values = {"experiment": "e", "session": "s", "node": "n", "block": block, "scene": "x", "threads": 2}
    rows = [
        values
        | {
            "binary_sha256": "p",
            "places": places[:, who],
            "steps_seconds_of_rounds": (1 + 0.1 * (who == 1)) * speed[places[:, who]],
        }
        for who in range(contenders)
    ]
    return pd.DataFrame(rows)


def test_of_many_one_value_each_is_left() -> None:
    rows = joined(pd.concat([process(20, 6, block) for block in range(2)], ignore_index=True))
    rounds = rows["steps_seconds_of_rounds"]
    assert rounds.map(len).tolist() == [1] * 40
    for block in range(2):
        assert rounds[20 * block + 1][0] / rounds[20 * block][0] == pytest.approx(1.1, rel=0.02)


@pytest.mark.parametrize("what", ["few", "one is lost", "older records"])
def test_of_others_the_rounds_are_left(what: str) -> None:
    rows = process(4 if what == "few" else 6, 8)
    if what == "one is lost":
        rows = rows.drop(index=3)
    if what == "older records":
        rows["places"] = [np.array([], dtype=np.int64)] * len(rows)
    left = joined(rows)["steps_seconds_of_rounds"]
    assert left.map(len).tolist() == [8] * len(rows)
