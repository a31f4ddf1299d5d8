"""How many runs a process makes: most of its time is in the clock, and it stays short."""

from hypothesis import given
from hypothesis import strategies as st

from experiments.run.costs import Costs
from experiments.run.repeats import IN_THE_CLOCK, MOST_RUNS, MOST_SECONDS, choose_runs, process_runs
from experiments.run.runner import ProcessResult
from experiments.run.study import Study
from experiments.tests.conftest import Workplace


def test_three_quarters_of_a_process_are_in_the_clock() -> None:
    assert choose_runs(0.2, 0.04) == IN_THE_CLOCK * 5
    assert choose_runs(0.01, 0.04) == 1
    assert choose_runs(10.0, 0.04) == MOST_RUNS
    assert choose_runs(4.0, 1.0) == MOST_SECONDS


@given(st.floats(0, 10), st.floats(0, 100))
def test_it_keeps_its_bounds(fixed: float, run: float) -> None:
    runs = choose_runs(fixed, run)
    assert 1 <= runs <= MOST_RUNS
    assert runs == 1 or runs * run <= 1.5 * MOST_SECONDS


def test_who_has_seen_nothing_of_a_group_makes_one_run_then_what_pays(workplace: Workplace) -> None:
    points = {one.name: one.points for one in Study(workplace.settings).experiments}
    costs = Costs({}, {})
    assert process_runs(points["pair"], costs) == 1
    costs.learn_group(
        points["pair"], [ProcessResult(0.01, runs=(0.01,)), ProcessResult(0.01, runs=(0.01,))], 0.2
    )
    assert process_runs(points["pair"], costs) > 1, "a process costs more than its run"
    assert process_runs(points["chunks"], costs) == 1


def test_a_process_of_one_contender_or_that_failed_tells_nothing(workplace: Workplace) -> None:
    [points] = [one.points for one in Study(workplace.settings).experiments if one.name == "pair"]
    costs = Costs({}, {})
    costs.learn_group(points[:1], [ProcessResult(9.0, runs=(1.0, 1.1))], 9.0)
    costs.learn_group(points, [ProcessResult(9.0, runs=(1.0,)), ProcessResult(None, "crashed")], 9.0)
    assert process_runs(points, costs) == 1
