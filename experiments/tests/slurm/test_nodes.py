"""Nodes that are not as they should be: fewer processors, pauses."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from experiments.plan.site import Machine
from experiments.slurm import task
from experiments.slurm.jobs import folders
from experiments.slurm.task import work
from experiments.tests.conftest import PAIR, SCENE, Workplace
from experiments.tests.slurm.test_script import site
from experiments.tests.slurm.test_task import job_of

THREADS = f"""
title = "Threads"
figure = "scaling"
{SCENE}
[sweep]
parameter = "threads"
values = [1, 2, 4, 8]

[[series]]
name = "four"
variant = "published"

[blocks]
minimum = 1
wanted = 1
"""


@pytest.fixture
def threads(empty_workplace: Workplace) -> Workplace:
    """A sweep of threads to twice what the site says of a node, which has two cores with two threads each."""
    empty_workplace.question("threads", THREADS)
    return empty_workplace


def job(workplace: Workplace, oversubscribed: str = "false") -> Path:
    """A job for such nodes."""
    keys = f"cpus = 2\nhardware_threads = 4\noversubscribed = {oversubscribed}"
    path = site(workplace.root, "cpus = 2", keys)
    return job_of(workplace, folder=folders(replace(workplace.settings, site=path))[0])


def found(workplace: Workplace, cores: int, hardware_threads: int) -> None:
    """Let a task find so many processors."""
    machine = Machine("none", cores, hardware_threads)
    workplace.monkeypatch.setattr(task, "this_machine", lambda: machine)


def contenders(workplace: Workplace) -> list[dict[str, Any]]:
    paths = sorted(workplace.results.glob("slurm/cluster/xs/records/*/*/*.json"))
    return [one for path in paths for one in json.loads(path.read_text(encoding="utf-8"))["contenders"]]


def records(workplace: Workplace) -> list[dict[str, Any]]:
    return [one for one in contenders(workplace) if "reason" not in one]


def reasons(workplace: Workplace) -> dict[int, str]:
    """Threads of each failed point -> why it failed."""
    return {one["axes"]["threads"]: one["reason"] for one in contenders(workplace) if "reason" in one}


NODES = {
    "as the site says": ((2, 4), {1, 2, 4, 8}),
    "more than the site says": ((8, 16), {1, 2, 4, 8}),
    "no hyperthreads, or a mask of one sibling": ((2, 2), {1, 2}),
    "a mask of both siblings of one core": ((1, 2), {1}),
    "one processor": ((1, 1), {1}),
}


@pytest.mark.parametrize(("node", "measured"), NODES.values(), ids=NODES.keys())
def test_no_point_shares_processors_that_it_was_planned_to_have(
    threads: Workplace, node: tuple[int, int], measured: set[int]
) -> None:
    found(threads, *node)
    assert work(job(threads), 0) == (0 if measured == {1, 2, 4, 8} else 2)
    assert {record["axes"]["threads"] for record in records(threads)} == measured
    assert reasons(threads).keys() == {1, 2, 4, 8} - measured
    assert {one["command"][1] for one in contenders(threads) if "reason" in one} <= {"bench"}
    for refused, reason in reasons(threads).items():
        assert reason.startswith(f"{refused} threads on {node[0]} core")
        assert reason.endswith(
            "the site file says cpus = 2 and hardware_threads = 4: correct it, or say oversubscribed = true"
        )


def test_a_site_may_want_more_threads_than_processors(threads: Workplace) -> None:
    found(threads, 1, 1)
    assert work(job(threads, "true"), 0) == 0
    assert len(records(threads)) == 4


def test_a_pause_is_noticed_and_what_it_cut_through_measured_again_at_once(
    empty_workplace: Workplace,
) -> None:
    empty_workplace.question("pair", PAIR)
    pauses = empty_workplace.root / "pauses"
    pauses.write_text("one\ntwo\n")
    empty_workplace.behave(FAKE_SUSPENDED="turns", FAKE_SUSPENSIONS=str(pauses))
    site(empty_workplace.root)
    assert work(job_of(empty_workplace), 0) == 0
    assert pauses.read_text() == "", "both were met"
    assert len(records(empty_workplace)) == 4
    assert not reasons(empty_workplace)
