"""`carom gate` on a repository of a few commits: its exit codes, and that nothing stays behind."""

import os
import subprocess
from pathlib import Path

import pytest

from experiments.compare.answer import Answer, Difference
from experiments.compare.gate import SLOWER, UNDECIDED, verdict
from experiments.tests.conftest import ROOT

CAROM = ROOT / "build" / "gcc" / "carom"

PRINTS = "#!/bin/sh\necho took $((100 + {more})) ms\n"
"""A program whose time is what it says, so that the verdict does not depend on the machine."""

needs_the_program = pytest.mark.skipif(
    not CAROM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)


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
        (top / "sub" / "program.in").write_text(PRINTS.format(more=more), encoding="utf-8")
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
    return subprocess.run(
        [CAROM, "gate", "--base", "base", *measuring, *words, "--", "./program"],
        cwd=repository / "sub",
        env={**os.environ, "TMPDIR": str(repository.parent / "tmp")},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def require_untouched(repository: Path) -> None:
    left = [one.name for one in (repository.parent / "tmp").iterdir() if not one.name.endswith(".lock")]
    assert left == []
    assert git(repository, "worktree", "list").count("\n") == 0
    assert git(repository, "status", "--porcelain") == ""


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


@needs_the_program
def test_a_slower_commit_may_be_accepted_in_writing(repository: Path, tmp_path: Path) -> None:
    reason = tmp_path / "accepted"
    assert gate(repository, "--head", "slower", "--accept", str(reason)).returncode == 3
    reason.write_text("checks every index now\n", encoding="utf-8")
    done = gate(repository, "--head", "slower", "--accept", str(reason))
    assert done.returncode == 0
    assert "slower, as is accepted: checks every index now" in done.stdout


@needs_the_program
def test_what_is_not_committed_is_said(repository: Path) -> None:
    (repository / "more").touch()
    done = gate(repository, "--head", "equal")
    assert done.returncode == 0
    assert "carom: what is not committed is not measured" in done.stderr


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


def answer(low: float, high: float) -> Answer:
    return Answer((Difference("head", (low + high) / 2, low, high, "inconclusive", 9, differs=False),))


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
    assert verdict(answer(low, high), 0.02, "", fail_on) == code
