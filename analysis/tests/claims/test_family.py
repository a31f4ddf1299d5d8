"""Claims and their parts are corrected for their number, in one place."""

import numpy as np
import pytest

from analysis.claims.family import both, corrected
from analysis.claims.outcome import FAILS, HOLDS, OPEN, Outcome, judged
from analysis.statistics.verdicts import judge_one


def held(p: float) -> Outcome:
    return Outcome(HOLDS, p=p)


def refuted(p: float) -> Outcome:
    return Outcome(FAILS, why="slower", p=p)


def test_a_claim_holds_with_the_greatest_p_value_of_its_parts() -> None:
    joined = both([held(0.01), held(0.04)])
    assert (joined.verdict, joined.p) == (HOLDS, 0.04)


def test_one_of_several_parts_refutes_only_if_corrected_for_their_number() -> None:
    assert both([refuted(0.03)]).verdict == FAILS
    joined = both([refuted(0.03), held(0.001)])
    assert joined.verdict == OPEN
    assert joined.why.replace("\u00a0", " ") == (
        "alone it would not hold (p = 0.030), corrected for 2 parts it is not settled: "
        "more blocks would decide"
    )
    assert both([refuted(0.02), held(0.001), Outcome(OPEN)]).p == pytest.approx(0.04)


def test_claims_are_corrected_among_each_other_but_for_those_that_cannot_be_tested() -> None:
    outcomes = corrected([held(0.02), refuted(0.04), held(0.001), Outcome(OPEN, p=0.3), Outcome(OPEN)])
    assert [one.verdict for one in outcomes] == [OPEN, OPEN, HOLDS, OPEN, OPEN]
    assert "corrected for 4\u00a0claims" in outcomes[0].why
    assert corrected([held(0.02), Outcome(OPEN)])[0].verdict == HOLDS


def test_of_seventeen_claims_on_their_border_any_is_decided_in_one_study_of_twenty() -> None:
    generator = np.random.default_rng(1)
    wrong = 0
    for _ in range(150):
        rows = [judge_one(np.log(1.02) + generator.normal(0, 0.01, 7)) for _ in range(17)]
        wrong += any(one.verdict != OPEN for one in corrected([judged(row, "slower", "") for row in rows]))
    assert wrong <= 13, "of 150, 7.5 and two standard errors; 87 if they were not corrected"


@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_few_blocks_refute_nothing_and_say_what_is_missing(blocks: int) -> None:
    outcome = judged(judge_one([0.5] * blocks), "faster", "")
    assert (outcome.verdict, outcome.p) == (OPEN, None)
    assert "a verdict needs at least 4" in outcome.why
