"""A cluster's status: a bar, tasks and their fates, and an end that is foretold from what tasks took."""

import json
import re
from collections import Counter
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from experiments.slurm.jobs import Told, Unit, read_told
from experiments.slurm.scheduler import TaskState
from experiments.slurm.status import Tasks, progress_line
from experiments.slurm.task import work
from experiments.tests.conftest import Workplace
from experiments.tests.slurm.fake_slurm import FakeSlurm
from experiments.tests.slurm.test_script import site
from experiments.tests.slurm.test_submit import say

NOON = datetime(2024, 3, 1, 12, tzinfo=UTC)
ONE: list[Unit] = [("pair", 0)]
TOLD = Told(seconds={"pair": [50.0, 70.0], "chunks": [120.0]})


def running(seconds: float, state: str = "RUNNING") -> tuple[TaskState, list[Unit]]:
    return TaskState(state, "None", seconds), ONE


def waiting(*units: Unit) -> tuple[TaskState, list[Unit]]:
    return TaskState("PENDING", "Resources"), list(units or ONE)


def test_the_end_is_foretold_by_what_blocks_have_taken() -> None:
    tasks = Tasks([running(20), running(500)], [waiting(), waiting(("chunks", 1))], at_once=2)
    assert tasks.seconds_left(TOLD) == 120, "no sooner than the longest task"
    assert replace(tasks, at_once=1).seconds_left(TOLD) == 40 + 0 + 60 + 120
    assert Tasks([], [waiting(("chunks", 1))], at_once=4).seconds_left(TOLD) == 120
    assert Tasks([], [waiting(("unknown", 1))], at_once=4).seconds_left(TOLD) == 90, "as others on average"
    counts = Counter({"done": 3, "running": 2, "waiting": 3})
    assert progress_line("xs", counts, tasks, TOLD, NOON) == (
        "xs: [#########---------------] 3 of 8 processes; 2 tasks run, 2 wait; "
        "about 2 min left if 2 run at a time, done at 12:02"
    )


def test_nothing_is_foretold_before_a_block_has_ended() -> None:
    line = progress_line("xs", Counter({"waiting": 4}), Tasks([], [waiting()], 4), Told(), NOON)
    assert line == (
        "xs: [------------------------] 0 of 4 processes; 0 tasks run, 1 wait; "
        "when they will be done is not known: no task has ended yet"
    )


def test_an_end_on_another_day_has_its_date() -> None:
    slow = Told(seconds={"pair": [86400.0]})
    line = progress_line("xs", Counter(done=1, waiting=1), Tasks([], [waiting()], 4), slow, NOON)
    assert line.endswith("about 24 h 00 min left if 1 run at a time, done at 2024-03-02 12:00")


def test_without_tasks_the_line_says_what_helps() -> None:
    nobody = Tasks([], [], 0)
    assert progress_line("xs", Counter(done=1, missing=1), nobody, TOLD, NOON).endswith(
        "1 of 2 processes; no task runs or waits: `carom study resume` submits what is missing"
    )
    assert progress_line("xs", Counter(done=1, missing=1), None, TOLD, NOON).endswith(
        "1 of 2 processes; what runs and waits is not known"
    )
    assert progress_line("xs", Counter(done=2), nobody, TOLD, NOON) == f"xs: [{'#' * 24}] 2 of 2 processes"


def manifest(workplace: Workplace) -> Path:
    return next(workplace.results.rglob("jobs/0001.json"))


def test_status_follows_a_study_from_its_submission_to_its_end(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root)
    say(workplace, "submit")
    output, _ = say(workplace, "status")
    assert "0 of 16 processes; 0 tasks run, 7 wait; when they will be done is not known: no task" in output
    assert "7 of the tasks wait: Resources" in output
    for index in range(3):
        assert work(manifest(workplace), index) == 0
        slurm.becomes(index, "COMPLETED")
    slurm.becomes(3, "RUNNING", elapsed="0:01")
    slurm.becomes(4, "SUSPENDED", elapsed="0:01")
    output, _ = say(workplace, "status")
    assert re.search(r"7 of 16 processes; 2 tasks run, 2 wait; about \d+ s left if 4 run at a time", output)
    assert "; 1 suspended: what the pause cut through is measured again" in output
    for index in range(3, 7):
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


def test_how_long_blocks_took_is_told_of_whole_ones_alone(workplace: Workplace) -> None:
    FakeSlurm(workplace)
    site(workplace.root)
    say(workplace, "submit")
    workplace.behave(FAKE_BENCH_CRASHES="nine")
    codes = [work(manifest(workplace), index) for index in range(7)]
    assert codes.count(2) == 2
    told = read_told(manifest(workplace).parent, "paper")
    assert {name: len(seconds) for name, seconds in told.seconds.items()} == {"chunks": 2, "control": 3}
    assert read_told(manifest(workplace).parent, "quick") == Told()


def test_a_torn_line_of_a_task_is_left_out(workplace: Workplace) -> None:
    FakeSlurm(workplace)
    site(workplace.root)
    say(workplace, "submit")
    whole = json.dumps({"block": ["pair", 0], "seconds": 2.5})
    manifest(workplace).with_name("0001-0.jsonl").write_text(f'{whole}\n[1]\n{{"block": 3}}\n{whole[:20]}')
    assert read_told(manifest(workplace).parent, "paper").means == {"pair": 2.5}
    assert say(workplace, "status")[1] == ""


def test_what_slurm_says_of_tasks_is_told(workplace: Workplace) -> None:
    slurm = FakeSlurm(workplace)
    site(workplace.root)
    say(workplace, "submit")
    work(manifest(workplace), 0)
    manifest(workplace).with_name("0001-1.jsonl").write_text(json.dumps({"processor": "Another"}))
    slurm.ends("TIMEOUT")
    for index in range(6):
        manifest(workplace).with_name(f"0001-{index}.log").touch()
    output, _ = say(workplace, "status")
    assert "xs: its nodes differ, and count as 2 machines: " in output
    logs = manifest(workplace).parent
    assert (
        f"5 of the tasks ended as TIMEOUT and left processes unfinished; their logs are in {logs}" in output
    )
    assert "1 of the tasks never started, and have left the queue (cancelled?)" in output
