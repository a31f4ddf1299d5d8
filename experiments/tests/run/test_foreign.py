"""What programs of others need and do: folders, turns that they mind, files that they write."""

from pathlib import Path

import pytest

from experiments.run.behaviour import LEFT_ALONE
from experiments.run.session import run
from experiments.run.study import POINTS_FAILED, Study
from experiments.tests.conftest import Workplace
from experiments.tests.foreign import BLOCKS, HEAD, described, ids, script, series
from support.errors import InputError

SURROUNDED = 'command = ["./sim", "{x}"]\nprepare = ["./before", "{folder}"]\nconclude = ["true"]\n'


def test_what_goes_before_and_after_a_run_is_handed_on(empty_workplace: Workplace) -> None:
    place = empty_workplace
    for name in ("sim", "before"):
        script(place, name, "exit 0")
    place.question("asked", HEAD + series("a", SURROUNDED, "exit_codes = [0, 3]", "turns = false") + BLOCKS)
    assert run(place.settings) == 0
    one = described(place)[0]
    folder = place.root / "questions"
    assert one["prepare"] == [str(folder / "before"), str(folder)]
    assert Path(one["conclude"][0]).name == "true"
    assert (one["exit_codes"], one["turns"], "fresh_folder" in one) == ([0, 3], False, False)
    assert {Path(source).name for source in one["sources"]} >= {"sim", "before"}, (
        "what prepares is a part of it"
    )


def test_each_of_these_makes_another_point_and_none_leaves_the_id_as_it_was(
    empty_workplace: Workplace,
) -> None:
    script(empty_workplace, "sim", "exit 0")
    plain = 'command = ["./sim", "{x}"]'
    lines = [
        "", 'prepare = ["true"]', 'conclude = ["true"]', "fresh_folder = true", "exit_codes = [0, 1]",
        "turns = true", "turns = false",
    ]  # fmt: skip
    found = []
    for line in [*lines, "exit_codes = [0]", "fresh_folder = false"]:
        empty_workplace.question("asked", HEAD + series("a", plain, line) + BLOCKS)
        found += ids(empty_workplace)
    assert len(set(found[: len(lines)])) == len(lines)
    assert {*found[len(lines) :]} == {found[0]}
    content = content_of(empty_workplace, plain)
    assert set(content) == {
        "words", "folder", "instrument", "trajectory", "pattern", "unit_seconds", "benchmark",
    }  # fmt: skip


def content_of(place: Workplace, lines: str) -> dict[str, object]:
    place.question("asked", HEAD + series("a", lines) + BLOCKS)
    [experiment] = Study(place.settings).experiments
    command = experiment.points[0].command
    assert command is not None
    return command.content


def test_a_fresh_folder_makes_a_program_run_twice_that_cannot_otherwise(empty_workplace: Workplace) -> None:
    place = empty_workplace
    (place.root / "questions").mkdir(exist_ok=True)
    (place.root / "questions" / "in.txt").write_text("b\na\n")
    command = 'command = ["sh", "-c", "mkdir out && sort {folder}/in.txt > out/sorted"]'
    place.question("asked", HEAD + series("a", command, "fresh_folder = true") + BLOCKS)
    assert run(place.settings) == 0
    assert not (place.root / "questions" / "out").exists()
    place.question("asked", HEAD + series("a", command) + BLOCKS)
    assert run(place.settings) == POINTS_FAILED


def test_in_a_fresh_folder_only_whole_paths_name_files(empty_workplace: Workplace) -> None:
    place = empty_workplace
    script(place, "in.txt", "")
    lines = 'command = ["sort", "in.txt", "{folder}/in.txt", "-o", "out.txt"]'
    place.question("asked", HEAD + series("a", lines, "fresh_folder = true") + BLOCKS)
    [experiment] = Study(place.settings).experiments
    assert experiment.points[0].program.inputs == (place.root / "questions" / "in.txt",)
    assert experiment.points[0].program.absent == ()


