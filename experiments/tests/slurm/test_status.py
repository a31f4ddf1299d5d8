"""A cluster's status: a bar, tasks and their fates, and an end that is foretold from what blocks took."""

from collections import Counter
from datetime import UTC, datetime
from pathlib import Path

import pytest

from experiments.slurm.scheduler import TaskState
from experiments.slurm.status import Expected, progress_line
from experiments.slurm.task import work
from experiments.tests.conftest import Workplace
from experiments.tests.slurm.fake_slurm import FakeSlurm
from experiments.tests.slurm.test_script import site
from experiments.tests.slurm.test_submit import say, took

NOON = datetime(2024, 3, 1, 12, tzinfo=UTC)


def runs(seconds: float) -> Expected:
    return TaskState("RUNNING", "None"), seconds


def waits(seconds: float | None) -> Expected:
    return TaskState("PENDING", "Resources"), seconds


FORETOLD = {
    "no sooner than the longest task": (
        *([runs(0), runs(40), waits(60), waits(120)], 2),
        "2 tasks run, 2 wait; about 2 min left if 2 run at a time, done at 12:02",
    ),
    "one after the other": (
        *([runs(0), runs(40), waits(60), waits(120)], 1),
        "2 tasks run, 2 wait; about 4 min left if 1 run at a time, done at 12:03",
    ),
    "fewer than may run": (
        *([waits(86400)], 4),
        "0 tasks run, 1 wait; about 24 h 00 min left if 1 run at a time, done at 2024-03-02 12:00",
    ),
    "nothing is known": (
        *([waits(None)], 4),
        "0 tasks run, 1 wait; when they will be done is not known: nothing is measured yet",
    ),
    "nothing is under way": ([], 4, "no task runs or waits: `carom study resume` submits what is missing"),
    "nobody answers": (None, 4, "what runs and waits is not known"),
}


@pytest.mark.parametrize(("tasks", "at_once", "said"), FORETOLD.values(), ids=FORETOLD.keys())
def test_the_end_is_foretold_by_what_blocks_have_taken(
    tasks: list[Expected] | None, at_once: int, said: str
) -> None:
    line = progress_line("xs", Counter(done=3, missing=5), tasks, at_once, NOON)
    assert line == f"xs: [#########---------------] 3 of 8 processes; {said}"


def manifest(workplace: Workplace) -> Path:
    return next(workplace.results.rglob("jobs/0001.json"))


def test_status_follows_a_study_from_its_submission_to_its_end(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root, "# own", "at_once = 1")
    say(workplace, "submit")
    output, _ = say(workplace, "status")
    assert "0 of 16 processes; 0 tasks run, 7 wait; when they will be done is not known: nothing" in output
    assert "7 of the tasks wait: Resources" in output
    for index, state in enumerate(["COMPLETED", "COMPLETED", "COMPLETED", "RUNNING", "SUSPENDED"]):
        assert index == 4 or work(manifest(workplace), index) == 0
        slurm.becomes(index, state)
    took(workplace, 60.0)
    output, _ = say(workplace, "status")
    assert "10 of 16 processes; 2 tasks run, 2 wait; about 6 min left if 1 run at a time" in output
    assert "; 1 suspended: what the pause cut through is measured again" in output
    for index in range(4, 7):
        assert work(manifest(workplace), index) == 0
    slurm.ends()
    output, _ = say(workplace, "status")
    assert f"xs: [{'#' * 24}] 16 of 16 processes\n" in output


def test_a_scheduler_that_does_not_answer_is_no_empty_queue(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root)
    say(workplace, "submit")
    slurm.configure(squeue_fails=["slurm_load_jobs error: Unable to contact slurm controller"])
    output, error = say(workplace, "status")
    assert error == (
        "squeue: error: slurm_load_jobs error: Unable to contact slurm controller; "
        "what runs and what waits is shown as missing\n"
    )
    assert "0 of 16 processes; what runs and waits is not known\n" in output


def test_what_became_of_tasks_that_left_blocks_unfinished_is_told(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root)
    say(workplace, "submit")
    work(manifest(workplace), 0)
    slurm.ends("TIMEOUT")
    for index in range(6):
        manifest(workplace).with_name(f"0001-{index}.log").touch()
    output, _ = say(workplace, "status")
    logs = manifest(workplace).parent
    assert (
        f"5 of the tasks ended as TIMEOUT and left processes unfinished; their logs are in {logs}" in output
    )
    assert "1 of the tasks never started, and have left the queue (cancelled?)" in output
