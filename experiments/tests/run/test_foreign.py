"""What programs of others need and do: folders, turns that they mind, files that they write."""

from pathlib import Path

import pytest

from experiments.run.session import run
from experiments.run.study import POINTS_FAILED, Study
from experiments.side_by_side.contest import LEFT_ALONE
from experiments.tests.conftest import Workplace
from experiments.tests.foreign import BLOCKS, HEAD, ids, script, series
from support.errors import InputError

SURROUNDED = 'command = ["./sim", "{x}"]\nprepare = ["./before", "{folder}"]\nconclude = ["true"]\n'


def test_what_goes_before_and_after_a_run_is_handed_on(empty_workplace: Workplace) -> None:
    place = empty_workplace
    for name in ("sim", "before"):
        script(place, name, "exit 0")
    place.question("asked", HEAD + series("a", SURROUNDED, "exit_codes = [0, 3]", "turns = false") + BLOCKS)
    assert run(place.settings) == 0
    one = place.contenders[0]
    folder = place.root / "questions"
    assert one.prepare == (str(folder / "before"), str(folder))
    assert Path(one.conclude[0]).name == "true"
    assert (one.exit_codes, one.turns, one.fresh_folder) == ((0, 3), False, False)
    record = next(iter(place.records().values()))
    sources = {Path(source["path"]).name for source in record["process"]["sources"]}
    assert sources >= {"sim", "before"}, "what prepares is a part of it"


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


NO_TERMINAL = "it had no terminal: its standard input is empty, its outputs are pipes"
IDLE = "it computes for only 0 % of its time, and what it waits for would go on while it stands still"


def told(place: Workplace) -> list[dict[str, bool | None]]:
    """Of each contest, by the contenders' last words, who is known to take turns."""
    contests: list[dict[str, bool | None]] = []
    for one in place.contenders:
        if not contests or one.words[-1] in contests[-1]:
            contests.append({})
        contests[-1][one.words[-1]] = one.turns
    return contests


def ask(place: Workplace, *lines: str, names: str = "ab", head: str = HEAD, blocks: str = BLOCKS) -> None:
    """Run a question about programs with names of one letter."""
    text = "".join(series(name, f'command = ["true", "{name}"]', *lines) for name in names)
    place.question("asked", head + text + blocks)
    assert run(place.settings) == 0


def test_whether_it_may_take_turns_is_found_out_once(empty_workplace: Workplace) -> None:
    place = empty_workplace
    place.behave(FAKE_IDLE="b")
    ask(place, names="abc")
    none = dict.fromkeys("abc", False)
    assert told(place) == [dict.fromkeys("abc"), none, none], "measured anew, all alike"
    assert [one.expected_seconds > 0 for one in place.contenders] == [False] * 3 + [True] * 6
    first = [one for one in place.records("asked").values() if one["tags"]["block"] == 0]
    reasons = {one["tags"]["series"]: one["process"]["undisturbed"] for one in first}
    assert reasons == {**dict.fromkeys("ac", "b must not be, and all are measured alike"), "b": IDLE}
    place.contenders.clear()
    ask(place, names="abc", blocks=BLOCKS.replace("2", "3"))
    assert told(place) == [none], "a later session knows it as well"


OPEN, TURNS, NO_TURNS = dict.fromkeys("ab"), dict.fromkeys("ab", True), dict.fromkeys("ab", False)


@pytest.mark.parametrize(
    ("line", "head", "idle", "expected"),
    [
        ("turns = true", "", "b", [TURNS, TURNS]),
        ("", "", "nobody", [OPEN, TURNS]),
        ("", "turns = false\n", "nobody", [NO_TURNS, NO_TURNS]),
    ],
    ids=["said", "found out: nobody minds", "a question without turns"],
)
def test_who_takes_turns(
    empty_workplace: Workplace, line: str, head: str, idle: str, expected: list[dict[str, bool | None]]
) -> None:
    empty_workplace.behave(FAKE_IDLE=idle)
    ask(empty_workplace, line, head=head + HEAD)
    assert told(empty_workplace) == expected


def test_a_question_about_pauses_compares_both_ways(empty_workplace: Workplace) -> None:
    empty_workplace.behave(FAKE_IDLE="b")
    ask(empty_workplace, head='figure = "pauses"\n' + HEAD.replace('figure = "comparison"\n', ""))
    assert told(empty_workplace)[1:] == [{"a": None, "b": False}], "a was left alone, which tells nothing"
    records = empty_workplace.records("asked").values()
    assert {one["process"]["undisturbed"] for one in records} >= {LEFT_ALONE, IDLE}


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
    by_name = {Path(one.words[0]).name + (one.benchmark or ""): one for one in place.contenders}
    assert not by_name["echo"].may_be_sliced
    assert not by_name["benchBM_b"].may_be_sliced
    assert "--benchmark_min_time=0.1" in by_name["benchBM_b"].words
    assert by_name["benchBM_a{x}"].words[1] == r"--benchmark_filter=^BM_a\{x}(/|$)"


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
    assert [one["reason"] for one in sorting.failures()] == ["exit code 4 without a word; " + NO_TERMINAL]
