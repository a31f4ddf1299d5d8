"""What is compared is measured by one session: what lost its partner is measured again with it."""

import json
import os
import signal
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import pytest

from experiments.results.store import keys_of
from experiments.run.session import run
from experiments.run.study import POINTS_FAILED, Study
from experiments.tests.conftest import ERRORS, PAIR, Workplace
from experiments.tests.run.test_kill import wait_until_it_measures

BY_TWO_PROGRAMS = PAIR.replace('variant = "nine"', 'variant = "published"\nprogram = "clang"')
SWEPT_APART = PAIR.replace("[scene]", "turns = false\n[scene]", 1)
THIRD = '[[series]]\nname = "third"\nvariant = "row"\n\n[blocks]'


@pytest.fixture
def pair(empty_workplace: Workplace) -> Workplace:
    """A workplace with the question `pair` alone, of four and nine boxes."""
    empty_workplace.question("pair", PAIR)
    return empty_workplace


def blocks(workplace: Workplace) -> dict[int, dict[str, str]]:
    """Block -> series -> the session that measured it."""
    found: dict[int, dict[str, str]] = {}
    for record in workplace.records("pair").values():
        tags = record["tags"]
        found.setdefault(tags["block"], {})[tags["series"]] = tags["session"]
    return dict(sorted(found.items()))


def whole(workplace: Workplace, *series: str) -> list[int]:
    """The blocks that one session measured with all of these series."""
    return [
        block
        for block, one in blocks(workplace).items()
        if set(series) <= one.keys() and len({one[name] for name in series}) == 1
    ]


def test_an_edited_program_is_measured_again_with_its_partner(pair: Workplace) -> None:
    pair.question("pair", BY_TWO_PROGRAMS)
    pair.build("clang", "# another one")
    assert run(pair.settings) == 0
    before = {path.name for path in pair.files("pair")}
    pair.build("clang", "# edited")
    row = pair.rows()["pair"]
    assert (row.blocks, row.done, row.missing, row.stale) == (2, 0, 4, 2)
    assert run(pair.settings) == 0
    assert whole(pair, "four", "nine") == [0, 1]
    assert {path.name for path in pair.results.glob("stale/records/pair/*/*.json")} == before
    row = pair.rows()["pair"]
    assert (row.blocks, row.done, row.missing, row.stale) == (2, 4, 0, 0)
    nothing_is_left_to_do(pair)


def nothing_is_left_to_do(pair: Workplace) -> None:
    done = pair.measured()
    assert run(pair.settings) == 0
    assert pair.measured() == done, "a finished study is left alone"
    there = [key for path in pair.files() for key in keys_of(json.loads(path.read_text()))]
    assert len(there) == len({*there}), "what was measured anew did not come back"


@pytest.mark.parametrize("text", [PAIR, SWEPT_APART], ids=["in turns", "apart"])
def test_a_point_that_fails_in_one_session_and_not_in_the_next(pair: Workplace, text: str) -> None:
    pair.question("pair", text)
    pair.behave(FAKE_BENCH_CRASHES="nine")
    for _ in range(2):
        assert run(pair.settings) == POINTS_FAILED
        assert [set(one) for one in blocks(pair).values()] == [{"four"}] * 2
        row = pair.rows()["pair"]
        assert (row.done, row.failed, row.missing) == (2, 2, 0)
        assert len(pair.failures()) == 1
    sessions = [one["four"] for one in blocks(pair).values()]
    assert sessions[0] > sessions[1], "where it failed it was tried again, and nothing else was measured"
    pair.behave(FAKE_BENCH_CRASHES="none")
    assert run(pair.settings) == 0
    assert whole(pair, "four", "nine") == [0, 1]
    assert not pair.failures()
    nothing_is_left_to_do(pair)


def test_a_point_that_failed_late_keeps_its_earlier_pairs(pair: Workplace) -> None:
    run(pair.settings)
    before = pair.records()
    pair.behave(FAKE_BENCH_CRASHES="nine")
    assert run(replace(pair.settings, blocks=4)) == POINTS_FAILED
    assert whole(pair, "four") == [0, 1, 2, 3]
    pair.behave(FAKE_BENCH_CRASHES="none")
    assert run(replace(pair.settings, blocks=4)) == 0
    assert whole(pair, "four", "nine") == [0, 1, 2, 3]
    assert before.items() <= pair.records().items()


