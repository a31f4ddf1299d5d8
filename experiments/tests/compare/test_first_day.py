"""The first day of a user, row by row (`first_day.py`), by the real program."""

import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

from experiments.tests.compare.calls import CAROM, LOOP, left_behind, needs_the_program, script
from experiments.tests.compare.first_day import CASES, Case
from experiments.tests.conftest import is_running

pytestmark = needs_the_program


@pytest.mark.parametrize("case", CASES, ids=[one.name for one in CASES])
def test_the_first_day(tmp_path: Path, case: Case) -> None:
    (tmp_path / "tmp").mkdir()
    for name, text in case.files.items():
        if "." in name:
            (tmp_path / name).write_text(text, encoding="utf-8")
        else:
            script(tmp_path / name, text)
    words = [str(CAROM), "compare", "--time", case.time, *case.words]
    done = subprocess.run(
        ["sh", "-c", f"{case.setup or ':'}\n{case.through or chr(34) + '$@' + chr(34)}", "sh", *words],
        cwd=tmp_path,
        env={**os.environ, "TMPDIR": str(tmp_path / "tmp"), **case.environment},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
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
    words = [
        "-n",
        "x",
        "-n",
        "y",
        "--margin",
        "0.0001%",
        "--time",
        "60s",
        "--append",
        "kept.json",
        "./a",
        "./a",
    ]
    child = subprocess.Popen(
        [CAROM, "compare", *words], cwd=tmp_path, env={**os.environ, "TMPDIR": str(tmp_path / "tmp")}
    )
    until = time.monotonic() + 60
    while time.monotonic() < until and not (tmp_path / "kept.json").exists():
        time.sleep(0.05)
    child.send_signal(number)
    assert child.wait(timeout=60) == (-number if number == signal.SIGKILL else 128 + number)
    assert '"sessions"' in (tmp_path / "kept.json").read_text(encoding="utf-8")
    while time.monotonic() < until and left_behind(tmp_path):
        time.sleep(0.05)
    assert left_behind(tmp_path) == []
    time.sleep(0.5)
    assert not is_running(int((tmp_path / "pid").read_text() or 0))


def test_another_measurement_is_waited_for_and_that_is_said(tmp_path: Path) -> None:
    first = subprocess.Popen(
        [CAROM, "compare", "-q", "--time", "4s", "touch began; sleep 1.1", "sleep 1"], cwd=tmp_path,
        stdout=subprocess.DEVNULL,
    )  # fmt: skip
    until = time.monotonic() + 60
    while time.monotonic() < until and not (tmp_path / "began").exists():
        time.sleep(0.05)
    second = subprocess.run(
        [CAROM, "compare", "-q", "--time", "1ms", "true", "ls"], cwd=tmp_path,
        env={**os.environ, "TMPDIR": str(tmp_path)}, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert f"carom: waits for another measurement (process {first.pid})" in second.stderr
    assert second.stderr.count("waits for") == 1
    told = re.search(r"measured for (\d+) s", second.stdout)
    assert told is not None
    assert int(told[1]) < 3, "the wait, of some three seconds, does not count"
    first.wait(timeout=60)
