"""What is compared is measured by one session: what lost its partner is measured again with it."""

import os
import signal
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import pytest

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


def test_an_edited_program_is_measured_again_with_its_partner(
    pair: Workplace, capsys: pytest.CaptureFixture[str]
) -> None:
    pair.question("pair", BY_TWO_PROGRAMS)
    pair.build("clang", "# another one")
    assert run(pair.settings) == 0
    assert "earlier blocks" not in capsys.readouterr().out
    before = pair.records()
    of_the_other = {name: one for name, one in before.items() if one["tags"]["series"] == "four"}
    pair.build("clang", "# edited")
    row = pair.rows()["pair"]
    assert (row.blocks, row.done, row.missing, row.stale, row.alone) == (2, 0, 4, 2, 2)
    assert run(pair.settings) == 0
    told = capsys.readouterr().out
    assert "pair: 2 earlier blocks are without nine (changed, failed or cut off); what lost its" in told
    assert "pair, block 1 of 2" in told
    assert of_the_other.items() <= pair.records().items(), "finished records stay as they are"
    assert whole(pair, "four", "nine") == [2, 3]
    assert len(pair.records()) == 6
    row = pair.rows()["pair"]
    assert (row.blocks, row.done, row.missing, row.alone) == (2, 4, 0, 2)
    done = pair.measured()
    assert run(pair.settings) == 0
    assert pair.measured() == done, "a finished study is left alone"
    assert "earlier blocks" not in capsys.readouterr().out


def test_an_edit_that_is_undone_brings_its_pairs_back(pair: Workplace) -> None:
    pair.question("pair", BY_TWO_PROGRAMS)
    for edit in ("# one", "# other"):
        pair.build("clang", edit)
        assert run(pair.settings) == 0
    done = pair.measured()
    pair.build("clang", "# one")
    assert run(pair.settings) == 0
    assert pair.measured() == done
    assert whole(pair, "four", "nine") == [0, 1]


@pytest.mark.parametrize("text", [PAIR, SWEPT_APART], ids=["in turns", "apart"])
def test_a_point_that_fails_in_one_session_and_not_in_the_next(pair: Workplace, text: str) -> None:
    pair.question("pair", text)
    pair.behave(FAKE_BENCH_CRASHES="nine")
    assert run(pair.settings) == POINTS_FAILED
    assert [set(one) for one in blocks(pair).values()] == [{"four"}] * 2
    assert (pair.rows()["pair"].done, pair.rows()["pair"].failed, pair.rows()["pair"].alone) == (2, 2, 0)
    done = pair.measured()
    assert run(pair.settings) == POINTS_FAILED
    assert pair.measured() == done + 1, "as long as it fails, nothing else is measured again"
    before = pair.records()
    pair.behave(FAKE_BENCH_CRASHES="none")
    assert run(pair.settings) == 0
    assert before.items() <= pair.records().items()
    assert whole(pair, "four", "nine") == [2, 3]
    assert len(pair.records()) == 2 + 1 + 4, "once it was tried alone"
    assert not pair.failures()
    done = pair.measured()
    assert run(pair.settings) == 0
    assert pair.measured() == done


def test_a_point_that_failed_late_keeps_its_earlier_pairs(pair: Workplace) -> None:
    run(pair.settings)
    pair.behave(FAKE_BENCH_CRASHES="nine")
    assert run(replace(pair.settings, blocks=4)) == POINTS_FAILED
    assert whole(pair, "four") == [0, 1, 2, 3]
    pair.behave(FAKE_BENCH_CRASHES="none")
    assert run(replace(pair.settings, blocks=4)) == 0
    assert whole(pair, "four", "nine") == [0, 1, 4, 5]
    row = pair.rows()["pair"]
    assert (row.blocks, row.done, row.missing, row.alone) == (4, 8, 0, 3)


def test_a_failure_of_a_block_that_cannot_be_is_of_no_account(pair: Workplace) -> None:
    pair.behave(FAKE_BENCH_CRASHES="nine")
    run(pair.settings)
    [failure] = pair.results.glob("failures/pair/*/*-b0.json")
    failure.rename(failure.with_name(failure.name.replace("-b0", "-b999999999")))
    pair.behave(FAKE_BENCH_CRASHES="none")
    assert run(pair.settings) == 0
    assert whole(pair, "four", "nine") == [2, 3]


def test_a_block_that_a_kill_cut_through_is_measured_anew(pair: Workplace) -> None:
    pair.question("pair", SWEPT_APART.replace("minimum = 2\nwanted = 2", "minimum = 3\nwanted = 3"))
    pair.behave(FAKE_SECONDS="0.2")
    process = pair.start("run", "--no-figures")
    wait_until_it_measures(pair)
    while len(pair.records()) != 3:
        assert process.poll() is None
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    before = pair.records()
    pair.behave(FAKE_SECONDS="0")
    assert run(pair.settings) == 0
    assert before.items() <= pair.records().items()
    assert whole(pair, "four", "nine") == [0, 2, 3]
    assert len(blocks(pair)[1]) == 1, "it is left as it was"


def test_a_new_series_is_measured_with_all_others(pair: Workplace) -> None:
    run(pair.settings)
    before = pair.records()
    pair.question("pair", PAIR.replace("[blocks]", THIRD))
    assert run(pair.settings) == 0
    assert before.items() <= pair.records().items()
    assert whole(pair, "four", "nine") == [0, 1, 2, 3], "the older pairs still are some"
    assert whole(pair, "four", "nine", "third") == [2, 3]
    pair.question("pair", PAIR)
    done = pair.measured()
    assert run(pair.settings) == 0
    assert pair.measured() == done, "without it nothing is missing"
    assert whole(pair, "four", "nine") == [0, 1, 2, 3]


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
        lambda place: next(place.results.glob("records/pair/*/*-b0.json")).unlink(),
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
    [lost] = [
        path
        for path in empty_workplace.results.glob("records/errors/*/*-b1.json")
        if (tags := empty_workplace.records()[path.name]["tags"])["scene_name"] == "dilute"
        and (tags["series"], tags["x"]) == ("nine", 2)
    ]
    lost.unlink()
    assert run(empty_workplace.settings) == 0
    scenes = Counter(
        (one["tags"]["scene_name"], one["tags"]["block"]) for one in empty_workplace.records().values()
    )
    assert scenes == {
        ("dilute", 0): 4, ("dilute", 1): 3, ("dilute", 2): 4, ("cradle", 0): 4, ("cradle", 1): 4
    }  # fmt: skip


def test_what_only_the_first_block_does_is_done_there(empty_workplace: Workplace) -> None:
    """Errors are measured in block 0 alone, whether or not it gives a pair."""
    empty_workplace.question("errors", ERRORS)
    run(empty_workplace.settings)
    [point] = [one for one in Study(empty_workplace.settings).experiments[0].points
               if (one.scene_name, one.series, one.x) == ("cradle", "nine", 2)]  # fmt: skip
    lost = empty_workplace.results / "records" / "errors" / point.id[:3] / f"{point.id}-b0.json"
    lost.unlink()
    assert run(empty_workplace.settings) == 0
    assert "trajectory" in empty_workplace.records()[lost.name]["errors"]
    of_the_scene = [
        one for one in empty_workplace.records().values() if one["tags"]["scene_name"] == "cradle"
    ]
    assert Counter(one["tags"]["block"] for one in of_the_scene) == {0: 4, 1: 4, 2: 4}
    done = empty_workplace.measured()
    assert run(empty_workplace.settings) == 0
    assert empty_workplace.measured() == done
