"""The verb `calibrate`, with the real program; what it leaves where it cannot begin or is killed."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.__main__ import main
from experiments.calibration.command import CONDITIONS, FILE, UNFINISHED
from experiments.calibration.kinds import KINDS, PERCENT_MORE
from experiments.calibration.stream import _blocks
from experiments.support.busy import busy
from experiments.support.descendants import children
from experiments.tests.conftest import ROOT, finish, is_running, start, until

PROGRAM = ROOT / "build" / "gcc" / "carom"
WORKERS = [PROGRAM.parent / "harness" / "tests" / f"calibration_{name}" for name in ("process", "benchmark")]
COMMAND = [sys.executable, "-m", "experiments", "calibrate", "--seconds", "0.1", "--results"]

needs_programs = pytest.mark.skipif(
    not all(path.exists() for path in (PROGRAM, *WORKERS)), reason="`make calibrate` has built nothing here"
)


@needs_programs
def test_six_streams_come_into_one_file_and_what_was_begun_is_gone_on_with(tmp_path: Path) -> None:
    subprocess.run([*COMMAND, str(tmp_path)], cwd=ROOT, check=True, timeout=120)
    content = json.loads((tmp_path / FILE).read_text(encoding="utf-8"))
    assert [(one["kind"], one["condition"]) for one in content["streams"]] == [
        (kind.__name__, condition) for kind in KINDS for condition in CONDITIONS
    ]
    for one in content["streams"]:
        assert all(len(row) == len(PERCENT_MORE) for block in one["blocks"] for row in block)
        assert all(seconds > 0 for block in one["blocks"] for row in block for seconds in row)
    begun = {**content, "streams": content["streams"][:5]}
    (tmp_path / UNFINISHED).write_text(json.dumps(begun), encoding="utf-8")
    subprocess.run([*COMMAND, str(tmp_path)], cwd=ROOT, check=True, timeout=120)
    again = json.loads((tmp_path / FILE).read_text(encoding="utf-8"))
    assert again["streams"][:5] == begun["streams"]
    assert again["streams"][5] != content["streams"][5]
    assert not (tmp_path / UNFINISHED).exists()


def test_seconds_that_cannot_be_are_one_line(tmp_path: Path) -> None:
    for wrong in ("0", "-1", "nan", "x"):
        words = ["calibrate", "--seconds", wrong, "--results", str(tmp_path)]
        code, _, error = finish(start(words, ROOT))
        assert code != 0
        assert f"found {wrong}, expected a number of seconds above 0" in error


def test_the_loops_beside_end_with_the_block() -> None:
    before = children()
    with busy(2):
        inside = children() - before
        assert len(inside) == 2
    assert not any(map(is_running, inside))


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
    child = subprocess.Popen([*COMMAND, str(tmp_path)], cwd=ROOT, stdout=subprocess.DEVNULL)
    path, loops = Path(f"/proc/{child.pid}/task/{child.pid}/children"), set[int]()

    def begun() -> set[int]:
        loops.update(one for one in map(int, path.read_text().split()) if "while True" in words_of(one))
        return loops

    until(begun, "no loop begins")
    child.kill()
    child.wait()
    until(lambda: not any("while True" in words_of(one) for one in loops), "a loop goes on")
    assert not (tmp_path / FILE).exists()
    json.loads((tmp_path / UNFINISHED).read_text(encoding="utf-8"))


def words_of(process: int) -> str:
    try:
        return Path(f"/proc/{process}/cmdline").read_text(encoding="utf-8")
    except OSError:
        return ""
