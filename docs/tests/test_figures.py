"""Every figure and measured table says of what it is, and is not older than what it measured."""

import json
import shutil
from dataclasses import replace
from datetime import date
from pathlib import Path

import pytest
from documents import ROOT

from docs.generate import remake, sources
from docs.generate.figures import OLDER, Figure, chosen, complaints, is_stale, load
from support.errors import InputError

FIGURES = load()
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (
        ROOT / "README.md",
        *sorted((ROOT / "docs").glob("*.md")),
        *sorted(ROOT.glob("docs/reference/*.md")),
    )
}


@pytest.mark.parametrize("figure", FIGURES.values(), ids=FIGURES.keys())
def test_a_figure_is_younger_than_what_it_measured(figure: Figure) -> None:
    if figure.shown and not any(figure.shown in text for text in PAGES.values()):
        pytest.skip(f"no page shows the table {figure.name}")
    found = complaints(figure, PAGES)
    assert not found, "\n".join(found)


def test_every_figure_is_in_the_table_once() -> None:
    listed = [
        file for figure in FIGURES.values() for file in figure.files if file.startswith("docs/figures/")
    ]
    there = [path for path in (ROOT / "docs" / "figures").iterdir() if path.suffix in (".svg", ".png")]
    assert sorted(listed) == sorted(path.relative_to(ROOT).as_posix() for path in there)


@pytest.mark.parametrize("figure", FIGURES.values(), ids=FIGURES.keys())
def test_an_entry_says_how_it_is_made_again(figure: Figure) -> None:
    assert figure.measures
    assert figure.machine
    assert figure.command or (figure.needs and figure.shown)
    assert bool(figure.files) == bool(figure.command)


# What makes a figure stale, tried on a copy of the sources of `neighbourhood`.

MOVE, QUESTION = "kernels/move.hpp", "experiments/questions/neighbourhood.toml"
CHANGES = {
    "a line of code": (MOVE, "namespace carom {", "namespace carom {\nint changed = 1;", True),
    "a comment": (MOVE, "namespace carom {", "// changed\nnamespace carom { /* too */", False),
    "a key of the question": (QUESTION, "steps = 12", "steps = 13", True),
    "another kernel": (
        "kernels/exact/flight.hpp",
        "namespace carom {",
        "namespace carom {\nint x;",
        False,
    ),
}


@pytest.mark.parametrize(("file", "old", "new", "stale"), CHANGES.values(), ids=CHANGES.keys())
def test_code_makes_a_figure_stale_and_a_comment_does_not(
    tmp_path: Path, file: str, old: str, new: str, *, stale: bool
) -> None:
    for folder in ("kernels", "harness/measure", "experiments/questions"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    patterns = FIGURES["neighbourhood"].sources
    figure = replace(FIGURES["neighbourhood"], digest=sources.digest(tmp_path, patterns))
    assert not is_stale(figure, tmp_path)
    text = (tmp_path / file).read_text(encoding="utf-8")
    assert old in text
    (tmp_path / file).write_text(text.replace(old, new, 1), encoding="utf-8")
    assert is_stale(figure, tmp_path) == stale


@pytest.mark.parametrize(
    ("name", "old", "new", "same"),
    [
        ("a.hpp", 'f("// no comment");', 'f("");', False),
        ("a.hpp", "x = 300'000; // y", "x = 300'000;", True),
        ("a.hpp", "x = 300'000; y = '/';", "x = 300'000; y = '*';", False),
        ("a.hpp", 'R"(// a)"', 'R"(// b)"', False),
        ("a.hpp", "a+b /* c */", "a + b", True),
        ("a.hpp", "int a", "inta", False),
        ("a.hpp", "#pragma once\n#include <array>\nint a", "#pragma once\nint\n\n  a", True),
        ("a.py", '"""Doc."""\n\nx = 1  # why\n"""About x."""\n', "x = 1\n", True),
        ("a.py", 'def f():\n    """Doc."""\n    return "# no"\n', 'def f():\n    return "#"\n', False),
        ("a.py", "if a:\n    b()\nc()\n", "if a:\n    b()\n    c()\n", False),
        ("a.py", 'f("ä")  # ö\n', 'f("ä")\n', True),
        ("a.toml", "a = 1\nb = 2\n", "# c\nb=2\na=1\n", True),
        ("a.json", '{"a": 1}', '{\n"a":1}', True),
        ("a.csv", "1,2", "1, 2", False),
    ],
)
def test_the_digest_is_of_what_a_file_does(
    tmp_path: Path, name: str, old: str, new: str, *, same: bool
) -> None:
    digests = []
    for text in (old, new):
        (tmp_path / name).write_text(text, encoding="utf-8")
        digests.append(sources.digest(tmp_path, [name]))
    assert (digests[0] == digests[1]) == same


def test_a_pattern_without_a_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="gone"):
        sources.digest(tmp_path, ["kernels/gone.hpp"])


