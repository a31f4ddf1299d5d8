"""What a point is said to take: before anything is measured, after it, and how many runs pay."""

from dataclasses import replace
from pathlib import Path

import pytest

from experiments.plan.point import Point
from experiments.plan.program import Program
from experiments.plan.question import FOLDER, Blocks, load_question
from experiments.plan.scale import SCALES
from experiments.plan.site import Machine
from experiments.run.costs import (
    FIRST_RUNS,
    IN_THE_CLOCK,
    MOST_RUNS,
    MOST_SECONDS,
    SECONDS_PER_PROCESS,
    Costs,
    choose_runs,
)
from experiments.run.progress import about
from experiments.run.runner import ProcessResult
from experiments.run.study import Study
from experiments.run.task import representative
from experiments.tests.conftest import Workplace, generated
from experiments.tests.plan.test_shipped_files import planned

BUILT = Program("gcc", Path("carom"), "0" * 64)


def points(name: str) -> tuple[Point, ...]:
    """Those of a question on two cores, where gcc's build is there and no other."""
    found = planned(name, machine=Machine("test", 2, 2)).points
    return tuple(replace(one, program=BUILT) if one.program.name == "gcc" else one for one in found)


def test_a_point_without_records_is_estimated_by_its_scene() -> None:
    point = points("threads")[1]
    costs = Costs()
    assert costs.run(point) == pytest.approx(1, rel=0.5), "three times what two cores take"
    assert costs.fixed(point) + costs.run(point) == pytest.approx(costs.point(point))
    assert costs.fixed(point) > 0.05


@pytest.mark.parametrize(("minimum", "least"), [(1, 1), (2, 1), (3, 1), (6, 1), (24, 6)])
def test_at_quick_scale_the_budget_decides_from_fewer_blocks_on(minimum: int, least: int) -> None:
    asked = replace(load_question(FOLDER / "compiler.toml"), blocks=Blocks(minimum, 30))
    assert SCALES["quick"].question(asked).blocks == Blocks(least, 30)
    assert SCALES["paper"].question(asked) == asked
    control = load_question(FOLDER / "control.toml")
    assert SCALES["quick"].question(control) == control, "it leaves the budget no choice"


def test_more_work_costs_more() -> None:
    for name in ("particles", "steps"):
        estimates = [Costs().point(point) for point in points(name)]
        assert estimates == sorted({*estimates})
    empty, *between, crowded = (Costs().point(point) for point in points("grid_length"))
    assert min(between) < min(empty, crowded)


def test_records_overrule_the_estimate() -> None:
    point = points("control")[0]
    costs = Costs({point.id: [(2.0, [1.5]), (4.0, [1.5, 1.5]), (2.4, [1.9])]})
    assert costs.point(point) == 2.4 + SECONDS_PER_PROCESS
    assert costs.run(point) == 1.5
    assert costs.fixed(point) == pytest.approx(0.5 + SECONDS_PER_PROCESS)
    assert costs.point(point, runs=4) == pytest.approx(6.5 + SECONDS_PER_PROCESS)


def test_what_is_learnt_counts_with_what_a_process_takes_beside_its_own_account() -> None:
    pair = points("control")[:2]
    costs = Costs()
    for seconds in (99.0, 4.4):
        costs.learn(pair, [ProcessResult(2.0, runs=(1.5,))] * 2, seconds)
    assert costs.fixed(pair[0]) == pytest.approx(0.5 + 0.2), "the first process came with its check"


def test_what_is_learnt_about_one_point_corrects_the_others() -> None:
    first, second, *_ = points("particles")
    costs = Costs()
    before = [costs.point(one) - SECONDS_PER_PROCESS for one in (first, second)]
    costs.learn([first], [ProcessResult(5 * before[0])], 5 * before[0])
    assert costs.point(second) == pytest.approx(5 * before[1] + SECONDS_PER_PROCESS)


def test_a_missing_program_costs_nothing() -> None:
    [missing], [built, *_] = points("compiler"), points("row")
    assert Costs().point(built) > 0
    assert Costs().point(missing) == 0


def test_durations_in_words() -> None:
    words = ["about 1 s", "about 60 s", "about 2 min", "about 40 min", "about 2 h 05 min"]
    assert [about(seconds) for seconds in (0, 59.6, 100, 2400, 7500)] == words


def test_a_variant_is_checked_on_the_beginning_of_the_first_scene_of_its_name() -> None:
    experiment = planned("ladder")
    published = [point for point in experiment.points if point.variant == "published"]
    assert {generated(point).steps for point in published} == {40, 20, 100, 4}
    assert {point.scene_name: generated(representative(experiment, point)).steps for point in published} == {
        "100k at 0.80": 20,
        "100k at 0.91": 20,
        "10k at 0.88": 20,
        "1M at 0.80": 4,
    }
    sweep = planned("particles")
    assert len({representative(sweep, point).scene for point in sweep.points}) == 1


def test_a_hard_case_is_checked_to_its_end() -> None:
    experiment = planned("hard_cases")
    assert all(representative(experiment, point).scene is point.scene for point in experiment.points)


def test_three_quarters_of_a_process_are_in_the_clock() -> None:
    assert choose_runs(0.2, 0.04) == IN_THE_CLOCK * 5
    assert choose_runs(0.01, 0.04) == 1
    assert choose_runs(10.0, 0.04) == MOST_RUNS
    assert choose_runs(4.0, 1.0) == MOST_SECONDS
    assert choose_runs(1.0, 0.0) == MOST_RUNS


@pytest.fixture
def both(workplace: Workplace) -> tuple[Point, ...]:
    """Two points that take turns."""
    return next(one.points for one in Study(workplace.settings).experiments if one.name == "pair")


ENDED = ProcessResult(0.01, runs=(0.01,))


def test_who_has_seen_nothing_of_a_group_makes_few_runs_then_what_pays(both: tuple[Point, ...]) -> None:
    costs = Costs()
    assert costs.runs(both) <= FIRST_RUNS
    costs.learn(both, [ENDED, ENDED], 0.2)
    assert costs.runs(both) > FIRST_RUNS, "a process costs more than its run"
    assert costs.runs(both[:1]) == 1, "nobody to take turns with"


def test_a_process_that_failed_tells_nothing(both: tuple[Point, ...]) -> None:
    costs = Costs()
    costs.learn(both, [ENDED, ProcessResult(None, "crashed")], 9.0)
    assert costs.runs(both) <= FIRST_RUNS
