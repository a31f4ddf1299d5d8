"""How a study shares out its time: first blocks first, then more of them while the budget lasts."""

from dataclasses import replace

from experiments.run.session import run
from experiments.tests.conftest import PAIR, Workplace


def test_a_first_block_of_everything_comes_before_a_second_of_anything(workplace: Workplace) -> None:
    run(workplace.settings)
    words = [call["words"] for call in workplace.calls() if "--tag" in call["words"]]
    blocks = ["block=0" in one for one in words if "experiment=control" not in one]
    assert blocks == [True] * 5 + [False] * 5


def test_the_least_blocks_are_promised_until_more_are_decided(workplace: Workplace) -> None:
    workplace.question("pair", PAIR.replace("wanted = 2", "wanted = 4"))
    run(workplace.settings)
    planned = {
        (one["tags"]["block"], one["tags"]["blocks_planned"]) for one in workplace.records("pair").values()
    }
    assert planned == {(0, 2), (1, 2), (2, 4), (3, 4)}


def test_time_spent_on_other_things_leaves_less_for_more_blocks(workplace: Workplace) -> None:
    workplace.question("pair", PAIR.replace("wanted = 2", "wanted = 40"))
    workplace.behave(FAKE_SECONDS="0.05", FAKE_CHECK_SECONDS="0.8")
    run(replace(workplace.settings, budget_seconds=2.0, figures=False))
    assert len(workplace.records("pair")) == 2 * 2, "nothing is left after the checks and the least blocks"


def test_a_larger_budget_goes_on_with_what_is_there(workplace: Workplace) -> None:
    workplace.question("pair", PAIR.replace("wanted = 2", "wanted = 6"))
    run(replace(workplace.settings, budget_seconds=0.1, figures=False))
    before = workplace.records("pair")
    assert len(before) == 2 * 2, "the least"
    run(replace(workplace.settings, figures=False))
    assert len(workplace.records("pair")) == 2 * 2, "decided is decided"
    run(replace(workplace.settings, budget_seconds=600.0, figures=False))
    assert len(workplace.records("pair")) == 2 * 6
    assert before.items() <= workplace.records("pair").items()
