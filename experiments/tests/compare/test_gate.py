"""`carom gate` on a repository of a few commits: its exit codes, and that nothing stays behind."""

import os
import signal
import subprocess
import termios
import time
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.compare.answer import Answer, Difference
from experiments.compare.gate import SLOWER, UNDECIDED, verdict
from experiments.tests.compare.calls import BENCHMARK, CAROM, left_behind, needs_the_program, run, start
from experiments.tests.conftest import ROOT, is_running

PRINTS = "#!/bin/sh\n# {tag}\necho took $((100 + {more})) ms\n"
"""A program whose time is what it says, so that the verdict does not depend on the machine."""


def git(folder: Path, *words: str) -> str:
    said = subprocess.run(
        ["git", "-c", "user.name=a", "-c", "user.email=a@b", "-C", folder, *words],
        capture_output=True,
        text=True,
        check=True,
    )
    return said.stdout.strip()


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """Commits tagged `base`, `equal`, 5 % `slower` and 5 % `faster`; `broken` does not build."""
    top = tmp_path / "repository"
    (top / "sub").mkdir(parents=True)
    git(top, "init", "-q")
    for tag, more, build in (
        ("base", 0, "true"),
        ("equal", 0, "true #"),
        ("slower", 5, "true"),
        ("faster", -5, "true"),
        ("broken", 0, "echo cannot find -lm >&2; false"),
    ):
        (top / "sub" / "program.in").write_text(PRINTS.format(more=more, tag=tag), encoding="utf-8")
        (top / "sub" / "build.sh").write_text(
            f"{build}\ncp program.in program; chmod +x program\n", encoding="utf-8"
        )
        git(top, "add", ".")
        git(top, "commit", "-q", "-m", tag)
        git(top, "tag", tag)
    (tmp_path / "tmp").mkdir()
    return top


def gate(repository: Path, *words: str) -> subprocess.CompletedProcess[str]:
    measuring = ["--build", "sh -e build.sh", "--time-from", "took ([0-9]+) ms", "--time", "60s"]
    words = ("gate", "--base", "base", *measuring, *words, "--", "./program")
    return run(repository / "sub", *words, tmp=repository.parent / "tmp")


def require_untouched(repository: Path) -> None:
    assert left_behind(repository.parent) == []
    assert git(repository, "worktree", "list").count("\n") == 0
    assert git(repository, "status", "--porcelain") == ""


@needs_the_program
def test_a_build_is_told_of_on_a_terminal(repository: Path) -> None:
    ours, theirs = os.openpty()
    termios.tcsetwinsize(theirs, (24, 80))
    words = [str(CAROM), "gate", "--base", "base", "--build", "sleep 1.2; false", "--", "./program"]
    env = {**os.environ, "TERM": "xterm", "TMPDIR": str(repository.parent / "tmp")}
    with subprocess.Popen(words, cwd=repository / "sub", env=env, stderr=theirs) as child:
        os.close(theirs)
    shown = os.read(ours, 65536)
    os.close(ours)
    assert child.returncode == 1
    assert b"builds base" in shown
    assert b", 1 s" in shown


@needs_the_program
def test_a_slower_commit_may_be_accepted_in_writing(repository: Path, tmp_path: Path) -> None:
    reason = tmp_path / "accepted"
    reason.write_text("checks every index now\n", encoding="utf-8")
    done = gate(repository, "--head", "slower", "--accept", str(reason))
    assert done.returncode == 0
    assert "slower, as is accepted: checks every index now" in done.stdout


@needs_the_program
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_a_signal_while_it_builds_leaves_nothing(repository: Path, number: signal.Signals) -> None:
    build = "setsid sleep 1000 & echo $! > ../pid; wait"
    words = ("gate", "--base", "base", "--build", build, "--", "./program")
    child = start(repository / "sub", words, {"TMPDIR": str(repository.parent / "tmp")})
    until, pids = time.monotonic() + 60, list[str]()
    while time.monotonic() < until and not pids:
        time.sleep(0.05)
        pids = [
            one.read_text() for one in repository.parent.glob("tmp/carom-gate-*/base/pid") if one.read_text()
        ]
    child.send_signal(number)
    child.communicate(timeout=60)
    assert child.returncode == (-number if number == signal.SIGKILL else 128 + number)
    while time.monotonic() < until and "\n" in git(repository, "worktree", "list"):
        time.sleep(0.05)
    require_untouched(repository)
    assert not is_running(int(pids[0])), "what it built with goes on"


@needs_the_program
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--head", "nowhere"], "--head: found nowhere, expected a commit of "),
        (["--head", "broken"], "does not build: cannot find -lm"),
        (["--head", "equal", "--fail-on", "never"], "--fail-on: invalid choice"),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(repository: Path, words: list[str], told: str) -> None:
    done = gate(repository, *words)
    assert done.returncode == 1
    assert told in done.stderr
    require_untouched(repository)


