import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from analysis.records import published
from analysis.statistics import scalability
from analysis.statistics.trends import break_point, growth, linearity, minimum
from analysis.tests.synthetic_noise import Noise, times_table

Floats = NDArray[np.float64]

VM = Noise(burst_rate=0.01)


def curve(times: dict[float, float], blocks: int = 6, noise: Noise = VM, seed: int = 1) -> pd.DataFrame:
    table = times_table({f"{x:g}": seconds for x, seconds in times.items()}, blocks, 1, noise, seed)
    return table.assign(x=table["series"].astype(float), series="a")


def of_published(experiment: str) -> pd.DataFrame:
    rows = published.load().experiment(experiment)
    return rows.assign(steps_seconds=rows["seconds"], node="", block=0, session="")


@pytest.mark.parametrize("exponent", [-0.5, 0.3, 1.0])
def test_the_exponent_of_a_power_law_is_found(exponent: float) -> None:
    quiet = Noise(process=0.01, repetition=0.005, burst_rate=0, drift=0)
    trend = growth(curve({x: x**exponent for x in (1.0, 2.0, 4.0, 8.0, 16.0)}, noise=quiet))
    assert trend.change.verdict == ("grows" if exponent > 0 else "falls")
    assert trend.exponent.low - 0.01 <= exponent <= trend.exponent.high + 0.01


def test_an_interrupted_block_does_not_move_the_exponent() -> None:
    bent = curve({10.0: 1.0, 100.0: 1.5, 1000.0: 40.0}, blocks=5)
    cut = bent[~((bent["block"] == 4) & (bent["x"] == 1000.0))]
    assert growth(cut).exponent == growth(bent[bent["block"] < 4]).exponent


def test_a_curve_of_two_sessions_is_none() -> None:
    bent = curve({10.0: 1.0, 100.0: 1.5, 1000.0: 40.0, 2000.0: 90.0}, blocks=6)
    before = bent[bent["block"] < 5]
    parted = bent.assign(session=np.where((bent["block"] == 5) & (bent["x"] > 50), "later", "session"))
    assert growth(parted) == growth(before)
    assert linearity(parted) == linearity(before)
    assert minimum(parted) == minimum(before)


def test_a_constant_time_is_flat_or_undecided_and_never_a_trend() -> None:
    verdicts = [
        growth(curve(dict.fromkeys((1.0, 2.0, 4.0), 1.0), 21, seed=seed)).change.verdict for seed in range(40)
    ]
    assert set(verdicts) <= {"flat", "inconclusive"}
    assert verdicts.count("flat") >= 20


@pytest.mark.parametrize(("power", "verdict"), [(1.0, "linear"), (0.6, "not linear"), (1.5, "not linear")])
def test_linear_with_a_fixed_cost_is_told_from_curved(power: float, verdict: str) -> None:
    times = {float(x): 0.3 + 1.5 * (x / 200) ** power for x in range(20, 201, 20)}
    quiet = Noise(process=0.007, repetition=0.005, burst_rate=0, drift=0)
    assert [linearity(curve(times, 9, noise=quiet, seed=seed)).verdict for seed in range(20)].count(
        verdict
    ) >= 18


def test_the_published_steps_are_linear_and_the_sides_nearly() -> None:
    steps, sides = of_published("steps"), of_published("grid_length")
    assert linearity(steps).ratio == pytest.approx(1.0, abs=0.05)
    assert linearity(sides[sides["x"] >= 20_000]).ratio == pytest.approx(1.0, abs=0.1)


def test_too_few_points_leave_linearity_open() -> None:
    line = linearity(curve({1.0: 1.0, 2.0: 2.0, 3.0: 3.0}))
    assert np.isnan(line.ratio)
    assert line.verdict == "inconclusive"


def test_the_turn_is_found_with_its_break_point() -> None:
    times = {float(r): 0.14 * np.exp(abs(np.log(r / 35)) * (0.5 if r < 35 else 1.5)) for r in range(5, 51, 5)}
    least = minimum(curve(times))
    assert least.fall.verdict == "falls then rises"
    assert least.lowest == 35
    assert least.break_point.low <= 35.5
    assert least.break_point.high >= 34.5
    assert least.break_point.high - least.break_point.low < 10


