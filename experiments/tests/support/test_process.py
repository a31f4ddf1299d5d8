"""Child processes: their end is told in one line, and they end with their parent."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from experiments.support import process
from experiments.support.pipes import KEPT_BYTES
from experiments.support.process import NOT_FOUND, TIMED_OUT, Coprocess, run
from experiments.tests.conftest import ROOT, is_running, until
from support.errors import Interrupted


def python(code: str) -> list[str]:
    return [sys.executable, "-IS", "-c", code]


REASONS = {
    "last line": ("import sys; print('first\\nlast', file=sys.stderr); sys.exit(1)", "last"),
    "silence": ("import sys; sys.exit(4)", "exit code 4 without a word"),
    "signal": ("import os; os.kill(os.getpid(), 9)", "killed by SIGKILL"),
    "signal without a name": ("import os; os.kill(os.getpid(), 40)", "killed by signal 40"),
    "signal with a word": (
        "import os, sys; print('oh', file=sys.stderr); os.abort()",
        "killed by SIGABRT: oh",
    ),
    "no text": ("import sys; sys.stderr.buffer.write(b'\\xff!\\n'); sys.exit(1)", "\ufffd!"),
}


@pytest.mark.parametrize(("code", "reason"), REASONS.values(), ids=REASONS.keys())
def test_the_reason_is_one_line(code: str, reason: str) -> None:
    assert run(python(code)).reason == reason


def test_an_interruption_is_no_failed_point() -> None:
    assert not issubclass(Interrupted, Exception)


ECHO = """
import sys
from pathlib import Path
for line in sys.stdin:
    if line == 'fail\\n':
        sys.exit('it fails')
    if line == 'murmur\\n':
        print('on the side', file=sys.stderr)
    if line == 'sleep\\n':
        __import__('time').sleep(600)
    print(__import__('os').getpid(), line.strip(), flush=True)
"""


def test_a_companion_answers_again_and_again_also_on_the_side() -> None:
    asked = ("murmur", "more", "murmur", "murmur")
    with Coprocess(python(ECHO)) as coprocess:
        answers = [coprocess.ask(word, time_limit=20) for word in asked]
    numbers, said = zip(*(one.output.split() for one in answers), strict=True)
    assert said == asked
    assert len({*numbers}) == 1, "the same process"
    assert not Path(f"/proc/{numbers[0]}").exists(), "it ends with its context"
    assert [one.error for one in answers] == ["on the side\n", "", "on the side\n", "on the side\n"]


@pytest.mark.parametrize(
    ("word", "limit", "code", "reason"),
    [("fail", 20, 1, "it fails"), ("sleep", 0.3, TIMED_OUT, "took longer than 0.3 s and was stopped")],
)
def test_a_companion_that_fails_says_why_and_starts_anew(
    word: str, limit: float, code: int, reason: str
) -> None:
    with Coprocess(python(ECHO)) as coprocess:
        for _ in range(2):
            failed = coprocess.ask(word, time_limit=limit)
            assert (failed.exit_code, failed.reason) == (code, reason)
        assert coprocess.ask("more", time_limit=20).output.endswith("more\n")


DESCENDANTS = {
    "in its group": "subprocess.Popen(['sleep', '600'])",
    "in a session of its own": "subprocess.Popen(['sleep', '600'], start_new_session=True)",
    "a daemon's child": "subprocess.Popen(['sh', '-c', 'sleep 600 & sleep 600'], start_new_session=True)",
    "that ignores signals": "subprocess.Popen(['sh', '-c', 'trap \"\" TERM HUP; sleep 600 & wait; wait'])",
}


@pytest.mark.parametrize("started", DESCENDANTS.values(), ids=DESCENDANTS.keys())
@pytest.mark.parametrize("ends", [True, False], ids=["its parent ended", "its parent ran out of time"])
def test_a_descendant_that_holds_the_pipes_keeps_nobody_waiting_and_ends_too(
    started: str, ends: bool
) -> None:
    mark = f"carom-test-{os.getpid()}-{time.monotonic_ns()}"
    code = f"import os, subprocess; os.environ['MARK'] = '{mark}'; {started}; print('out', flush=True)"
    rest = "" if ends else "; import time; time.sleep(600)"
    done = run(python(code + rest), time_limit=100 if ends else 0.7)
    assert (done.exit_code, done.output) == ((0, "out\n") if ends else (TIMED_OUT, ""))
    assert marked(mark) == []


def marked(mark: str) -> list[str]:
    """The processes, zombies aside, with that word in their environment."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if mark.encode() in (folder / "environ").read_bytes():
                found.append(folder.name)
        except OSError:
            continue
    return found


def test_a_child_that_ignores_the_wish_to_end_is_ended() -> None:
    code = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(600)"
    done = run(python(code), time_limit=0.3)
    assert (done.exit_code, done.reason) == (TIMED_OUT, "took longer than 0.3 s and was stopped")


