"""What is compared is measured by one session: what lost its partner is measured again with it."""

import json
from collections.abc import Callable

import pytest

from experiments.results.store import keys_of
from experiments.run.session import run
from experiments.run.study import POINTS_FAILED, Study
from experiments.tests.conftest import PAIR, PAIR_APART, PAIR_OF_BUILDS, Workplace


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
    pair.question("pair", PAIR_OF_BUILDS)
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


@pytest.mark.parametrize("text", [PAIR, PAIR_APART], ids=["in turns", "apart"])
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


def test_a_file_of_another_name_than_its_content_is_of_no_account(pair: Workplace) -> None:
    run(pair.settings)
    far = pair.results / "records" / "pair" / "b999999999"
    far.mkdir()
    for path in pair.files("pair", "0"):
        path.rename(far / path.name.replace("-b0", "-b999999999"))
    assert pair.rows()["pair"].stale == 2
    assert run(pair.settings) == 0
    assert whole(pair, "four", "nine") == [0, 1]


def test_a_new_series_is_measured_with_all_others(pair: Workplace) -> None:
    run(pair.settings)
    before = pair.records()
    third = '[[series]]\nname = "third"\nvariant = "row"\n\n[blocks]'
    pair.question("pair", PAIR.replace("[blocks]", third))
    assert run(pair.settings) == 0
    assert whole(pair, "four", "nine", "third") == [0, 1]
    pair.question("pair", PAIR)
    nothing_is_left_to_do(pair)
    assert pair.records() == before, "without it what was measured before fits again"


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
    pair.question("pair", PAIR_OF_BUILDS)
    pair.build("clang", "# another one")
    run(pair.settings)
    harm(pair)
    run(pair.settings)
    plan = Study(pair.settings).store.note("plan.json")["paper"]["pair"]
    assert (plan["blocks"], plan["runs"]) == (2, len(pair.records()))
