"""What the verb `calibrate` leaves where it cannot begin, and where it is killed."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from experiments.__main__ import main
from experiments.calibration.stream import _blocks

ROOT = Path(__file__).parents[3]
PROGRAM = ROOT / "build" / "gcc" / "carom"
BUILT = PROGRAM.is_file() and (PROGRAM.parent / "harness" / "tests" / "calibration_process").is_file()
needs_programs = pytest.mark.skipif(not BUILT, reason="not built (`make calibrate` builds them)")


def test_a_program_that_is_not_built_is_told_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = tmp_path / "results"
    assert main(["calibrate", "--build", str(tmp_path), "--results", str(results)]) == 1
    assert capsys.readouterr().err.count("\n") == 1
    assert not results.exists()


def test_rounds_that_fill_no_block_are_left_out() -> None:
    rounds = [[float(k)] for k in range(7)]
    assert _blocks(rounds, 3) == [rounds[:3], rounds[3:6]]
    assert _blocks(rounds[:1], 3) == [rounds[:1]]


@needs_programs
def test_a_command_that_is_killed_leaves_no_loop_and_no_result(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "experiments", "calibrate", "--results", str(tmp_path), "--seconds", "1"]
    child = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL)
    until, loops = time.monotonic() + 60, set[int]()
    while not loops and time.monotonic() < until:
        loops = {one for one in children_of(child.pid) if "while True" in words_of(one)}
        time.sleep(0.01)
    assert loops
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    while any("while True" in words_of(one) for one in loops) and time.monotonic() < until:
        time.sleep(0.01)
    assert not any("while True" in words_of(one) for one in loops)
    assert not (tmp_path / "calibration.json").exists()
    json.loads((tmp_path / "unfinished.json").read_text(encoding="utf-8"))


def children_of(process: int) -> list[int]:
    path = Path(f"/proc/{process}/task/{process}/children")
    return [int(word) for word in path.read_text(encoding="ascii").split()] if path.exists() else []


def words_of(process: int) -> str:
    try:
        return Path(f"/proc/{process}/cmdline").read_text(encoding="utf-8")
    except OSError:
        return ""
