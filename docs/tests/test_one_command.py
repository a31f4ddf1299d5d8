"""`carom` as one command: every verb from any folder, its page, its completions; and as it is installed."""

import gzip
import os
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest
from documents import BUILT, ROOT

PROGRAM = ROOT / "build" / "gcc" / "carom"
pytestmark = pytest.mark.skipif(not BUILT, reason="build/gcc/carom is not built (`make build` builds it)")


def say(
    *words: str | Path, folder: Path, program: Path = PROGRAM, more: Mapping[str, str] | None = None
) -> "subprocess.CompletedProcess[str]":
    """Call the program as a user whose environment says nothing of Python."""
    settings = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "OMP_"))}
    command = [str(word) for word in (program, *words)]
    return subprocess.run(
        command, cwd=folder, env=settings | dict(more or {}), capture_output=True, text=True, check=False
    )


def test_a_verb_of_the_study_works_in_any_folder(tmp_path: Path) -> None:
    done = say("study", "check", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "questions and" in done.stdout
    assert not list(tmp_path.iterdir())


def test_a_folder_of_the_users_is_not_taken_for_a_part_of_carom(tmp_path: Path) -> None:
    for name in ("analysis", "experiments"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text("raise SystemExit('the wrong one')\n")
        (tmp_path / name / "__main__.py").write_text("")
    for words in (("study", "builds", "--study", "threads"), ("claims", "--help")):
        done = say(*words, folder=tmp_path, more={"PYTHONPATH": str(tmp_path)})
        assert (done.returncode, done.stderr) == (0, ""), words


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (("study", "walk"), 1, "walk"),
        (("report", "--results", "absent"), 1, "absent: no such folder"),
        (("movie", "absent.in"), 1, "absent.in: cannot be read"),
        (("reprot",), 1, "did you mean 'report'?"),
    ],
)
def test_a_mistake_is_one_line_whoever_does_the_verb(
    tmp_path: Path, words: tuple[str, ...], code: int, said: str
) -> None:
    done = say(*words, folder=tmp_path)
    assert done.returncode == code
    (line,) = done.stderr.splitlines()
    assert said in line


@pytest.mark.parametrize("verb", ["study", "report", "claims", "export", "figures", "movie"])
def test_help_of_a_verb_is_that_of_whoever_does_it(tmp_path: Path, verb: str) -> None:
    asked = say("help", verb, folder=tmp_path)
    assert asked.returncode == 0
    assert asked.stdout == say(verb, "--help", folder=tmp_path).stdout
    assert f"carom {verb}" in asked.stdout.splitlines()[0]


def test_what_only_programs_call_is_not_in_the_help(tmp_path: Path) -> None:
    told = say("study", "--help", folder=tmp_path).stdout
    assert " resume " in told
    for verb in ("work", "builds"):
        assert f" {verb} " not in told
        assert say("study", verb, "--help", folder=tmp_path).returncode == 0


def test_a_program_without_its_python_parts_says_what_it_needs(tmp_path: Path) -> None:
    alone = tmp_path / "build" / "gcc" / "carom"
    alone.parent.mkdir(parents=True)
    shutil.copy(PROGRAM, alone)
    done = say("report", folder=tmp_path, program=alone)
    assert done.returncode == 1
    told = f"carom: report: needs Carom's Python parts, which are not in {tmp_path}, expected there"
    assert done.stderr.startswith(told)
    assert say("list", "--names", folder=tmp_path, program=alone).returncode == 0