def test_what_was_there_before_is_left_alone() -> None:
    with subprocess.Popen(["sleep", "600"]) as other:
        assert run(python("pass")).exit_code == 0
        assert other.poll() is None
        other.kill()


def test_of_much_output_the_end_is_kept_and_the_rest_counted() -> None:
    code = "import sys\nfor _ in range(300): sys.stdout.write('x' * 1_000_000)\nprint('the end')"
    done = run(python(code))
    assert done.exit_code == 0
    assert done.output.endswith("xxx" + "the end\n")
    assert KEPT_BYTES <= len(done.output) < 2 * KEPT_BYTES
    assert len(done.output) + done.dropped == 300_000_000 + len("the end\n")


def test_a_reason_of_one_endless_line_is_cut() -> None:
    done = run(python("import sys; sys.exit('x' * 1_000_000 + ' the reason')"))
    assert len(done.reason) <= 500
    assert done.reason.endswith(" the reason")


def test_closed_pipes_are_no_end() -> None:
    code = "import os, sys, time\nos.close(1); os.close(2); time.sleep(0.3); os._exit(3)"
    assert run(python(code)).exit_code == 3


def test_nothing_waits_for_standard_input_or_a_terminal() -> None:
    code = "import sys; print(repr(sys.stdin.read()), sys.stdin.isatty()); open('/dev/tty', 'w')"
    done = run(python(code), time_limit=100)
    assert (done.exit_code, done.output) == (1, "'' False\n")
    assert "/dev/tty" in done.reason


def test_what_cannot_be_run_says_why_and_no_shell_tries(tmp_path: Path) -> None:
    for name, content in (("empty", b""), ("foreign", b"\x7fELF\x02\x01\x01")):
        (tmp_path / name).write_bytes(content)
        (tmp_path / name).chmod(0o755)
    of_words = {
        ("/nowhere/carom", "list"): "No such file or directory",
        ("echo", "a\0b"): "embedded null byte",
        (str(tmp_path / "empty"),): "Exec format error",
        (str(tmp_path / "foreign"),): "Exec format error",
    }
    for words, why in of_words.items():
        done = run(words)
        assert (done.exit_code, done.reason) == (NOT_FOUND, f"{words[0]}: cannot be run: {why}")


RUNNER = f"""
import signal, sys
sys.path.insert(0, {str(ROOT)!r})
from experiments.support import pipes, process
pipes._LATE_SECONDS = 0.2
done = process.run([sys.executable, "-IS", "-c", sys.argv[1]], time_limit=float(sys.argv[2]))
print(done.exit_code, done.reason)
"""


def runner(code: str, time_limit: float, *, ignores_ends: bool = False) -> "subprocess.Popen[str]":
    """A process that runs a child of that code."""

    def ignore() -> None:
        signal.signal(signal.SIGCHLD, signal.SIG_IGN)

    command = [*python(RUNNER), code, str(time_limit)]
    prepare = ignore if ignores_ends else None
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=prepare)


def test_the_end_of_a_child_is_known_also_where_ends_are_ignored() -> None:
    output, _ = runner("import sys; sys.exit(3)", 100, ignores_ends=True).communicate()
    assert output == "3 exit code 3 without a word\n"


def test_a_child_ends_with_its_parent_however_that_ends(tmp_path: Path) -> None:
    began = tmp_path / "began"
    code = f"import os, pathlib, time; pathlib.Path({str(began)!r}).write_text(str(os.getpid()))"
    parent = runner(f"{code}; time.sleep(600)", 600)
    until(lambda: began.exists() and began.read_text(), "the child does not begin")
    parent.kill()
    parent.communicate()
    until(lambda: not is_running(int(began.read_text())), "the child goes on", 10)


def test_an_unknown_end_is_no_success(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(process, "hear_of_ends", lambda: None)
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    try:
        with pytest.raises(ChildProcessError):
            run(python("import sys; sys.exit(3)"))
    finally:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)


@pytest.mark.parametrize("ends", [True, False], ids=["a child that ended meanwhile", "one that goes on"])
def test_while_the_runner_stands_still_no_time_passes_for_its_child(tmp_path: Path, ends: bool) -> None:
    """It is stopped for longer than its child may take."""
    began, go = tmp_path / "began", tmp_path / "go"
    wait = f"import pathlib, time\npathlib.Path({str(began)!r}).touch()\n"
    wait += f"while not pathlib.Path({str(go)!r}).exists(): time.sleep(0.01)\nprint('x')"
    stopped = runner(wait, 2.0)
    until(began.exists, "the child does not begin")
    stopped.send_signal(signal.SIGSTOP)
    if ends:
        go.touch()
    time.sleep(2.5)
    stopped.send_signal(signal.SIGCONT)
    if not ends:
        time.sleep(0.2)
        go.touch()
    output, _ = stopped.communicate(timeout=60)
    assert output.startswith("0 ")
