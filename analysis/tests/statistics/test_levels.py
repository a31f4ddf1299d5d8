import numpy as np

from analysis.statistics.noise import levels, shifting


def test_a_machine_that_switches_has_two_speeds() -> None:
    generator = np.random.default_rng(1)
    slow = np.repeat(generator.random(10) < 0.5, 3)
    found = levels(1.6 * np.exp(np.log(2.3) * slow + generator.normal(0, 0.02, 30)))
    assert found is not None
    assert abs(found.factor - 2.3) < 0.1
    assert (found.slow, found.times) == (slow.sum(), 30)
    assert found.changes == (slow[1:] != slow[:-1]).sum()


def test_one_speed_is_not_taken_for_two() -> None:
    generator = np.random.default_rng(2)
    for count in (8, 12, 30):
        wide = [levels(np.exp(generator.normal(0, 0.3, count))) for _ in range(400)]
        assert sum(found is not None for found in wide) <= 8, count


def test_a_burst_and_few_or_equal_times_are_no_second_speed() -> None:
    assert levels([1.0] * 11 + [2.3]) is None
    assert levels([1.0, 2.3] * 3) is None
    assert levels([1.0] * 12) is None


def test_a_speed_that_shifts_is_told_from_noise() -> None:
    generator = np.random.default_rng(3)
    drift = np.cumsum(generator.normal(0, 0.1, (200, 24)), axis=1)
    noise = generator.normal(0, 0.3, (200, 24))
    assert sum(shifting(np.exp(one)) for one in drift) > 100
    assert sum(shifting(np.exp(one)) for one in noise) <= 6
    assert not shifting(np.linspace(1.0, 1.1, 24)), "a drift of 10 % cancels within blocks"