def test_a_run_is_simulated_and_drawn(tmp_path: Path) -> None:
    say("generate", "50", "200", "8", "4", "1", "2", "--output", "scene.in", folder=tmp_path)
    done = say("movie", "scene.in", "--output", "scene.png", "--step", "2", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines()[-1] == "scene.png"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["scene.in", "scene.png"]


def test_the_page_has_every_verb_and_option(tmp_path: Path) -> None:
    page = say("help", "--man", folder=tmp_path).stdout
    for said in (".TH CAROM 1", ".SS carom run", ".SS carom study", "\\-\\-error\\-below", ".SH EXIT STATUS"):
        assert said in page
    assert "carom turns" not in page
    if shutil.which("man") is not None:
        (tmp_path / "carom.1").write_text(page)
        words = ["man", "--warnings", "--local-file", str(tmp_path / "carom.1")]
        drawn = subprocess.run(words, capture_output=True, text=True, check=False)
        assert drawn.stderr == ""
        assert "Simulate a scene" in drawn.stdout


COMPLETED = {
    ("carom", "stu"): ["study"],
    ("carom", "study", "res"): ["resume"],
    ("carom", "run", "--thr"): ["--threads"],
    ("carom", "study", "run", "--until"): ["--until-decided"],
    ("carom", "run", "--variant", "event_d"): ["event_driven"],
}


@pytest.mark.parametrize("words", COMPLETED)
def test_bash_completes_what_the_help_tells(tmp_path: Path, words: tuple[str, ...]) -> None:
    script = tmp_path / "completion"
    script.write_text(say("help", "--completion", "bash", folder=tmp_path).stdout)
    typed = " ".join(words)
    asked = (
        f"source {script}; COMP_WORDS=({typed}); COMP_CWORD={len(words) - 1}; "
        f"_carom carom {words[-1]} {words[-2]}; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    )
    path = f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", asked], env={**os.environ, "PATH": path}, capture_output=True, text=True, check=True
    )
    found = done.stdout.split()
    assert [word for word in found if word in COMPLETED[words]] == COMPLETED[words], found


IN_ZSH = """
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "fpath=($1 \\$fpath); PATH=$2:\\$PATH; autoload -U compinit; compinit -u -D; print rea''dy"
zpty -r -m shell found "*ready*"
zpty -w -n shell $'carom --vers\\t\\n'
zpty -r -m shell found "*(commit|expected)*"
print -r -- $found
"""
"""A shell with a terminal, in which somebody types the beginning of an option, the tabulator and return."""


def test_zsh_completes_at_the_first_try(tmp_path: Path) -> None:
    if shutil.which("zsh") is None:
        pytest.skip("no zsh here")
    (tmp_path / "_carom").write_text(say("help", "--completion", "zsh", folder=tmp_path).stdout)
    (tmp_path / "type.zsh").write_text(IN_ZSH)
    words = ["zsh", "-f", tmp_path / "type.zsh", tmp_path, PROGRAM.parent]
    done = subprocess.run(words, capture_output=True, text=True, check=True, timeout=60)
    assert f"carom {(ROOT / 'VERSION').read_text().strip()}" in done.stdout, done.stdout


@pytest.mark.slow
def test_what_is_installed_works_and_leaves_no_trace(tmp_path: Path) -> None:
    prefix, folder = tmp_path / "prefix", tmp_path / "folder"
    folder.mkdir()
    make = ["make", "--no-print-directory", f"PREFIX={prefix}"]
    subprocess.run([*make, "install"], cwd=ROOT, check=True)
    program = prefix / "bin" / "carom"
    assert say("--version", folder=folder, program=program).stdout.startswith("carom ")
    words = ("study", "new", "sorting", "--questions", "mine")
    assert say(*words, folder=folder, program=program).returncode == 0
    asked = ("--questions", "mine", "--results", "mine/results")
    done = say("study", "run", *asked, "--budget", "0.2", folder=folder, program=program)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert (folder / "mine" / "results" / "report.html").stat().st_size > 10_000
    page = gzip.decompress((prefix / "share" / "man" / "man1" / "carom.1.gz").read_bytes())
    assert b".TH CAROM 1" in page
    for path in prefix.rglob("*"):
        named = path.is_file() and not path.is_symlink() and path.suffix in (".py", ".cfg", ".pth", "")
        assert not (named and str(ROOT).encode() in path.read_bytes()) or path.name == "carom", path
    subprocess.run([*make, "uninstall"], cwd=ROOT, check=True)
    assert not [path for path in prefix.rglob("*") if not path.is_dir()]
