"""A comparison of programs: whole processes, a table in order, who failed, who was not checked."""

from pathlib import Path

import numpy as np
import pytest

from analysis.cli import main
from analysis.figures import draw_all
from analysis.report import write as write_report
from analysis.tests.synthetic import failure, process, write
from analysis.tests.synthetic_study import tables_of

MEANS = {"anna": 1.0, "bob": 1.001, "carl": 1.4}
SCOPES = {
    "anna": "trajectory of its own program, steps 0 to 20",
    "carl": "trajectory of another command: right.py",
}
TOLD = {"bob": {"undisturbed": "it sleeps"}, "carl": {"time_from": "the program"}}


@pytest.fixture
def results(tmp_path: Path) -> Path:
    generator = np.random.default_rng(7)
    for block in range(6):
        for series, mean in MEANS.items():
            seconds = mean * float(np.exp(0.003 * generator.standard_normal()))
            scope = SCOPES.get(series, "nothing")
            record = process("hand_ins", series, block, seconds, scope, **TOLD.get(series, {}))
            record["tags"] |= {"figure": "comparison", "title": "Who is fastest"}
            write(tmp_path, [record])
    write(tmp_path, [failure("hand_ins", "dora", "exit code 9: no room")])
    (tmp_path / "claims.toml").write_text("")
    return tmp_path


def test_the_table_is_in_order_with_brackets_checks_and_failures(results: Path) -> None:
    [drawn] = draw_all(results)
    [table] = tables_of(drawn).values()
    assert table[1:] == [
        ["1 to 2", "anna", "1.00", "a", "its own program, steps 0 to 20"],
        ["1 to 2", "bob", "1.00", "a", "not checked [open]"],
        ["3", "carl", "1.40", "b", "another command: right.py [open]"],
        ["–", "dora", "–", "", "failed: exit code 9: no room [fails]"],
    ]
    assert (
        "Times are of whole processes, from outside; those of carl are what the program says" in drawn.caption
    )
    assert "Measured without a pause, in a stretch of its own instead of in turns: bob (it sleeps)." in (
        drawn.caption
    )


def test_the_report_names_commands_and_claims_nothing(results: Path) -> None:
    html = write_report(results)
    text = html.read_text(encoding="utf-8")
    assert "&#39;./a b&#39; anna" in text or "'./a b' anna" in text
    assert "of programs whose results are not checked" in text
    assert "Four boxes" not in text


def test_the_report_repeats_questions_of_another_folder(results: Path) -> None:
    (results / "claims.toml").write_text('questions = "my questions"\n')
    html = write_report(results)
    assert "SCALE=paper QUESTIONS=&#39;my questions&#39;" in html.read_text(encoding="utf-8")


CLAIM = """
[[claim]]
id = "anna_wins"
claim = "Anna's is faster than Carl's."
test = "pair"
[claim.arguments]
experiments = ["hand_ins"]
axis = "series"
candidate = "anna"
reference = "carl"
expected = "faster"
"""


def claims(results: Path, text: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    (results / "claims.toml").write_text(text)
    code = main(["claims", "--results", str(results)])
    printed = capsys.readouterr()
    return code, printed.out + printed.err


def test_claims_of_a_folder_of_questions_are_judged(
    results: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, printed = claims(results, CLAIM, capsys)
    assert code == 0
    assert "1 decided" in printed
    assert "anna_wins" in printed
    assert "holds" in printed
    assert "four_boxes" not in printed


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('test = "pair"', 'test = "pairs"', 'claim anna_wins: test: found "pairs", expected one of'),
        ('test = "pair"', "", "claims.toml: claim[1]: "),
        ("axis =", "axes =", "claim anna_wins: arguments: "),
        ("experiments =", "questions =", "claim[1].arguments.experiment: missing"),
        ("[[claim]]", "[[claim]", "claims.toml: cannot be read"),
        ("id =", "name =", "claims.toml: claim[1]: "),
    ],
)
def test_a_claim_that_is_none_is_told_in_a_line(
    results: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, expected: str
) -> None:
    code, printed = claims(results, CLAIM.replace(old, new), capsys)
    assert code == 1
    assert expected in printed
    assert len([line for line in printed.splitlines() if expected in line]) == 1
    assert "Traceback" not in printed
