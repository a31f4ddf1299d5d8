"""`carom compare` as a user calls it. Nothing here depends on how fast anything is."""

import signal
import time
from pathlib import Path

import pytest

from experiments.tests.compare.calls import TOOK, left_behind, needs_the_program, printed, run, script, start

pytestmark = needs_the_program


def test_what_takes_a_third_is_faster(folder: Path) -> None:
    done = run(folder, "compare", "./long", "./short", "--time", "60s")
    assert done.returncode in (0, 5), done.stderr
    assert "short against long   −" in done.stdout
    if done.returncode == 0:
        assert "faster by more than 2 %" in done.stdout
        assert "settled after" in done.stdout
    assert left_behind(folder) == []


def test_the_same_under_two_names_is_never_told_apart(folder: Path) -> None:
    done = run(
        folder, "compare", "-n", "one", "-n", "two", "./short", "./short", "--time", "60s", "--margin", "40%"
    )
    assert "two against one" in done.stdout
    assert "slower by more" not in done.stdout
    assert "faster by more" not in done.stdout


def test_a_command_that_hangs_is_stopped(folder: Path) -> None:
    script(folder / "hangs", "sleep 1000")
    done = run(folder, "compare", "./short", "./hangs", "--timeout", "1s")
    assert done.returncode == 2
    assert "hangs: failed after 0 runs" in done.stderr


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["./short", "./not_there"], 'carom: ./not_there: found "./not_there", which is not there'),
        (["./short", "./long", "--export-json", "tmp"], "--export-json: found tmp, which is a folder"),
        (["./short", "./long", "--turns", "0.1ms"], "--turns: found 0.1ms, expected auto, on, off or"),
        (["./short", "./long", "--frobnicate"], "unrecognized arguments: --frobnicate"),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(folder: Path, words: list[str], told: str) -> None:
    done = run(folder, "compare", *words)
    assert done.returncode == 1
    assert done.stdout == ""
    assert told in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_what_there_is(folder: Path, number: signal.Signals) -> None:
    words = ("compare", "./short", "./long", "--margin", "0.0001%", "--export-csv", "rows.csv")
    child = start(folder, words, {"TMPDIR": str(folder / "tmp")})
    until = time.monotonic() + 60
    while time.monotonic() < until and not list(
        folder.glob("tmp/carom-compare-*/records/compare/*/*-b1.json")
    ):
        time.sleep(0.1)
    child.send_signal(number)
    output, error = child.communicate(timeout=60)
    assert child.returncode == 128 + number, output + error
    assert "short   " in output
    assert left_behind(folder) == []
    assert (folder / "rows.csv").exists()


def test_words_behind_dashes_and_another_reference(folder: Path) -> None:
    printed(folder)
    named = ("-q", "-n", "first", "-n", "second", "--reference", "second", "--time", "60s", *TOOK)
    done = run(folder, "compare", *named, "--", "./prints", "100", "1", "--vs", "./prints", "50", "1")
    assert done.returncode == 0, done.stderr
    assert "first against second   +100.0 % [+100.0, +100.0]   slower by more than 2 %" in done.stdout
    assert "control: second against itself" in done.stdout


def test_without_time_for_an_interval_nothing_is_settled(folder: Path) -> None:
    done = run(folder, "compare", "./long", "./short", "--time", "1ms")
    assert done.returncode == 0
    assert "1 block" in done.stdout
    assert "an interval needs 6 blocks" in done.stdout


def test_a_command_that_fails_later_is_told_with_its_runs(folder: Path) -> None:
    script(folder / "wears_out", 'echo x >> count; [ "$(wc -l < count)" -lt 5 ] || exit 1')
    done = run(folder, "compare", "./short", "./wears_out", "--time", "20s", "--turns", "off")
    assert done.returncode == 2
    assert "wears_out: failed after" in done.stderr
    assert "short   " in done.stdout, "what was measured of the others"
