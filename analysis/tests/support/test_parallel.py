"""Calls spread over processes: all of them, in order, with what they raise."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from analysis.support.parallel import in_parallel

ROOT = Path(__file__).parents[3]


@pytest.fixture(autouse=True)
def _four_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2, 3})


@pytest.mark.parametrize("count", [0, 1, 2, 9])
def test_results_come_in_order(count: int) -> None:
    offset = 5
    assert list(in_parallel(lambda number: number + offset, count)) == [n + 5 for n in range(count)]


def test_they_come_from_other_processes() -> None:
    assert os.getpid() not in in_parallel(lambda _: os.getpid(), 4)


def test_one_processor_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {3})
    assert list(in_parallel(lambda _: os.getpid(), 3)) == [os.getpid()] * 3


def test_what_is_raised_there_is_raised_here() -> None:
    def fail(number: int) -> int:
        raise OSError(28, "No space left on device", f"file {number}")

    with pytest.raises(OSError, match="No space left on device: 'file 0'") as raised:
        list(in_parallel(fail, 3))
    assert raised.value.filename == "file 0"


def test_no_library_has_threads_that_a_fork_would_lose_and_none_that_is_slow_to_load_is_loaded() -> None:
    slow = "{'scipy.stats', 'matplotlib.backends.backend_pdf'}"
    script = "import analysis.report, os, sys; "
    script += f"print(len(os.listdir('/proc/self/task')), {slow} & set(sys.modules))"
    settings = {key: value for key, value in os.environ.items() if not key.endswith("_NUM_THREADS")}
    done = subprocess.run(
        [sys.executable, "-c", script], env=settings, cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout == "1 set()\n"


SLEEPERS = r"""
import os, time
os.sched_getaffinity = lambda _: {0, 1, 2, 3}
from analysis.support.parallel import in_parallel
def sleep(number):
    os.write(1, f"{os.getpid()}\n".encode())  # at once, whoever else writes
    time.sleep(600)
list(in_parallel(sleep, 3))
"""


def test_they_end_with_a_parent_that_is_killed() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", SLEEPERS], stdout=subprocess.PIPE, text=True, cwd=ROOT
    ) as parent:
        assert parent.stdout is not None
        try:
            children = [int(parent.stdout.readline()) for _ in range(3)]
        finally:
            os.kill(parent.pid, signal.SIGKILL)
        until = time.monotonic() + 20
        while any(is_running(child) for child in children):
            assert time.monotonic() < until, "they go on without their parent"
            time.sleep(0.01)


def is_running(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
