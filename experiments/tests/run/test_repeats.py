"""How many runs a process makes: the optimum of known variances, and what is made of few records."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from experiments.results.store import Key
from experiments.run.costs import Costs
from experiments.run.repeats import (
    FEWEST_PROCESSES,
    MOST_RUNS,
    MOST_SECONDS,
    Process,
    Spread,
    best_runs,
    choose_runs,
    process_runs,
    spread,
)
from experiments.run.runner import ProcessResult
from experiments.run.study import Study
from experiments.tests.conftest import Workplace


def processes(
    number: int, runs: int, within: float, between: float, contenders: int = 3, seed: int = 1
) -> list[Process]:
    """Simulated ones; standard deviations of log times within processes and between them. What hits all
    contenders alike is ten times as large.
    """
    draw = random.Random(seed)
    result: list[Process] = []
    for _ in range(number):
        common = [draw.gauss(0, 10 * within) for _ in range(runs)]
        of_process = [draw.gauss(0, between) for _ in range(contenders)]
        result.append(
            [[math.exp(mean + shift + draw.gauss(0, within)) for shift in common] for mean in of_process]
        )
    return result


def test_the_variances_of_simulated_processes_are_found() -> None:
    found = spread(processes(4000, 4, within=0.04, between=0.02))
    assert found is not None
    # The mean of three contenders takes a third of either variance with it.
    assert found.within == pytest.approx(0.04**2 * 2 / 3, rel=0.1)
    assert found.between == pytest.approx(0.02**2 * 2 / 3, rel=0.15)


def test_processes_alike_but_for_their_runs_spend_half_of_their_time_in_runs() -> None:
    assert best_runs(1.0, 0.25, Spread(0.04**2, 0.0)) == 4
    assert choose_runs(0.1, 1e-4, Spread(1e-3, 0.0), last=MOST_RUNS) == MOST_RUNS


def test_the_optimum_is_the_best_of_all_numbers() -> None:
    """The variance of a process times the square of its cost, of each number of runs."""
    variances, fixed, run = Spread(0.04**2, 0.01**2), 0.4, 0.04

    def width_for_a_second(runs: int) -> float:
        return (variances.between + variances.within / runs) * (fixed + runs * run) ** 2

    best = min(range(1, 100), key=width_for_a_second)
    assert abs(best - best_runs(fixed, run, variances)) < 1
    assert best == 6


@pytest.mark.parametrize(
    "told",
    [
        processes(FEWEST_PROCESSES - 1, 4, 0.1, 0.1),
        processes(9, 1, 0.1, 0.1),
        processes(9, 4, 0.1, 0.1, contenders=1),
        [],
    ],
    ids=["too few", "one run each", "one contender", "none"],
)
def test_what_does_not_tell_the_variances(told: list[Process]) -> None:
    assert spread(told) is None


def test_processes_of_unlike_numbers_of_runs_are_pooled() -> None:
    mixed = [*processes(2000, 2, 0.04, 0.02), *processes(2000, 8, 0.04, 0.02, seed=2)]
    found = spread(mixed)
    assert found is not None
    assert found.between == pytest.approx(0.02**2 * 2 / 3, rel=0.2)


def test_before_anything_is_known_half_of_a_process_is_runs_and_two_at_least() -> None:
    assert choose_runs(0.2, 0.04, None) == 5
    assert choose_runs(0.01, 0.04, None) == 2
    assert choose_runs(0.01, 2.0, None) == 2
    assert choose_runs(0.01, 4.0, None) == 1, "a process would be too long"


def test_it_changes_by_a_factor_of_two_at_once() -> None:
    steady, wild = Spread(1e-9, 1.0), Spread(1.0, 1e-9)
    assert choose_runs(0.2, 0.04, steady, last=8) == 4
    assert choose_runs(0.8, 0.04, wild, last=8) == 16


@given(
    st.floats(0, 10),
    st.floats(0, 100),
    st.one_of(st.none(), st.builds(Spread, st.floats(0, 1), st.floats(0, 1))),
    st.integers(0, MOST_RUNS),
)
def test_it_keeps_its_bounds(fixed: float, run: float, known: Spread | None, last: int) -> None:
    runs = choose_runs(fixed, run, known, last)
    assert 1 <= runs <= MOST_RUNS
    assert runs == 1 or runs * run <= 1.5 * MOST_SECONDS


def test_who_has_seen_nothing_of_a_group_makes_one_run_then_what_pays(workplace: Workplace) -> None:
    points = {one.name: one.points for one in Study(workplace.settings).experiments}
    costs = Costs({}, {})
    seen: dict[Key, tuple[float, ...]] = {}
    assert process_runs(points["pair"], seen, costs) == 1
    for block, made in enumerate(
        processes(FEWEST_PROCESSES + 2, 1, within=0.001, between=0.02, contenders=2)
    ):
        process = [tuple(seconds / 100 for seconds in runs) for runs in made]
        ended = [ProcessResult(sum(runs), runs=runs) for runs in process]
        costs.learn_group(points["pair"], ended, 10 * sum(map(sum, process)))
        seen |= {(one.id, block): runs for one, runs in zip(points["pair"], process, strict=True)}
    assert process_runs(points["pair"], seen, costs) > 1, "a process costs more than its run"
    assert process_runs(points["chunks"], seen, costs) == 1


def test_a_process_of_one_contender_or_that_failed_tells_nothing(workplace: Workplace) -> None:
    [points] = [one.points for one in Study(workplace.settings).experiments if one.name == "pair"]
    costs = Costs({}, {})
    costs.learn_group(points[:1], [ProcessResult(9.0, runs=(1.0, 1.1))], 9.0)
    costs.learn_group(points, [ProcessResult(9.0, runs=(1.0,)), ProcessResult(None, "crashed")], 9.0)
    assert process_runs(points, {(points[0].id, 1): (1.0,), (points[1].id, 1): ()}, costs) == 1
