"""Whatever a folder holds: a run ends, leaves what is there, and has as many whole blocks as were given."""

from collections.abc import Collection

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from experiments.plan.plan import Experiment
from experiments.results.store import Found, Key
from experiments.run.study import Study
from experiments.run.whole_blocks import WholeBlocks
from experiments.tests.conftest import ERRORS, Workplace

EARLIER = st.sampled_from(["", "monday", "tuesday"])


@pytest.fixture
def experiment(empty_workplace: Workplace) -> Experiment:
    """Two scenes of four points each; the first block measures errors, too."""
    empty_workplace.question("errors", ERRORS)
    (one,) = Study(empty_workplace.settings).experiments
    return one


@st.composite
def earlier(draw: st.DrawFn, experiment: Experiment) -> Found:
    """What earlier sessions left: records, failures, or nothing."""
    found = Found()
    for block in range(draw(st.integers(0, 4))):
        for point in experiment.points:
            session = draw(EARLIER)
            if session:
                found.seconds[point.id, block], found.sessions[point.id, block] = 1.0, session
            elif draw(st.integers(0, 5)) == 0:
                found.failures[point.id, block] = "crashed"
    return found


def finish(
    experiment: Experiment, blocks: int, found: Found, session: str, hopeless: Collection[str] = ()
) -> tuple[WholeBlocks, list[Key]]:
    """Run what is missing as the runner does; the blocks as they are then, and what was run."""
    given_up: set[str] = set()
    ran, failed = [], {}
    now = WholeBlocks(experiment, blocks, found, session)
    block = now.next()
    while block is not None:
        for _, point in now.missing(block):
            key = (point.id, block)
            ran.append(key)
            if point.id in hopeless:
                given_up.add(point.id)
                failed[key] = "crashed"
            else:
                found.seconds[key], found.sessions[key] = 1.0, session
                found.failures.pop(key, None)
        now = WholeBlocks(experiment, blocks, found, session, given_up)
        block = now.next()
    assert not any(now.missing(block) for block in range(now.end()))
    found.failures |= failed
    return now, ran


def test_a_block_counts_in_the_place_of_an_earlier_one_whose_failures_are_mended(
    experiment: Experiment,
) -> None:
    own = [point.id for point in experiment.points if point.scene_name == experiment.points[0].scene_name]
    found = Found()
    found.seconds[own[0], 0], found.sessions[own[0], 0] = 1.0, "monday"
    for block in (0, 1):
        found.failures |= {(point, block): "crashed" for point in own[1:]}
    now, _ = finish(experiment, 1, found, "now")
    assert now.numbers[experiment.points[0].scene_name or ""] == [1]


@given(st.data())
@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_run_ends_with_as_many_whole_blocks_as_were_given(
    experiment: Experiment, data: st.DataObject
) -> None:
    found = data.draw(earlier(experiment))
    ids = [point.id for point in experiment.points]
    hopeless = data.draw(st.sets(st.sampled_from(ids), max_size=2))
    blocks = data.draw(st.integers(1, 4))
    before = dict(found.sessions)
    now, ran = finish(experiment, blocks, found, "now", hopeless)
    assert before.items() <= found.sessions.items(), "nothing is measured over"
    assert len(ran) == len(set(ran))
    assert all(sum(point == one for one, _ in ran) <= 1 for point in hopeless), "it fails once a session"
    for scene, numbers in now.numbers.items():
        own = [point for point in experiment.points if point.scene_name == scene]
        assert len(numbers) == blocks
        for block in numbers:
            hopeful = [point for point in own if point.id not in hopeless]
            assert len({found.sessions[point.id, block] for point in hopeful}) == 1
    again, rerun = finish(experiment, blocks, found, "later", hopeless)
    assert again.numbers == now.numbers
    assert {point for point, _ in rerun} <= hopeless, "only what failed is tried again"
