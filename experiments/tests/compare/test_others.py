"""What `carom compare` says of other programs that take the processors."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from experiments.compare import others
from experiments.compare.others import Others
from experiments.support.busy import busy
from experiments.tests.compare.calls import needs_the_program, run


def stat(path: Path, idle: int, used: int) -> None:
    """Write the kernel's file, as if each usable processor had been idle and used for so many ticks."""
    lines = [f"cpu{number} {used} 0 0 {idle} 0 0 0 0 0 0" for number in os.sched_getaffinity(0)]
    unusable = f"cpu{max(os.sched_getaffinity(0)) + 1} 0 0 0 1000000 0 0 0 0 0 0"
    path.write_text("\n".join(["cpu 1 2 3 4", *lines, unusable, "intr 5"]) + "\n", encoding="ascii")


@pytest.fixture
def kernel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(others, "_STAT", tmp_path / "stat")
    stat(tmp_path / "stat", 1000, 1000)
    return tmp_path / "stat"


@pytest.mark.parametrize(
    ("idle", "used", "busy_share"), [(0, 100, 1), (50, 50, 0.5), (100, 0, 0)], ids=["full", "half", "idle"]
)
def test_what_is_neither_idle_nor_own_is_of_others(
    kernel: Path, idle: int, used: int, busy_share: float
) -> None:
    seen = Others()
    with seen.watching():
        time.sleep(0.2)
        stat(kernel, 1000 + idle, 1000 + used)
    processors = len(os.sched_getaffinity(0))
    assert seen.busy() == pytest.approx(processors * busy_share, abs=0.3)
    assert (seen.remark() is not None) == (processors * (1 - busy_share) <= 0.5)


def test_own_work_is_not_of_others(kernel: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # One processor of all works all the time, for this process.
    monkeypatch.setattr(others, "_own_seconds", time.monotonic)
    seen, processors = Others(), len(os.sched_getaffinity(0))
    with seen.watching():
        time.sleep(0.2)
        used = 100 // processors
        stat(kernel, 1000 + 100 - used, 1000 + used)
    assert seen.busy() == pytest.approx(0, abs=0.1)
    assert seen.remark() is None


def test_own_work_is_that_of_this_process_and_of_its_children() -> None:
    spent = "import time\nwhile time.process_time() < 0.2: pass"
    before = others._own_seconds()
    subprocess.run([sys.executable, "-c", spent], check=True)
    own = time.process_time()
    while time.process_time() < own + 0.2:
        pass
    assert others._own_seconds() - before >= 0.35


@pytest.mark.parametrize("text", ["", "cpu 1 2 3 4\n", None])
def test_a_system_that_does_not_tell_is_no_quiet_one(kernel: Path, text: str | None) -> None:
    kernel.unlink()
    if text is not None:
        kernel.write_text(text, encoding="ascii")
    seen = Others()
    with seen.watching():
        pass
    assert seen.busy() is None
    assert seen.remark() is None


@needs_the_program
def test_a_busy_machine_is_said(folder: Path) -> None:
    with busy(2 * len(os.sched_getaffinity(0))):
        done = run(folder, "compare", "./short", "./long", "--time", "2s", "--export-json", "a.json")
    assert "the machine was busy: other programs took " in done.stdout
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    assert told["processors_of_others"] > 0.3
