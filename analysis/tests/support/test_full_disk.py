"""No room, and no permission, for figures and the report: one line, and what was there stays."""

import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import study

ROOT = Path(__file__).parents[3]


def analyse(*words: object, most_bytes: int | None = None) -> "subprocess.CompletedProcess[str]":
    def limit() -> None:
        if most_bytes is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))

    command = [sys.executable, "-m", "analysis", *map(str, words)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, preexec_fn=limit)


@pytest.fixture
def results(tmp_path: Path) -> Path:
    write(tmp_path, study(["steps"], blocks=2, noise=QUIET))
    return tmp_path


@pytest.mark.parametrize("verb", ["figures", "report"])
def test_no_room_is_one_line_and_leaves_what_was_there(results: Path, verb: str) -> None:
    earlier = results / "figures" / "steps.svg"
    earlier.parent.mkdir()
    earlier.write_text("as it was")
    done = analyse(verb, "--results", results, most_bytes=5_000)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert "File too large, expected a writable place with room" in line
    assert earlier.read_text() == "as it was"
    assert [path.name for path in results.rglob("*.part*")] == []


def test_a_figures_folder_that_cannot_be_written_is_one_line(results: Path) -> None:
    (results / "figures").touch()
    done = analyse("figures", "--results", results)
    assert done.returncode == 1
    assert done.stderr.splitlines() == [
        f"carom: {results}/figures: File exists, expected a writable place with room"
    ]


def test_nobody_to_read_the_output_is_no_error(results: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "analysis", "claims", "--results", str(results)]
    done = subprocess.run(command, cwd=ROOT, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writing)
    assert "Traceback" not in done.stderr
    assert done.returncode == 1
