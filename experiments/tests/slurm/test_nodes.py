"""Nodes that are not as they should be: fewer processors, pauses, other models, wrong clocks."""

import json
from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from experiments.plan.cluster import Partition
from experiments.plan.point import Point
from experiments.plan.site import Machine
from experiments.results.collect import collect
from experiments.slurm import task
from experiments.slurm.jobs import folders
from experiments.slurm.task import refusal, work
from experiments.tests.conftest import PAIR, SCENE, Workplace
from experiments.tests.slurm.test_script import site
from experiments.tests.slurm.test_task import APART, folder_of, job_of

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
    """Each with the CPU model of its process, if it was measured."""
    paths = sorted(workplace.results.glob("slurm/cluster/xs/records/*/*/*.json"))
    records = [json.loads(path.read_text(encoding="utf-8")) for path in paths]
    model = ({"cpu_model": one.get("provenance", {}).get("cpu_model")} for one in records)
    return [one | own for record, own in zip(records, model, strict=True) for one in record["contenders"]]


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
    for refused, reason in reasons(threads).items():
        assert reason.startswith(f"{refused} threads on {node[0]} core")
        assert reason.endswith(
            "the site file says cpus = 2 and hardware_threads = 4: correct it, or say oversubscribed = true"
        )


def test_a_site_may_want_more_threads_than_processors(threads: Workplace) -> None:
    found(threads, 1, 1)
    assert work(job(threads, "true"), 0) == 0
    assert len(records(threads)) == 4


def test_what_was_refused_is_measured_once_a_node_has_the_processors(threads: Workplace) -> None:
    found(threads, 2, 2)
    assert work(job(threads), 0) == 2
    found(threads, 2, 4)
    assert work(job(threads), 0) == 0
    assert not reasons(threads)
    assert {4, 8} < {record["axes"]["threads"] for record in records(threads)}


def test_the_processors_of_this_machine_are_what_a_task_may_use(threads: Workplace) -> None:
    point: Point = folder_of(threads).study().experiments[0].points[-1]
    refused = refusal(point, Partition("xs", 4096, 4096), Machine("none", 2, 2))
    assert refused is not None
    assert refused.command == (str(point.program.path), "bench")
    assert refused.reason.startswith(
        "8 threads on 2 cores with 2 hardware threads, all that the task may use"
    )


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


def models(workplace: Workplace) -> dict[int, set[str]]:
    """The CPU models of each block of the question `pair` of which a session measured everything."""
    by_session: dict[tuple[int, str], list[str]] = defaultdict(list)
    for one in records(workplace):
        tags = one["tags"]
        if tags["experiment"] == "pair":
            by_session[tags["block"], tags["session"]].append(one["cpu_model"])
    return {block: set(found) for (block, _), found in by_session.items() if len(found) == 2}


def test_a_block_that_one_node_began_is_not_finished_on_another_model(empty_workplace: Workplace) -> None:
    empty_workplace.question("pair", APART)
    site(empty_workplace.root)
    empty_workplace.behave(FAKE_CPU_MODEL="Old", FAKE_BENCH_CRASHES="none")
    manifest = job_of(empty_workplace)
    assert work(manifest, 0) == 0
    cut = sorted(empty_workplace.results.glob("slurm/cluster/xs/records/pair/*/*-b1.json"))
    cut[0].unlink()
    empty_workplace.behave(FAKE_CPU_MODEL="New", SLURM_RESTART_COUNT="1")
    assert work(manifest, 0) == 0, "the same task, started again on another node"
    assert work(job_of(empty_workplace), 0) == 0, "and what resume submits"
    assert models(empty_workplace) == {0: {"Old"}, 1: {"New"}}
    assert len(records(empty_workplace)) == 4


@pytest.mark.parametrize("clock", ["1999-01-01T00:00:00Z", "2099-01-01T00:00:00Z"])
def test_a_wrong_clock_mixes_no_sessions(empty_workplace: Workplace, clock: str) -> None:
    empty_workplace.question("pair", APART)
    site(empty_workplace.root)
    manifest = job_of(empty_workplace)
    assert work(manifest, 0) == 0
    source = empty_workplace.results / "slurm" / "cluster" / "xs"
    collect([source], empty_workplace.results)
    first = {one["tags"]["session"] for one in records(empty_workplace)}
    for path in source.glob("records/pair/*/*.json"):
        record = json.loads(path.read_text())
        record["recorded_at"] = clock
        record["contenders"][0]["tags"]["session"] = "of-the-twin"
        path.write_text(json.dumps(record))
    collect([source], empty_workplace.results)
    collected = empty_workplace.results.glob("records/collected/*/pair/*/*.json")
    sessions = {json.loads(path.read_text())["contenders"][0]["tags"]["session"] for path in collected}
    assert len(sessions) == 1, "whichever twin's clock is ahead, a block is of one of them"
    assert sessions <= first | {"of-the-twin"}


def test_blocks_are_told_apart_without_any_clock(
    empty_workplace: Workplace, monkeypatch: pytest.MonkeyPatch
) -> None:
    empty_workplace.question("pair", APART)
    site(empty_workplace.root)
    manifest = job_of(empty_workplace, tasks=2)
    for index, year in ((0, 2099), (1, 1999)):
        session = f"{year}0101T000000.000000-n{index}-1"
        monkeypatch.setattr("experiments.run.study.new_session", lambda session=session: session)
        assert work(manifest, index) == 0
    study = folders(folder_of(empty_workplace).settings)[0].study()
    assert models(empty_workplace) == {0: {"none"}, 1: {"none"}}
    assert len(study.store.find(study.experiments[0]).seconds) == 4
