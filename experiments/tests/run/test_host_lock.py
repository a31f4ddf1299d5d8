"""The lock of a host: measurements on one host never overlap."""

import itertools
import subprocess
import sys
import time

import pytest

from experiments.run.host_lock import host_lock
from experiments.tests.conftest import ERRORS, Workplace
from experiments.tests.run.test_limits import LIMITS
from support.errors import InputError

ANOTHER = """
import sys, time
from experiments.run.host_lock import host_lock
with host_lock():
    print(time.monotonic(), flush=True)
    time.sleep(float(sys.argv[1]))
    print(time.monotonic(), flush=True)
"""


def another(seconds: float) -> "subprocess.Popen[str]":
    command = [sys.executable, "-c", ANOTHER, str(seconds)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def times(process: "subprocess.Popen[str]") -> list[float]:
    return [float(line) for line in process.communicate(timeout=60)[0].split()]


def test_what_two_processes_do_under_it_does_not_overlap() -> None:
    spans = sorted(times(process) for process in [another(0.3), another(0.3), another(0.3)])
    assert all(len(span) == 2 for span in spans)
    assert all(before[1] <= after[0] for before, after in itertools.pairwise(spans))


def test_what_two_runners_run_does_not_overlap(empty_workplace: Workplace) -> None:
    place = empty_workplace
    place.question("close", LIMITS)
    place.question("errors", ERRORS)
    spans = place.root / "spans"
    place.behave(FAKE_SPANS=str(spans), FAKE_SECONDS="0.02", FAKE_CHECK_SECONDS="0.05")
    runners = [place.start("run", "--no-figures", "--results", name) for name in ("one", "two")]
    for runner in runners:
        _, error = runner.communicate(timeout=120)
        assert runner.returncode == 0
        assert all("waits for another measurement (process " in line for line in error.splitlines())
    lines = [line.split() for line in spans.read_text(encoding="utf-8").splitlines()]
    assert {verb for verb, _, _ in lines} == {"bench", "check", "limits", "profile", "turns"}
    times_of = sorted((float(began), float(ended), verb) for verb, began, ended in lines)
    for before, after in itertools.pairwise(times_of):
        assert before[1] <= after[0], f"{after[2]} began before {before[2]} had ended"


def test_a_killed_process_gives_it_up() -> None:
    killed = another(600)
    assert killed.stdout is not None
    killed.stdout.readline()
    killed.kill()
    killed.wait()
    before = time.monotonic()
    with host_lock():
        assert time.monotonic() - before < 60


def test_within_a_measurement_none_begins() -> None:
    with host_lock():
        child = subprocess.run(
            [sys.executable, "-c", ANOTHER, "0"], stderr=subprocess.PIPE, text=True, timeout=60, check=False
        )
        with pytest.raises(InputError, match="runs within another measurement"), host_lock():
            pass
    assert "runs within another measurement (process " in child.stderr