def test_a_file_of_another_name_than_its_content_is_of_no_account(pair: Workplace) -> None:
    run(pair.settings)
    far = pair.results / "records" / "pair" / "b999999999"
    far.mkdir()
    for path in pair.files("pair", "0"):
        path.rename(far / path.name.replace("-b0", "-b999999999"))
    assert pair.rows()["pair"].stale == 2
    assert run(pair.settings) == 0
    assert whole(pair, "four", "nine") == [0, 1]


def test_a_block_that_a_kill_cut_through_is_measured_anew(pair: Workplace) -> None:
    pair.question("pair", SWEPT_APART.replace("minimum = 2\nwanted = 2", "minimum = 3\nwanted = 3"))
    pair.behave(FAKE_SECONDS="0.2")
    process = pair.start("run", "--no-figures")
    wait_until_it_measures(pair)
    while len(pair.files("pair")) != 3:
        assert process.poll() is None
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    of_first = {name: one for name, one in pair.records().items() if one["tags"]["block"] == 0}
    row = pair.rows()["pair"]
    assert (row.done, row.missing) == (2, 4), "half a block is none"
    pair.behave(FAKE_SECONDS="0")
    assert run(pair.settings) == 0
    assert of_first.items() <= pair.records().items()
    assert whole(pair, "four", "nine") == [0, 1, 2]


def test_a_new_series_is_measured_with_all_others(pair: Workplace) -> None:
    run(pair.settings)
    before = pair.records()
    pair.question("pair", PAIR.replace("[blocks]", THIRD))
    assert run(pair.settings) == 0
    assert whole(pair, "four", "nine", "third") == [0, 1]
    pair.question("pair", PAIR)
    nothing_is_left_to_do(pair)
    assert pair.records() == before, "without it what was measured before fits again"


def test_whole_blocks_of_two_sessions_add_up(pair: Workplace) -> None:
    run(pair.settings)
    assert run(replace(pair.settings, blocks=5)) == 0
    sessions = [one["four"] for one in blocks(pair).values()]
    assert whole(pair, "four", "nine") == [0, 1, 2, 3, 4]
    assert sorted(Counter(sessions).values()) == [2, 3]
    assert sum(one != other for one, other in pairwise(sessions)) == 1


@pytest.mark.parametrize(
    "harm",
    [
        lambda place: place.build("clang", "# edited"),
        lambda place: place.files("pair", "0")[0].unlink(),
    ],
    ids=["edited", "lost"],
)
def test_the_plan_tells_how_many_runs_there_will_be(
    pair: Workplace, harm: Callable[[Workplace], None]
) -> None:
    pair.question("pair", BY_TWO_PROGRAMS)
    pair.build("clang", "# another one")
    run(pair.settings)
    harm(pair)
    run(pair.settings)
    plan = Study(pair.settings).store.note("plan.json")["paper"]["pair"]
    assert (plan["blocks"], plan["runs"]) == (2, len(pair.records()))


def test_scenes_have_blocks_of_their_own(empty_workplace: Workplace) -> None:
    empty_workplace.question("errors", ERRORS.replace("errors = true", "errors = true\nturns = false"))
    run(empty_workplace.settings)
    before = {path: path.read_bytes() for path in empty_workplace.files("errors")}
    [lost] = [
        path
        for path, content in before.items()
        if (tags := json.loads(content)["contenders"][0]["tags"])["scene_name"] == "dilute"
        and (tags["series"], tags["x"], tags["block"]) == ("nine", 2, 1)
    ]
    lost.unlink()
    assert run(empty_workplace.settings) == 0
    assert before.keys() == {*empty_workplace.files("errors")}
    new = [path for path, content in before.items() if path.read_bytes() != content]
    scenes = [json.loads(path.read_text())["contenders"][0]["tags"] for path in new]
    assert [(one["scene_name"], one["block"]) for one in scenes] == [("dilute", 1)] * 4


def test_what_only_the_first_block_does_is_done_there(empty_workplace: Workplace) -> None:
    """Errors are measured in block 0 alone, whether or not it gives a pair."""
    empty_workplace.question("errors", ERRORS)
    run(empty_workplace.settings)
    lost = empty_workplace.files("errors", "0")[0]
    lost.unlink()
    assert run(empty_workplace.settings) == 0
    assert "trajectory" in json.loads(lost.read_text())["contenders"][0]["errors"]
    nothing_is_left_to_do(empty_workplace)
