"""Profiled points leave a timeline, once each, for the picture of a step; timed ones never do."""

import json

from experiments.run.session import run
from experiments.tests.conftest import PAIR, Workplace

PROFILED = PAIR.replace('figure = "comparison"', 'figure = "phases"\nverb = "profile"')


def timelines(workplace: Workplace) -> list[str]:
    return sorted(path.name for path in (workplace.results / "timelines").glob("*"))


def test_a_profiled_point_leaves_a_timeline_with_chunks_in_its_first_block(workplace: Workplace) -> None:
    workplace.question("where", PROFILED)
    assert run(workplace.settings) == 0
    assert timelines(workplace) == ["where-four.json", "where-nine.json"]
    for name in timelines(workplace):
        assert json.loads((workplace.results / "timelines" / name).read_text())["chunks"] is True
    asked = [call["words"] for call in workplace.calls() if "--timeline" in call["words"]]
    assert len(asked) == 2
    assert all("profile" in words and "block=0" in words for words in asked)


def test_a_point_that_fails_leaves_none(workplace: Workplace) -> None:
    workplace.question("where", PROFILED)
    workplace.behave(FAKE_RESULT_WRONG="nine")
    run(workplace.settings)
    assert timelines(workplace) == ["where-four.json"]


def test_each_point_of_a_sweep_has_its_own(workplace: Workplace) -> None:
    sweep = '[sweep]\nparameter = "find_chunk"\nvalues = [1, 2]\n\n[[series]]'
    workplace.question("where", PROFILED.replace("[[series]]", sweep, 1).replace('"four"', '"a/b c++"'))
    assert run(workplace.settings) == 0
    assert timelines(workplace) == [
        "where-a_b_c++-1.json", "where-a_b_c++-2.json", "where-nine-1.json", "where-nine-2.json",
    ]  # fmt: skip
