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
    assert experiment.points[0].program.files[1:] == (place.root / "questions" / "in.txt",)
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
BOTH = series("up", SORT, 'writes = ["data.txt"]') + series("down", SORT.replace('"-o"', '"-r", "-o"'))


@pytest.fixture
def sorting(empty_workplace: Workplace) -> Workplace:
    """A workplace with a file to be sorted, and a program that writes."""
    script(empty_workplace, "sim", "echo more >> data.txt; exit 4")
    script(empty_workplace, "own", "echo '# new' >> own")
    (empty_workplace.root / "questions" / "data.txt").write_text("b\na\nc\n")
    return empty_workplace


@pytest.mark.parametrize("head", [HEAD, "turns = false\n" + HEAD], ids=["in turns", "one after the other"])
def test_a_program_may_write_what_its_question_says(sorting: Workplace, head: str) -> None:
    sorting.question("asked", head + BOTH + BLOCKS)
    before = ids(sorting)
    assert run(sorting.settings) == 0
    assert ids(sorting) == before, "what it wrote makes no other point of it, nor of others"
    records = sorting.records("asked")
    assert len(records) == 2 * len(before)
    assert run(sorting.settings) == 0
    assert sorting.records("asked") == records, "nothing is measured twice"
    sorting.question("asked", head + BOTH + BLOCKS.replace("2", "3"))
    assert run(sorting.settings) == 0
    assert len(sorting.records("asked")) == 3 * len(before)


UNSAID = {
    "a file that it reads, too": (
        SORT,
        "data.txt: was built anew while .*, or say `writes` where it is written",
    ),
    "a file that it creates": (
        SORT.replace('-o", "data', '-o", "out'),
        "out.txt: is written by what is measured",
    ),
    "and fails": ('command = ["./sim", "data.txt"]', "data.txt: was built anew while the study ran"),
    "itself": (
        'command = ["./own"]',
        "own: was built anew while the study ran; run the study again to go on",
    ),
}


@pytest.mark.parametrize(("command", "said"), UNSAID.values(), ids=UNSAID.keys())
def test_what_it_writes_unsaid_ends_the_study_in_a_line(sorting: Workplace, command: str, said: str) -> None:
    sorting.question("asked", HEAD + series("a", command) + BLOCKS)
    with pytest.raises(InputError, match=said):
        run(sorting.settings)


def test_a_program_that_fails_may_write_as_well(sorting: Workplace) -> None:
    lines = ('command = ["./sim", "data.txt"]', 'writes = ["data.txt"]')
    sorting.question("asked", HEAD + series("a", *lines) + BLOCKS)
    assert run(sorting.settings) == POINTS_FAILED
    assert [one["reason"] for one in sorting.failures()] == ["command: exit code 4"]