def test_a_prepare_that_fails_makes_the_point_fail(empty_workplace: Workplace) -> None:
    empty_workplace.question("asked", HEAD + series("a", 'command = ["true"]\nprepare = ["false"]') + BLOCKS)
    assert run(empty_workplace.settings) == POINTS_FAILED
    assert [one["reason"] for one in empty_workplace.failures()] == ["prepare: exit code 1"]


def test_whether_it_may_take_turns_is_found_out_once(empty_workplace: Workplace) -> None:
    place = empty_workplace
    place.behave(FAKE_UNDISTURBED="it is idle most of the time")
    two = series("a", 'command = ["true"]') + series("b", 'command = ["true", "b"]\nturns = true')
    place.question("asked", HEAD + two + BLOCKS)
    assert run(place.settings) == 0
    told = [(one["command"][1:], one.get("turns"), "expected_seconds" in one) for one in described(place)]
    assert sorted(told[:2]) == [([], None, False), (["b"], True, False)]
    assert sorted(told[2:]) == [([], False, True), (["b"], True, True)]
    (place.root / "log").unlink()
    place.question("asked", HEAD + two + BLOCKS.replace("2", "3"))
    assert run(place.settings) == 0
    later = [(one["command"][1:], one.get("turns")) for one in described(place)]
    assert sorted(later) == [([], False), (["b"], True)], "a later session knows it as well"


def test_if_one_minds_none_takes_turns_that_nobody_asked_for(empty_workplace: Workplace) -> None:
    place = empty_workplace
    place.behave(FAKE_UNDISTURBED="it is idle most of the time", FAKE_MINDS="minds")
    text = "".join(series(name, f'command = ["true", "{name}"]') for name in ("a", "minds"))
    place.question("asked", HEAD + text + BLOCKS)
    assert run(place.settings) == 0
    told = [(one["command"][1], one.get("turns")) for one in described(place)]
    assert sorted(told[:2]) == [("a", None), ("minds", None)]
    assert sorted(told[2:4]) == [("a", False), ("minds", False)], "measured anew, all alike"
    assert sorted(told[4:]) == [("a", False), ("minds", False)]
    first = [one for one in place.records("asked").values() if one["tags"]["block"] == 0]
    reasons = {one["tags"]["series"]: one["process"]["undisturbed"] for one in first}
    assert reasons == {
        "a": "minds must not be, and all are measured alike",
        "minds": "it is idle most of the time",
    }


def test_a_question_about_pauses_compares_both_ways(empty_workplace: Workplace) -> None:
    place = empty_workplace
    place.behave(FAKE_UNDISTURBED="it is idle most of the time", FAKE_MINDS="minds")
    text = "".join(series(name, f'command = ["true", "{name}"]') for name in ("a", "minds"))
    place.question(
        "asked", 'figure = "pauses"\n' + HEAD.replace('figure = "comparison"\n', "") + text + BLOCKS
    )
    assert run(place.settings) == 0
    told = [(one["command"][1], one.get("turns")) for one in described(place)]
    assert sorted(told[2:]) == [("a", True), ("minds", False)]


def test_who_was_only_left_alone_is_asked_again(empty_workplace: Workplace) -> None:
    empty_workplace.behave(FAKE_UNDISTURBED=LEFT_ALONE)
    two = series("a", 'command = ["true"]') + series("b", 'command = ["true", "b"]')
    empty_workplace.question("asked", HEAD + two + BLOCKS)
    assert run(empty_workplace.settings) == 0
    assert [one.get("turns") for one in described(empty_workplace)] == [None] * 4


def test_who_does_not_mind_takes_turns_from_then_on(empty_workplace: Workplace) -> None:
    two = series("a", 'command = ["true"]') + series("b", 'command = ["true", "b"]')
    empty_workplace.question("asked", HEAD + two + BLOCKS)
    assert run(empty_workplace.settings) == 0
    assert [one.get("turns") for one in described(empty_workplace)] == [None, None, True, True]


def test_a_question_without_turns_says_so_of_each(empty_workplace: Workplace) -> None:
    two = series("a", 'command = ["true"]') + series("b", 'command = ["true", "b"]')
    empty_workplace.question("asked", "turns = false\n" + HEAD + two + BLOCKS)
    assert run(empty_workplace.settings) == 0
    assert [one["turns"] for one in described(empty_workplace)] == [False] * 4


