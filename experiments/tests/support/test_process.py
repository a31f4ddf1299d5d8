"""Child processes: their end is told in one line, and they end with their parent."""

import sys
from pathlib import Path

import pytest

from experiments.support.errors import Interrupted
from experiments.support.process import NOT_FOUND, TIMED_OUT, Coprocess, run


def python(code: str) -> list[str]:
    return [sys.executable, "-IS", "-c", code]


def test_output_and_exit_code() -> None:
    done = run(python("print('out'); import sys; sys.exit(3)"))
    assert (done.exit_code, done.output) == (3, "out\n")


REASONS = {
    "last line": ("import sys; print('first\\nlast', file=sys.stderr); sys.exit(1)", "last"),
    "silence": ("import sys; sys.exit(4)", "exit code 4 without a word"),
    "signal": ("import os; os.kill(os.getpid(), 9)", "killed by SIGKILL"),
    "signal with a word": (
        "import os, sys; print('oh', file=sys.stderr); os.abort()",
        "killed by SIGABRT: oh",
    ),
    "no text": ("import sys; sys.stderr.buffer.write(b'\\xff!\\n'); sys.exit(1)", "\ufffd!"),
}


@pytest.mark.parametrize(("code", "reason"), REASONS.values(), ids=REASONS.keys())
def test_the_reason_is_one_line(code: str, reason: str) -> None:
    assert run(python(code)).reason == reason


def test_a_program_that_is_not_there() -> None:
    done = run(["/nowhere/carom", "list"])
    assert (done.exit_code, done.reason) == (
        NOT_FOUND,
        "/nowhere/carom: cannot be run: No such file or directory",
    )


def test_the_time_limit_stops_grandchildren_too() -> None:
    done = run(python("import subprocess; subprocess.run(['sleep', '600'])"), time_limit=0.3)
    assert (done.exit_code, done.reason) == (TIMED_OUT, "took longer than 0.3 s and was stopped")


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


def test_a_companion_answers_again_and_again() -> None:
    with Coprocess(python(ECHO)) as coprocess:
        answers = [coprocess.ask(word, time_limit=20).output.split() for word in ("one", "two")]
    (first, one), (second, two) = answers
    assert (one, two) == ("one", "two")
    assert first == second, "the same process"
    assert not Path(f"/proc/{first}").exists(), "it ends with its context"


def test_what_a_companion_says_on_the_side_comes_with_its_answer() -> None:
    with Coprocess(python(ECHO)) as coprocess:
        said = [coprocess.ask(word, time_limit=20).error for word in ("murmur", "more", "murmur", "murmur")]
    assert said == ["on the side\n", "", "on the side\n", "on the side\n"]


def test_a_companion_that_fails_says_why_and_starts_anew() -> None:
    with Coprocess(python(ECHO)) as coprocess:
        for _ in range(2):
            failed = coprocess.ask("fail", time_limit=20)
            assert (failed.exit_code, failed.reason) == (1, "it fails")
        assert coprocess.ask("more", time_limit=20).output.endswith("more\n")


def test_a_companion_that_takes_too_long_is_stopped() -> None:
    with Coprocess(python(ECHO)) as coprocess:
        late = coprocess.ask("sleep", time_limit=0.3)
        assert (late.exit_code, late.reason) == (TIMED_OUT, "took longer than 0.3 s and was stopped")
        assert coprocess.ask("more", time_limit=20).exit_code == 0
