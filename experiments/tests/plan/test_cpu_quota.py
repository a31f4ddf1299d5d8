"""The CPU quota of made-up control groups, and the machine that a study plans for under one."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from experiments.plan import site
from experiments.plan.cpu_quota import read_cpu_quota
from experiments.run.session import run
from experiments.run.status import show_plan
from experiments.tests.conftest import ROOT, Workplace

CASES: list[dict[str, Any]] = json.loads(
    (ROOT / "harness" / "tests" / "machine" / "cpu_quotas.json").read_text(encoding="utf-8")
)


@pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])
def test_the_quota_is_the_one_that_the_program_reads(case: dict[str, Any], tmp_path: Path) -> None:
    for name, content in case["files"].items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")
    assert read_cpu_quota(tmp_path) == case["quota"]


def limited(monkeypatch: pytest.MonkeyPatch, quota: float | None, processors: int = 8) -> None:
    """A machine of so many processors, each a core of its own, all of which the process may use."""
    numbers = set(range(100_000, 100_000 + processors))
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: numbers)
    monkeypatch.setattr(os, "cpu_count", lambda: processors)
    monkeypatch.setattr(site, "read_cpu_quota", lambda: quota)


@pytest.mark.parametrize(
    ("quota", "threads"), [(None, 8), (16.0, 8), (8.0, 8), (2.9, 2), (1.0, 1), (0.25, 1)]
)
def test_threads_follow_the_quota(quota: float | None, threads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    limited(monkeypatch, quota)
    machine = site.this_machine()
    assert (machine.cores, machine.hardware_threads) == (threads, threads)
    assert bool(site.what_limits()) == (threads < 8)


def test_what_limits_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    limited(monkeypatch, 1.5)
    assert (
        site.what_limits()
        == "this machine counts as one with 1 hardware thread, because of a CPU quota of 1.5 processors"
    )
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    assert "an affinity of 8 of 64 processors and a CPU quota of 1.5 processors" in site.what_limits()
    monkeypatch.setattr(site, "read_cpu_quota", lambda: None)
    assert (
        site.what_limits()
        == "this machine counts as one with 8 hardware threads, because of an affinity of 8 of 64 processors"
    )


def test_plan_and_run_name_the_quota(
    workplace: Workplace, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    limited(monkeypatch, 1.5)
    show_plan(workplace.settings)
    assert "because of a CPU quota of 1.5 processors" in capsys.readouterr().out
    assert run(workplace.settings) == 0
    assert "because of a CPU quota of 1.5 processors" in capsys.readouterr().out
    threads = {record["axes"]["threads"] for record in workplace.records().values()}
    assert threads == {1}
