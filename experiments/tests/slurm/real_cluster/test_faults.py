"""What clusters do to jobs: nodes die, tasks are cancelled, time runs out; nothing is lost or doubled."""

import json
import random
import re
import time
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from experiments.tests.conftest import until
from experiments.tests.slurm.real_cluster.cluster import MAX_ARRAY_SIZE, node_of
from experiments.tests.slurm.real_cluster.conftest import MACHINE, ClusterWorkplace

PARTITION = "w5-3423"
KILLS = 4


def measurements(place: ClusterWorkplace) -> Counter[str]:
    """How often each block was measured."""
    words = [call["words"] for call in place.measured() if "experiment=machine" in call["words"]]
    return Counter(next(word for word in one if word.startswith("block=")) for one in words)


def contents(paths: list[Path]) -> dict[Path, Any]:
    return {path: json.loads(path.read_text(encoding="utf-8")) for path in paths}


def blocks(place: ClusterWorkplace, number: int) -> None:
    limits = f"minimum = {number}\nwanted = {number}"
    place.workplace.question("machine", MACHINE.replace("minimum = 5\nwanted = 5", limits))


def test_a_node_dies_in_mid_task_and_comes_back(place: ClusterWorkplace) -> None:
    place.site(PARTITION, common="blocks_per_task = 5")
    place.workplace.behave(FAKE_SECONDS="1")
    place.say("submit")
    until(lambda: len(place.records()) == 2, "the task does not begin", 30)
    place.cluster.lose_power(node_of(PARTITION))
    before = contents(place.records())
    assert len(before) in (2, 3)
    place.cluster.start_node(node_of(PARTITION))
    until(lambda: len(place.records()) == 5, "the task does not go on", 90)
    place.cluster.wait_until_idle()
    after = contents(place.records())
    assert before.items() <= after.items(), "what was finished is there, unchanged"
    restarts = [record["provenance"]["slurm"].get("SLURM_RESTART_COUNT") for record in after.values()]
    assert Counter(restarts) == {None: len(before), "1": 5 - len(before)}
    assert sum(measurements(place).values()) <= 6, "only the process that was cut off ran twice"
    assert "nothing to submit; all is measured" in place.say("resume")


def test_a_task_that_is_requeued_goes_on_by_itself(place: ClusterWorkplace) -> None:
    place.site(PARTITION, common="blocks_per_task = 5")
    place.workplace.behave(FAKE_SECONDS="0.5")
    place.say("submit")
    until(lambda: len(place.records()) == 1, "the task does not begin", 30)
    place.cluster.ask("scontrol", "requeue", place.cluster.tasks("RUNNING")[0])
    assert "nothing to submit; the rest waits or runs" in place.say("resume")
    # Slurm itself lets a job that was requeued wait for two minutes.
    place.cluster.start_at_once()
    place.cluster.wait_until_idle()
    assert len(place.records()) == 5
    assert sum(measurements(place).values()) <= 6, "only the process that was cut off ran twice"
    assert "nothing to submit; all is measured" in place.say("resume")


def test_a_task_that_is_suspended_is_told_and_goes_on(place: ClusterWorkplace) -> None:
    place.site(PARTITION, common="blocks_per_task = 5")
    place.workplace.behave(FAKE_SECONDS="0.5")
    place.say("submit")
    until(lambda: len(place.records()) == 1, "the task does not begin", 30)
    task = place.cluster.tasks("RUNNING")[0]
    place.cluster.ask("scontrol", "suspend", task)
    said = place.say("status")
    assert "1 task runs, 0 wait; about " in said
    assert "; 1 suspended: what the pause cut through is measured again" in said
    assert "nothing to submit; the rest waits or runs" in place.say("resume")
    place.cluster.ask("scontrol", "resume", task)
    place.cluster.wait_until_idle()
    assert len(place.records()) == 5


def test_half_an_array_cancelled_is_what_resume_submits(place: ClusterWorkplace) -> None:
    place.site(PARTITION, common="at_once = 1")
    place.workplace.behave(FAKE_SECONDS="0.3")
    blocks(place, 6)
    number = re.search(r"job (\d+), 6 processes in 6 tasks", place.say("submit"))
    assert number is not None
    place.cluster.ask("scancel", f"{number.group(1)}_[3-5]")
    assert "nothing to submit; the rest waits or runs" not in place.say("resume", "--dry-run")
    place.cluster.wait_until_idle()
    assert measurements(place) == {f"block={block}": 1 for block in range(3)}
    assert re.search(rf"^{PARTITION} +machine +3 +0 +0 +0 +3$", place.say("status"), re.MULTILINE)
    said = place.say("status")
    assert "3 of the tasks never started, and have left the queue (cancelled?)" in said
    assert (
        f"{PARTITION}: [{'#' * 12}{'-' * 12}] 3 of 6 processes; no task runs or waits: `carom study" in said
    )
    assert ", 3 processes in 3 tasks" in place.say("resume")
    place.cluster.wait_until_idle()
    assert measurements(place) == {f"block={block}": 1 for block in range(6)}
    assert re.search(rf"^{PARTITION} +machine +6 +0 +0 +0 +0$", place.say("status"), re.MULTILINE)


