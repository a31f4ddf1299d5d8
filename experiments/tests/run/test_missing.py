"""Whatever a folder holds: a run ends, measures nothing whole again, and has each block whole at its end."""

from collections.abc import Collection

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from experiments.plan.plan import Experiment
from experiments.results.store import Found, Key
from experiments.run.missing import missing
from experiments.run.study import Study
from experiments.tests.conftest import ERRORS, Workplace

BLOCKS = 4


@pytest.fixture
def experiment(empty_workplace: Workplace) -> Experiment:
    """Two scenes of four points each."""
    empty_workplace.question("errors", ERRORS)
    (one,) = Study(empty_workplace.settings).experiments
    return one


@st.composite
def earlier(draw: st.DrawFn, experiment: Experiment) -> Found:
    """What earlier sessions left: points measured, failed, or nothing."""
    found = Found()
    for block in range(BLOCKS):
        for point in experiment.points:
            session = draw(st.sampled_from(["", "monday", "monday", "monday", "tuesday"]))
            if session:
                found.sessions[point.id, block] = session
                is_failed = draw(st.integers(0, 5)) == 0
                there = found.failures if is_failed else found.seconds
                there[point.id, block] = "crashed" if is_failed else 1.0  # type: ignore[assignment]
    return found


def finish(experiment: Experiment, found: Found, session: str, hopeless: Collection[str] = ()) -> list[Key]:
    """Run what is missing, the first of it before the next; returns what was run."""
    given_up: set[str] = set()
    ran: list[Key] = []

    def lacking() -> Key | None:
        all_of_them = (
            (block, missing(experiment, found, block, session, given_up)) for block in range(BLOCKS)
        )
        return next(((point.id, block) for block, there in all_of_them for _, point in there), None)

    while (key := lacking()) is not None:
        ran.append(key)
        found.sessions[key] = session
        for there in (found.seconds, found.failures):
            there.pop(key, None)
        if key[0] in hopeless:
            given_up.add(key[0])
            found.failures[key] = "crashed"
        else:
            found.seconds[key] = 1.0
    return ran


@given(st.data())
@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_run_ends_with_each_block_whole(experiment: Experiment, data: st.DataObject) -> None:
    found = data.draw(earlier(experiment))
    ids = [point.id for point in experiment.points]
    hopeless = data.draw(st.sets(st.sampled_from(ids), max_size=2))
    before, never_failed = dict(found.sessions), not found.failures
    ran = finish(experiment, found, "now", hopeless)
    assert len(ran) == len(set(ran)), "nothing is measured twice"
    assert all(sum(point == one for one, _ in ran) <= 1 for point in hopeless), "it fails once a session"
    failed = {point for point, _ in found.failures}
    for name in {point.scene_name for point in experiment.points}:
        own = [point.id for point in experiment.points if point.scene_name == name]
        for block in range(BLOCKS):
            keys = [(point, block) for point in own if point not in failed]
            assert len({found.sessions[key] for key in keys}) <= 1
            assert all(key in found.seconds for key in keys)
            sessions = {before.get((point, block)) for point in own}
            was_whole = len(sessions) == 1 and None not in sessions
            assert not (was_whole and never_failed and any((point, block) in ran for point in own))
    again = finish(experiment, found, "later", hopeless)
    tried = {(scene_of(experiment, point), block) for point, block in found.failures}
    assert {(scene_of(experiment, point), block) for point, block in again} <= tried


def scene_of(experiment: Experiment, point: str) -> str | None:
    return next(one.scene_name for one in experiment.points if one.id == point)