def test_who_times_itself_joins_the_others_as_a_whole(empty_workplace: Workplace) -> None:
    place = empty_workplace
    script(place, "bench", "exit 0")
    text = series("a", 'command = ["true"]')
    text += series("says", 'command = ["echo", "3"]', "time = {stdout = '([0-9])'}")
    text += series("one", 'benchmark = {program = "./bench", name = "BM_a{{x}}"}')
    text += series("two", 'benchmark = {program = "./bench", name = "BM_b"}')
    place.question("asked", HEAD + text + BLOCKS)
    run(place.settings)
    assert [call["words"][0] for call in place.calls()].count("processes") == 2, "one call a block"
    told = {Path(one["command"][0]).name + str(one.get("benchmark", "")): one for one in described(place)}
    assert told["echo"]["turns"] is False
    assert "turns" not in told["benchBM_b"]
    assert "--benchmark_min_time=0.1" in told["benchBM_b"]["command"]
    assert told["benchBM_a{x}"]["command"][1] == r"--benchmark_filter=^BM_a\{x}(/|$)"


SORT = 'command = ["sort", "-o", "data.txt", "data.txt"]'
BOTH = series("up", SORT) + series("down", SORT.replace('"-o"', '"-r", "-o"'))


def data(place: Workplace, text: str = "b\na\nc\n") -> Path:
    path = place.root / "questions" / "data.txt"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


@pytest.mark.parametrize("head", [HEAD, "turns = false\n" + HEAD], ids=["in turns", "one after the other"])
@pytest.mark.parametrize(
    "text", [BOTH, series("up", SORT)], ids=["two programs", "one that ends in the same"]
)
def test_a_program_may_write_a_file_among_its_words(
    empty_workplace: Workplace, text: str, head: str, capsys: pytest.CaptureFixture[str]
) -> None:
    place = empty_workplace
    path = data(place)
    place.question("asked", head + text + BLOCKS)
    before = ids(place)
    assert run(place.settings) == 0
    assert ids(place) == before, "what it wrote makes no other point of it"
    assert f"{path}: is written by what is measured: each run finds" in capsys.readouterr().err
    records = place.records("asked")
    assert len(records) == 2 * len(before)
    assert run(place.settings) == 0
    assert place.records("asked") == records, "nothing is measured twice"
    place.question("asked", head + text + BLOCKS.replace("2", "3"))
    assert run(place.settings) == 0
    assert len(place.records("asked")) == 3 * len(before)


@pytest.mark.parametrize("file", ["data.txt", "sim"])
def test_what_is_built_anew_is_still_noticed(empty_workplace: Workplace, file: str) -> None:
    """The program stands for a user here who builds it anew, once, while it is measured."""
    place = empty_workplace
    data(place)
    script(place, "sim", f"test -e done || {{ echo '# new' >> {file}; touch done; }}")
    place.question("asked", HEAD + series("a", 'command = ["./sim", "data.txt"]') + BLOCKS)
    with pytest.raises(InputError, match=f"{file}: was built anew while the study ran"):
        run(place.settings)


def test_what_a_program_creates_is_no_part_of_it(empty_workplace: Workplace) -> None:
    place = empty_workplace
    data(place)
    command = 'command = ["sort", "-o", "out.txt", "data.txt"]'
    place.question("asked", HEAD + series("a", command) + BLOCKS)
    before = ids(place)
    assert run(place.settings) == 0
    assert (place.root / "questions" / "out.txt").is_file()
    assert ids(place) == before


def test_a_program_that_fails_may_write_as_well(empty_workplace: Workplace) -> None:
    place = empty_workplace
    data(place)
    script(place, "sim", "echo more >> data.txt; exit 4")
    place.question("asked", HEAD + series("a", 'command = ["./sim", "data.txt"]') + BLOCKS)
    assert run(place.settings) == POINTS_FAILED
    assert [one["reason"] for one in place.failures()] == ["command: exit code 4"]