def test_tasks_killed_at_random_moments_lose_at_most_the_point_they_were_on(place: ClusterWorkplace) -> None:
    place.site(PARTITION, common="blocks_per_task = 12")
    place.workplace.behave(FAKE_SECONDS="0.5")
    blocks(place, 12)
    moments = random.Random(20240301)
    finished: dict[Path, Any] = {}
    place.say("submit")
    for _ in range(KILLS):
        until(lambda: len(place.cluster.tasks("RUNNING")) == 1, "no task runs", 30)
        time.sleep(moments.uniform(0, 2))
        place.cluster.ask("scancel", "--signal=KILL", "--full", "--me")
        place.cluster.wait_until_idle()
        now = contents(place.records())
        assert finished.items() <= now.items(), "what was finished is there, unchanged"
        finished = now
        place.say("resume")
    assert len(finished) < 12, "some of the kills hit a task at work"
    place.cluster.wait_until_idle()
    after = contents(place.records())
    assert len(after) == 12
    assert finished.items() <= after.items()
    counts = measurements(place)
    assert counts.keys() == {f"block={block}" for block in range(12)}
    assert counts.total() <= 12 + KILLS, "a kill costs no more than one process"


def test_what_waits_or_runs_is_not_submitted_again(place: ClusterWorkplace) -> None:
    place.site(PARTITION, common="at_once = 1")
    place.workplace.behave(FAKE_SECONDS="3")
    place.say("submit")
    until(lambda: len(place.cluster.tasks("RUNNING")) == 1, "no task runs", 30)
    assert place.say("resume") == f"{PARTITION}: nothing to submit; the rest waits or runs\n"
    said = place.say("status")
    assert re.search(rf"^{PARTITION} +machine +0 +1 +4 +0 +0$", said, re.MULTILINE)
    assert "4 of the tasks wait: JobArrayTaskLimit" in said


def test_a_point_that_fails_is_told_with_its_reason(place: ClusterWorkplace) -> None:
    place.site(PARTITION)
    place.workplace.behave(FAKE_BENCH_CRASHES="published")
    place.say("submit")
    place.cluster.wait_until_idle()
    said = place.say("status")
    assert re.search(rf"^{PARTITION} +machine +0 +0 +0 +5 +0$", said, re.MULTILINE)
    assert f"{PARTITION}: machine: 5 failed: killed by SIGABRT: out of memory" in said


def test_arrays_stay_below_the_largest_that_the_cluster_takes(place: ClusterWorkplace) -> None:
    place.site(PARTITION)
    blocks(place, MAX_ARRAY_SIZE + 4)
    assert "20 processes in 10 tasks" in place.say("submit")
    place.cluster.wait_until_idle()
    assert len(place.records()) == MAX_ARRAY_SIZE + 4


@pytest.mark.slow
def test_a_task_at_its_time_limit_keeps_what_it_finished(place: ClusterWorkplace) -> None:
    place.site(PARTITION, common="blocks_per_task = 16", each="hardware_threads = 24\nminutes = 1")
    place.workplace.behave(FAKE_SECONDS="7")
    blocks(place, 16)
    place.say("submit")
    place.cluster.wait_until_idle(150)
    finished = contents(place.records())
    assert 0 < len(finished) < 16
    log = next(place.folder(PARTITION).glob("jobs/*.log")).read_text()
    assert "stopped: what is finished is kept" in log
    assert log.count("measured in") == len(finished)
    assert not list(place.folder(PARTITION).glob(".running/*"))
    assert not place.workplace.failures()
    assert re.search("1 of the tasks ended as (TIMEOUT|FAILED) and left processes unfin", place.say("status"))
    place.workplace.behave(FAKE_SECONDS="0")
    assert f"{16 - len(finished)} processes in 1 tasks" in place.say("resume")
    place.cluster.wait_until_idle()
    assert len(place.records()) == 16
    assert finished.items() <= contents(place.records()).items()