@needs_the_program
def test_cases_of_a_benchmark_are_judged_together(repository: Path) -> None:
    (repository / "sub" / "program.in").write_text(
        "#!/bin/sh\n" + BENCHMARK.format(names="BM_a BM_b", time=4), encoding="utf-8"
    )
    (repository / "sub" / "build.sh").write_text(
        "cp program.in program; chmod +x program\n", encoding="utf-8"
    )
    git(repository, "commit", "-q", "-a", "-m", "benchmark")
    git(repository, "tag", "benchmark")
    page = repository / "sub" / "program.in"
    page.write_text(page.read_text(encoding="utf-8").replace(": 4,", ": 5,"), encoding="utf-8")
    git(repository, "commit", "-q", "-a", "-m", "slower benchmark")
    words = ("gate", "--base", "benchmark", "--build", "sh -e build.sh", "--gb", "--many", "250")
    more = ("--export-markdown", "told.md", "--", "./program")
    done = run(repository / "sub", *words, *more, tmp=repository.parent / "tmp")
    assert done.returncode == 3, done.stderr
    assert (
        "of 250 commits that change nothing, the chance that any is called slower is at most" in done.stderr
    )
    assert "BM_b   4 ms → 5 ms   +25.0 % [+25.0, +25.0]   slower by more than 2 %" in done.stdout
    told = (repository / "sub" / "told.md").read_text(encoding="utf-8").splitlines()
    assert told[0] == "**gate: failed: slower**"
    assert "again: carom gate --base benchmark" in "\n".join(told)
    (repository / "sub" / "told.md").unlink()
    require_untouched(repository)


def answer(low: float, high: float, low_of_all: float | None = None) -> Answer:
    of_all = low if low_of_all is None else low_of_all
    middle = (low + high) / 2
    return Answer((Difference("head", middle, low, high, "inconclusive", 9, False, low_of_all=of_all),))


@pytest.mark.parametrize(
    ("low", "high", "fail_on", "code"),
    [
        (0.9, 1.019, "undecided", 0),
        (1.021, 1.1, "slower", SLOWER),
        (0.9, 1.1, "undecided", UNDECIDED),
        (0.9, 1.1, "slower", 0),
    ],
)
def test_only_an_interval_beyond_the_margin_decides(low: float, high: float, fail_on: str, code: int) -> None:
    assert verdict(answer(low, high), 0.02, "", fail_on).code == code


def test_a_gate_goes_on_until_its_own_question_is_answered() -> None:
    """What is slower beyond doubt for one call is not yet so for all calls of a year."""
    found = replace(answer(1.03, 1.1, low_of_all=1.01).commands[0], verdict="slower")
    assert Answer((found,)).is_enough(0.02, one_sided=False)
    assert not Answer((found,)).is_enough(0.02, one_sided=True)


def test_one_of_many_is_slower_only_where_the_interval_of_all_says_so() -> None:
    assert verdict(answer(1.03, 1.1, low_of_all=1.01), 0.02, "", "undecided").code == UNDECIDED
    assert verdict(answer(1.03, 1.1, low_of_all=1.025), 0.02, "", "undecided").code == SLOWER


@needs_the_program
@pytest.mark.parametrize(
    ("head", "label", "code"), [("equal", "", 0), ("slower", "", 3), ("slower", "fine", 0)]
)
def test_the_action_ends_as_the_gate_and_writes_a_summary(
    repository: Path, tmp_path: Path, head: str, label: str, code: int
) -> None:
    git(repository, "checkout", "-q", head)
    home = tmp_path / "home" / ".local" / "bin"
    home.mkdir(parents=True)
    (home / "carom").symlink_to(CAROM)
    settings = {
        "BASE": "base",
        "BUILD": "sh -e build.sh",
        "WORDS": "./program",
        "OPTIONS": "--turns off --time-from ([0-9]+).ms",
        "LABEL": label,
        "HOME": str(tmp_path / "home"),
        "RUNNER_TEMP": str(tmp_path),
        "GITHUB_STEP_SUMMARY": str(tmp_path / "summary"),
        "GITHUB_OUTPUT": str(tmp_path / "output"),
        "TMPDIR": str(tmp_path / "tmp"),
    }
    (tmp_path / "summary").write_text("before\n", encoding="utf-8")
    done = subprocess.run(
        [ROOT / ".github" / "actions" / "gate" / "gate.sh"],
        cwd=repository / "sub",
        env={**os.environ, **settings},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == code, done.stderr
    summary = (tmp_path / "summary").read_text(encoding="utf-8").splitlines()
    said = {0: "passed: not slower", 3: "failed: slower"}[code] if not label else f"label {label}"
    assert summary[0] == "before"
    assert said in summary[1]
    assert (tmp_path / "output").read_text(encoding="utf-8") == f"report={tmp_path}/carom-gate.md\n"


def test_the_action_passes_every_setting_on() -> None:
    action = (ROOT / ".github" / "actions" / "gate" / "action.yml").read_text(encoding="utf-8")
    script = (ROOT / ".github" / "actions" / "gate" / "gate.sh").read_text(encoding="utf-8")
    for name in ("BASE", "BUILD", "WORDS", "OPTIONS", "LABEL"):
        assert f"        {name}: ${{{{" in action
        assert f"${name}" in script


@needs_the_program
@pytest.mark.parametrize(
    ("head", "code", "said"),
    [
        ("equal", 0, "gate: passed: not slower by more than the margin"),
        ("faster", 0, "gate: passed: not slower by more than the margin"),
        ("slower", 3, "gate: failed: slower"),
    ],
)
def test_the_exit_code_is_the_answer(repository: Path, head: str, code: int, said: str) -> None:
    done = gate(repository, "--head", head)
    assert done.returncode == code, done.stderr
    assert said in done.stdout
    require_untouched(repository)
