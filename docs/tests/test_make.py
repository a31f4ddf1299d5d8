"""What `make` answers: one line for a mistake, before anything is built; its help."""

import os
import re
import subprocess
from pathlib import Path

import pytest
from documents import ROOT

HAS_ENVIRONMENT = (ROOT / ".venv" / "bin" / "python").exists()
pytestmark = pytest.mark.skipif(not HAS_ENVIRONMENT, reason="no .venv here (`make setup` makes it)")

MISTAKES = {
    "a budget": (
        ["experiments", "BUDGET=-1"],
        ".*--budget: found -1, expected a number of minutes above 0.*",
    ),
    "an end": (["experiments", "UNTIL=doomsday"], "UNTIL=doomsday: expected decided"),
    "a study": (["experiments", "STUDY=neighbourhod"], '.*; did you mean "neighbourhood"\\?'),
    "no names in a study": (
        ["experiments", "STUDY=,"],
        ".*--study: found ',', expected names between commas.*",
    ),
    "a file for results": (["experiments", "RESULTS=3.in"], "results: found 3.in, which is no folder, .*"),
    "a cluster": (
        ["experiments", "SITE=example-slurm"],
        ".* is a cluster; use `carom study submit --site .*",
    ),
    "a scale": (["experiments", "SCALE=quik"], 'scale: found "quik".*; did you mean "quick"\\?'),
    "jobs": (["build", "JOBS=many"], "JOBS=many: expected a whole number of at least 1"),
    "no jobs": (["test", "JOBS=0"], "JOBS=0: expected a whole number of at least 1"),
    "a compiler": (["build", "COMPILER=tcc"], "COMPILER=tcc: expected gcc or clang"),
}


def make(*words: str, folder: Path = ROOT) -> "subprocess.CompletedProcess[str]":
    left_out = ("MAKE", "MFLAGS", "OMP_")
    settings = {key: value for key, value in os.environ.items() if not key.startswith(left_out)}
    return subprocess.run(
        ["make", *words], cwd=folder, env=settings, stdin=subprocess.DEVNULL, capture_output=True, text=True,
        check=False,
    )  # fmt: skip


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """All that a verb looks at before it builds, and a scene of three discs and four steps."""
    for name in (
        "Makefile",
        "analysis",
        "experiments",
        "support",
        "harness/record.schema.json",
        "requirements.txt",
        ".venv",
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).symlink_to(ROOT / name)
    (tmp_path / "3.in").write_text("3\n60\n5\n4\n0 10 10 1 0\n1 30 30 0 1\n2 50 50 -5 -5\n")
    return tmp_path


@pytest.mark.parametrize(("words", "line"), MISTAKES.values(), ids=MISTAKES.keys())
def test_a_mistake_is_one_line_before_anything_is_built(checkout: Path, words: list[str], line: str) -> None:
    there = sorted(checkout.iterdir())
    done = make(*words, folder=checkout)
    assert done.returncode == 2
    said = [one for one in done.stderr.splitlines() if not one.startswith("make")]
    assert len(said) == 1, done.stderr
    assert re.fullmatch(line, said[0].removeprefix("carom: "))
    assert sorted(checkout.iterdir()) == there


@pytest.mark.parametrize("word", ["THREADS=two", "STUDYY=threads"])
def test_a_setting_that_there_is_not_is_refused(checkout: Path, word: str) -> None:
    done = make("experiments", word, folder=checkout)
    assert done.returncode == 2
    name = word.split("=")[0]
    assert re.fullmatch(
        rf"Makefile:\d+: \*\*\* {name}=: is no setting, expected one of STUDY .*\n", done.stderr
    )


def test_what_compilers_and_tools_are_told_is_let_through(checkout: Path) -> None:
    assert make("help", "CXXFLAGS=-O1", "CMAKE_PREFIX_PATH=/opt", "WERROR=1", folder=checkout).returncode == 0


def test_a_dry_run_measures_nothing_and_builds_nothing(checkout: Path) -> None:
    done = make("experiments", "STUDY=steps", "DRY_RUN=1", folder=checkout)
    assert done.returncode == 2
    assert "gcc/carom: is not built; build it with `make build`" in done.stderr
    assert not (checkout / "build").exists()


def test_a_dry_run_says_what_would_be_done(checkout: Path) -> None:
    if not (ROOT / "build" / "gcc" / "carom").is_file():
        pytest.skip("build/gcc/carom is not built (`make build` builds it)")
    (checkout / "build").symlink_to(ROOT / "build")
    done = make("experiments", "STUDY=neighbourhood", "SCALE=quick", "DRY_RUN=1", folder=checkout)
    assert done.returncode == 0, done.stderr
    assert re.search(r"^neighbourhood +2 ", done.stdout, re.MULTILINE)
    assert "of them to be run" in done.stdout
    assert not list((checkout / "results").glob("records/*/*.json"))
    assert not (checkout / "results" / "report.html").exists()


def test_a_copied_checkout_says_what_to_do_with_its_build(checkout: Path) -> None:
    cache = checkout / "build" / "gcc" / "CMakeCache.txt"
    cache.parent.mkdir(parents=True)
    cache.write_text("CMAKE_HOME_DIRECTORY:INTERNAL=/another/place\n")
    done = make("build", folder=checkout)
    assert done.returncode == 2
    told = f"build/gcc: was built for /another/place, and this is {checkout}; `make clean` removes it"
    assert f"{told}, then build again" in done.stderr.splitlines()
    assert "CMake" not in done.stderr


def test_help_tells_settings_with_their_defaults_and_exit_codes() -> None:
    told = make("help").stdout
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    (settings,) = re.findall(r"^settings := (.*)$", makefile, re.MULTILINE)
    for name in settings.split():
        assert re.search(rf"^ +{name}=", told, re.MULTILINE), name
    for goal in re.findall(r"^([a-z-]+):[^#\n]*## ", makefile, re.MULTILINE):
        assert f"  make {goal} " in told
    assert "Exit codes: 0 done; else 2" in told
    assert max(map(len, told.splitlines())) <= 130


def test_the_glossary_has_every_rung_and_order() -> None:
    glossary = (ROOT / "docs" / "reference" / "glossary.md").read_text(encoding="utf-8").lower()
    for word in ("sweep", "block", "control", "self-contained", "strips", "stale", "wavefront", "checkered"):
        assert re.search(rf"^\| [^|]*\b{word}\b[^|]*\|", glossary, re.MULTILINE), word
    for readme in ("README.md", "analysis/report/report.html.jinja"):
        assert "docs/reference/glossary.md" in (ROOT / readme).read_text(encoding="utf-8")
