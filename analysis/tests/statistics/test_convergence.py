import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from analysis.statistics.ranking import front
from analysis.statistics.trends import FEWEST_ERRORS as FEWEST
from analysis.statistics.trends import order

DT = 1 / 2.0 ** np.arange(7)
POINTS = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), max_size=12)


@given(st.floats(0.25, 4), st.floats(-20, 20), st.floats(-20, 20))
def test_a_power_law_has_its_order_in_any_unit(known: float, error_unit: float, time_unit: float) -> None:
    unit = 10**error_unit
    fitted = order(10**time_unit * DT, unit * DT**known, ceiling=2 * unit)
    assert fitted.estimate == pytest.approx(known, rel=1e-6)
    assert fitted.low <= fitted.estimate <= fitted.high


@example([0, 0, 0, 0, 0.25, 0.25, 0.25])
@given(st.lists(st.floats(0, 1), min_size=len(DT), max_size=len(DT)))
def test_any_errors_have_an_order_within_its_interval_or_none(errors: list[float]) -> None:
    fitted = order(DT, errors, ceiling=0.5)
    none = sum(0 < error < 0.5 for error in errors) < FEWEST
    assert np.isnan(fitted.estimate) == none
    assert none or fitted.low <= fitted.estimate <= fitted.high


def test_the_interval_covers_the_known_order_as_often_as_it_says() -> None:
    generator = np.random.default_rng(1)
    covered = 0
    for _ in range(400):
        fitted = order(DT, 0.05 * DT * np.exp(generator.normal(0, 0.2, len(DT))), ceiling=1.0)
        covered += fitted.low <= 1 <= fitted.high
    assert 0.92 < covered / 400 < 0.98


def test_errors_that_are_not_small_do_not_count() -> None:
    saturated = np.where(DT > 0.2, 5.0, 0.05 * DT**2)
    assert order(DT, saturated, ceiling=0.1).estimate == pytest.approx(2)
    assert order(DT, saturated, ceiling=10).estimate != pytest.approx(2, abs=0.1)


def test_one_step_gives_no_order() -> None:
    assert np.isnan(order([0.5] * 4, [0.01, 0.02, 0.03, 0.04], ceiling=0.1).estimate)


def beaten(point: tuple[int, int], others: list[tuple[int, int]]) -> bool:
    return any(one != point and one[0] <= point[0] and one[1] <= point[1] for one in others)


@given(POINTS)
def test_the_front_is_what_nothing_else_beats(points: list[tuple[int, int]]) -> None:
    on_front = front([error for error, _ in points], [time for _, time in points])
    kept = [point for point, on in zip(points, on_front, strict=True) if on]
    assert sorted(kept) == sorted({point for point in points if not beaten(point, points)})


def test_what_was_not_measured_is_on_no_front() -> None:
    assert list(front([0.1, np.nan, 0.01], [1.0, 0.5, np.nan])) == [True, False, False]
