"""The verb `calibrate`, with the real program."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.calibration.command import CONDITIONS, FILE, UNFINISHED
from experiments.calibration.kinds import KINDS, PERCENT_MORE
from experiments.support.busy import busy
from experiments.support.descendants import children
from experiments.tests.conftest import ROOT, finish, is_running, start

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
