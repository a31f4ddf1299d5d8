"""The first day of a user, row by row (`first_day.py`), by the real program."""

import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

from experiments.tests.compare.calls import CAROM, LOOP, left_behind, needs_the_program, run, script, start
from experiments.tests.compare.first_day import CASES, Case
from experiments.tests.conftest import is_running

pytestmark = needs_the_program


FIRST = {case.kind: case.name for case in reversed(CASES)}
"""The first of each kind, which is done with the real program as well as whatever needs a shell around it."""


def call(folder: Path, case: Case) -> "subprocess.CompletedProcess[str]":
    words = ["compare", "--time", case.time, *case.words]
    if not case.through and case.name != FIRST[case.kind]:
        return run(folder, *words)
    line = case.through or '"$@"'
    return subprocess.run(
        ["sh", "-c", line, "sh", str(CAROM), *words], cwd=folder,
        env={**os.environ, "TMPDIR": str(folder / "tmp")},
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=[one.name for one in CASES])
def test_the_first_day(tmp_path: Path, case: Case) -> None:
    (tmp_path / "tmp").mkdir()
    for name, text in case.files.items():
        if "." in name:
            (tmp_path / name).write_text(text, encoding="utf-8")
        else:
            script(tmp_path / name, text)
    subprocess.run(["sh", "-c", case.setup], cwd=tmp_path, check=True)
    done = call(tmp_path, case)
    said = done.stdout + done.stderr
    assert done.returncode in ((0, 5) if case.code is None else (case.code,)), said
    for text in case.told:
        assert text in said
    for text in case.untold:
        assert text not in said
    if case.code == 1:
        assert done.stderr.count("\n") == 1, "one line"
    assert [name for name in case.left if not (tmp_path / name).exists()] == []
    assert [name for name in case.not_left if (tmp_path / name).exists()] == []
    assert [name for name in left_behind(tmp_path) if name not in (*case.left, "a", "b")] == []


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGQUIT, signal.SIGKILL])
def test_what_was_measured_is_kept_however_it_ends(tmp_path: Path, number: signal.Signals) -> None:
    (tmp_path / "tmp").mkdir()
    script(tmp_path / "a", LOOP.format(times=3000) + "; echo $$ > pid")
    words = ("-n", "x", "-n", "y", "--margin", "0.0001%", "--time", "60s", "--append", "kept.json")
    child = start(tmp_path, ["compare", *words, "./a", "./a"], {"TMPDIR": str(tmp_path / "tmp")})
    until = time.monotonic() + 60
    while time.monotonic() < until and not (tmp_path / "kept.json").exists():
        time.sleep(0.05)
    child.send_signal(number)
    output, error = child.communicate(timeout=60)
    ended = -number if number == signal.SIGKILL else 128 + number
    assert child.returncode == ended, output + error
    assert '"sessions"' in (tmp_path / "kept.json").read_text(encoding="utf-8")
    last = int((tmp_path / "pid").read_text() or 0)
    while time.monotonic() < until and (left_behind(tmp_path) or is_running(last)):
        time.sleep(0.05)
    assert left_behind(tmp_path) == []
    assert not is_running(last)


def test_another_measurement_is_waited_for_and_that_is_said(tmp_path: Path) -> None:
    words = ("compare", "-q", "--time", "4s", "touch began; sleep 1.1", "sleep 1")
    first = start(tmp_path, words, {})
    until = time.monotonic() + 60
    while time.monotonic() < until and not (tmp_path / "began").exists():
        time.sleep(0.05)
    second = run(tmp_path, "compare", "-q", "--time", "1ms", "true", "ls", tmp=tmp_path)
    assert f"carom: waits for another measurement (process {first.pid})" in second.stderr
    assert second.stderr.count("waits for") == 1
    told = re.search(r"measured for (\d+) s", second.stdout)
    assert told is not None
    assert int(told[1]) < 3, "the wait, of some three seconds, does not count"
    first.communicate(timeout=60)
