"""Blocks for a budget: minima always, more while they fit, and to whom they are owed."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from experiments.plan.plan import Experiment, Surroundings, plan
from experiments.plan.point import Point
from experiments.plan.program import Program
from experiments.plan.question import FOLDER, Blocks, load_question
from experiments.plan.scale import SCALES
from experiments.plan.site import Machine, load_site
from experiments.run.budget import RESERVE, Load, allocate
from experiments.run.costs import PROBE, SECONDS_PER_PROCESS, Costs, Probe, probe_key
from experiments.run.progress import about
from experiments.run.verify import representative
from experiments.tests.conftest import generated

LOADS = st.lists(
    st.builds(
        lambda block, once, minimum, more: (block, once, minimum, minimum + more),
        st.floats(0.01, 100),
        st.floats(0, 20),
        st.integers(1, 6),
        st.integers(0, 12),
    ),
    min_size=1,
    max_size=12,
).map(lambda rows: [Load(str(number), *row) for number, row in enumerate(rows)])


def total(loads: list[Load], blocks: dict[str, int]) -> float:
    return sum(load.seconds(blocks[load.name]) for load in loads)


@given(LOADS, st.floats(0, 5000))
def test_blocks_lie_between_what_is_needed_and_what_is_wanted(loads: list[Load], budget: float) -> None:
    blocks = allocate(loads, budget)
    assert all(load.minimum <= blocks[load.name] <= load.wanted for load in loads)


@given(LOADS, st.floats(0, 5000))
def test_only_the_minima_may_break_the_budget(loads: list[Load], budget: float) -> None:
    blocks = allocate(loads, budget)
    least = {load.name: load.minimum for load in loads}
    assert total(loads, blocks) <= max(budget * (1 - RESERVE), total(loads, least)) + 1e-6


@given(LOADS)
def test_a_large_budget_gives_everything(loads: list[Load]) -> None:
    assert allocate(loads, 1e9) == {load.name: load.wanted for load in loads}


@given(LOADS, st.floats(0, 5000))
def test_what_is_left_is_too_little_for_anything_more(loads: list[Load], budget: float) -> None:
    blocks = allocate(loads, budget)
    left = budget * (1 - RESERVE) - total(loads, blocks)
    for load in loads:
        more = min(2, load.wanted - blocks[load.name])
        assert more == 0 or more * load.block_seconds > left - 1e-6


def test_equal_experiments_get_equal_shares() -> None:
    loads = [Load(name, 10, 0, 2, 20) for name in "abc"]
    assert allocate(loads, 10 * 3 * 8 / (1 - RESERVE) + 1) == {"a": 8, "b": 8, "c": 8}


def points(name: str) -> tuple[Point, ...]:
    return planned(name).points


def planned(name: str) -> Experiment:
    program = Program("gcc", Path("carom"), "0" * 64)
    missing = Program("clang", Path("carom"), None)
    around = Surroundings(
        load_site("local"), Machine("test", 2, 2), {"gcc": program, "clang": missing}, SCALES["paper"]
    )
    return plan(load_question(FOLDER / f"{name}.toml"), around)


@pytest.fixture(autouse=True)
def _every_variant_exists(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("experiments.plan.plan.variants", lambda _: AnyName())


class AnyName(tuple[str, ...]):
    def __contains__(self, name: object) -> bool:
        return True


def test_a_point_without_records_is_estimated_from_its_probe() -> None:
    point = points("threads")[1]
    costs = Costs({probe_key(point): Probe(step=0.003, process=0.02)}, {})
    steps = generated(point).steps
    size = generated(point).particles / PROBE.particles
    assert costs.point(point) > steps * size * 0.003
    assert costs.point(point) == pytest.approx(steps * size**1.2 * 0.003, rel=0.1)


def test_the_start_of_a_process_counts_once() -> None:
    point = points("hard_cases")[0]
    idle = Costs({probe_key(point): Probe(step=0.0, process=1.0)}, {})
    assert idle.point(point) == pytest.approx(1.0, rel=0.05)
    assert idle.check(point) == pytest.approx(1.0, rel=0.05)
    assert idle.besides(point) < 0.05, "measured within the process of the point"


@pytest.mark.parametrize(("minimum", "least"), [(1, 1), (2, 1), (3, 1), (6, 1), (24, 6)])
def test_at_quick_scale_the_budget_decides_from_fewer_blocks_on(minimum: int, least: int) -> None:
    asked = replace(load_question(FOLDER / "compiler.toml"), blocks=Blocks(minimum, 30))
    assert SCALES["quick"].question(asked).blocks == Blocks(least, 30)
    assert SCALES["paper"].question(asked) == asked


def test_what_leaves_the_budget_no_choice_is_the_same_at_quick_scale() -> None:
    control = load_question(FOLDER / "control.toml")
    assert SCALES["quick"].question(control) == control


def test_larger_scenes_cost_more() -> None:
    costs = Costs({}, {})
    for name in ("particles", "steps", "min_velocity", "max_velocity"):
        estimates = [costs.point(point) for point in points(name)]
        assert estimates == sorted(estimates)
        assert estimates[0] < estimates[-1]


def test_empty_boxes_and_crowded_discs_cost_more() -> None:
    costs = Costs({}, {})
    estimates = [costs.point(point) for point in points("grid_length")]
    assert min(estimates) < estimates[0]
    assert min(estimates) < estimates[-1]


def test_records_overrule_the_estimate() -> None:
    point = points("threads")[0]
    measured = [(3.0, [2.5]), (9.0, [1.0]), (4.0, [1.5, 1.5])]
    assert Costs({}, {point.id: measured}).point(point) == 4.0 + SECONDS_PER_PROCESS


def test_more_runs_cost_as_much_as_a_run_does() -> None:
    point = points("control")[0]
    costs = Costs({}, {point.id: [(2.0, [1.5]), (4.0, [1.5, 1.5]), (2.4, [1.9])]})
    assert costs.run(point) == 1.5
    assert costs.fixed(point) == pytest.approx(0.5 + SECONDS_PER_PROCESS)
    assert costs.point(point, runs=4) == pytest.approx(6.5 + SECONDS_PER_PROCESS)
    costs.learn_beside(point.experiment, 7.0)
    costs.learn_beside(point.experiment, 0.25)
    assert costs.point(point, runs=4) == pytest.approx(6.75), "the first process came with its check"


def test_before_anything_is_measured_a_process_is_its_runs_and_the_rest() -> None:
    point = points("control")[0]
    costs = Costs({probe_key(point): Probe(step=0.003, process=0.02)}, {})
    assert costs.fixed(point) > 0.02
    assert costs.fixed(point) + costs.run(point) == pytest.approx(costs.point(point))


def test_what_is_learnt_about_one_point_corrects_the_others() -> None:
    first, second, *_ = points("particles")
    costs = Costs({}, {})
    before = costs.point(second) - SECONDS_PER_PROCESS
    costs.learn(first, 5 * (costs.point(first) - SECONDS_PER_PROCESS))
    assert costs.point(second) == pytest.approx(5 * before + SECONDS_PER_PROCESS)


def test_a_missing_program_costs_nothing() -> None:
    missing, built = points("compiler")
    assert Costs({}, {}).point(built) > 0
    assert Costs({}, {}).point(missing) == 0


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0, "about 1 s"),
        (59.6, "about 60 s"),
        (100, "about 2 min"),
        (2400, "about 40 min"),
        (7500, "about 2 h 05 min"),
    ],
)
def test_durations_in_words(seconds: float, words: str) -> None:
    assert about(seconds) == words


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