# What pages have to say.

DAY = date(2026, 11, 26)
OF = Figure("x", "a question", ("a.hpp",), "abc1234", DAY, "a machine", "", files={"f/x.svg": "r/x.svg"})
SHOWN = "# T\n\nText.\n\n![X](figures/x.svg)\n\n"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "a.hpp").write_text("int a;")
    return tmp_path


@pytest.mark.parametrize("said", ["commit abc1234, 26 November\n2026", "abc1234 of 2026-11-26"])
def test_a_page_that_says_commit_and_date_is_fine(root: Path, said: str) -> None:
    figure = replace(OF, digest=sources.digest(root, OF.sources))
    assert complaints(figure, {"p.md": SHOWN + " ".join(said.split())}, root) == []
    (found,) = complaints(figure, {"p.md": SHOWN}, root)
    assert found.startswith("p.md: does not say")
    assert complaints(figure, {"p.md": "Nothing.\n"}, root) == ["x: no page shows it"]


def test_a_stale_figure_is_told_with_what_makes_it_again(root: Path) -> None:
    (found,) = complaints(replace(OF, command="make x"), {"p.md": f"{SHOWN}abc1234 2026-11-26"}, root)
    assert "`make docs FIGURES=x`" in found


def test_a_stale_figure_of_another_machine_says_beside_it_that_it_is_older(root: Path) -> None:
    figure = replace(OF, needs="16 cores")
    told = f"{SHOWN}Commit abc1234, 2026-11-26, {OLDER.replace(' ', chr(10), 1)}."
    assert complaints(figure, {"p.md": told}, root) == []
    far = f"{SHOWN}One.\n\nTwo.\n\nThree.\n\nCommit abc1234, 2026-11-26, {OLDER}."
    (found,) = complaints(figure, {"p.md": far}, root)
    assert OLDER in found


# Making them again.


def recorded(root: Path) -> None:
    provenance = {"commit": "abc12345", "virtualised": False, "cores": 2, "cpu_model": 'A "big" one'}
    (root / "records").mkdir()
    content = {"provenance": provenance, "recorded_at": "2026-11-26T10:00:00Z"}
    (root / "records" / "one.json").write_text(json.dumps(content))


@pytest.mark.parametrize("code", [0, 2])
def test_a_figure_is_copied_and_its_entry_written_anew(
    root: Path, capsys: pytest.CaptureFixture[str], code: int
) -> None:
    """Also one of a study in which a point failed, and then that is said."""
    table = root / "figures.toml"
    table.write_text(
        f'[x]\nmeasures = "q"\ncommand = "mkdir -p r && echo new > r/x.svg && exit {code}"\n'
        'origin = "records"\n\nsources = ["a.hpp"]\n'
        'commit = "0000000"\nmeasured = 2020-01-01\nmachine = "old"\ndigest = "0"\nsame = "once"\n'
        '[x.files]\n"f/x.svg" = "r/x.svg"\n\n[y]\nmeasures = "z"\nsources = ["a.hpp"]\ncommit = "1111111"\n'
        'measured = 2020-01-01\nmachine = "old"\ndigest = "1"\n'
    )
    recorded(root)
    (root / "f").mkdir()
    y = load(table)["y"]
    assert remake.make([load(table)["x"]], root, table, are_committed=lambda _: True) == code
    made = load(table)["x"]
    assert (root / "f" / "x.svg").read_text() == "new\n"
    told = (made.commit, made.measured, made.machine, made.same)
    assert told == ("abc1234", DAY, 'machine with 2 cores (A "big" one)', "")
    assert not is_stale(made, root)
    assert load(table)["y"] == y
    assert ("x: made without points that failed" in capsys.readouterr().err) == bool(code)


def test_a_command_that_leaves_nothing_changes_nothing(root: Path) -> None:
    table = root / "figures.toml"
    table.write_text("")
    figure = replace(OF, command="exit 2")
    assert remake.make([figure], root, table, are_committed=lambda _: True) == 2
    assert table.read_text() == ""


def test_what_no_commit_tells_of_is_not_measured(root: Path) -> None:
    with pytest.raises(InputError, match="not committed"):
        remake.make([replace(OF, command="true")], root, are_committed=lambda _: False)


def test_only_what_is_there_and_has_a_command_can_be_asked_for() -> None:
    with pytest.raises(InputError, match='did you mean "ladder"'):
        chosen("lader")
    with pytest.raises(InputError, match="baseline needs the published program"):
        chosen("baseline")
    assert [one.name for one in chosen("ladder, ways")] == ["ladder", "ways"]