@pytest.mark.parametrize(("power", "verdict"), [(1.0, "rises only"), (-1.0, "falls only")])
def test_a_monotone_curve_has_no_minimum_inside(power: float, verdict: str) -> None:
    assert minimum(curve({float(x): float(x) ** power for x in (1, 2, 4, 8)})).fall.verdict == verdict


@pytest.mark.parametrize(("blocks", "slow_points"), [(6, 2.0), (9, 1.0)])
def test_a_flat_curve_rises_or_falls_in_at_most_one_study_in_twenty(blocks: int, slow_points: float) -> None:
    generator = np.random.default_rng(blocks)
    noise = 0.05 * np.where(np.arange(10) % 2, slow_points, 1.0)
    verdicts = [
        minimum(table(np.exp(generator.normal(0, noise, (blocks, 10))))).fall.verdict for _ in range(150)
    ]
    assert set(verdicts) <= {"inconclusive", "flat", "rises only", "falls only", "falls then rises"}
    assert 150 - verdicts.count("inconclusive") - verdicts.count("flat") <= 7


@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_too_few_blocks_have_no_shape_and_no_break_point(blocks: int) -> None:
    least = minimum(curve({float(x): 1.0 + abs(x - 4) for x in range(1, 8)}, blocks=blocks))
    assert least.fall.verdict == "too few blocks"
    assert least.lowest == 4
    assert (least.break_point.low, least.break_point.high) == (-np.inf, np.inf)


def table(curves: Floats) -> pd.DataFrame:
    """Return the processes of a curve, a row of times a block, at x = 1, 2, ..."""
    blocks, points = curves.shape
    return pd.DataFrame(
        {
            "x": np.tile(np.arange(1.0, points + 1), blocks),
            "steps_seconds": curves.ravel(),
            "node": "n",
            "block": np.repeat(np.arange(blocks), points),
            "session": "s",
        }
    )


@pytest.mark.parametrize("blocks", [4, 7])
def test_the_break_point_s_interval_covers_it(blocks: int) -> None:
    x = np.arange(5.0, 51, 5)
    truth = np.exp(np.abs(np.log(x / 35)) * np.where(x < 35, 0.5, 1.5))
    generator = np.random.default_rng(blocks)
    curves = truth * np.exp(generator.normal(0, 0.02, (200, blocks, len(x))))
    found = [break_point(x, study) for study in curves]
    assert sum(one.low <= 35 <= one.high for one in found) >= 0.93 * 200


@pytest.mark.parametrize("blocks", [4, 7])
def test_the_law_s_intervals_cover_its_coefficients(blocks: int) -> None:
    threads = np.array([1.0, 2, 3, 4, 5, 6])
    truth = 4 / threads * (1 + 0.06 * (threads - 1) + 0.004 * threads * (threads - 1))
    generator = np.random.default_rng(blocks)
    laws = [
        scalability.fit(table(truth * np.exp(generator.normal(0, 0.02, (blocks, 6)))), 6) for _ in range(200)
    ]
    for name, value in (("contention", 0.06), ("coherency", 0.004)):
        found = [getattr(law, name) for law in laws]
        assert sum(one.low <= value <= one.high for one in found) >= 0.925 * 200, name
    law = laws[0]
    assert law is not None
    assert (law.points, law.speed_up(np.array([1.0]))[0]) == (6, 1)
    assert law.seconds == pytest.approx(4.0, rel=0.05)


def test_a_speed_up_beyond_the_cores_is_doubted() -> None:
    assert scalability.doubt(1.9, 2) == ""
    assert scalability.doubt(2.89, 2).startswith("a speed-up of 2.89 is doubtful")


def test_the_law_needs_four_thread_counts_that_the_machine_has() -> None:
    processes = curve({float(n): 1.0 / n for n in (1, 2, 3, 4)})
    assert scalability.fit(processes, 2) is None
    assert scalability.fit(processes, 4) is not None
