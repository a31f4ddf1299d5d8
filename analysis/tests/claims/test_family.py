"""Claims and their parts are corrected for their number, in one place."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.claims.family import both, corrected
from analysis.claims.missing import is_open, needed
from analysis.claims.outcome import (
    FAILS,
    HOLDS,
    IN_DIRECTION,
    OPEN,
    Outcome,
    Verdict,
    judged,
    told,
)
from analysis.claims.schedules import nothing_faster
from analysis.statistics.looks import ERROR
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
        wrong += any(
            one.verdict in (HOLDS, FAILS) for one in corrected([judged(row, "slower", "") for row in rows])
        )
    assert wrong <= 13, "of 150, 7.5 and two standard errors; 87 if they were not corrected"


def test_a_claim_to_be_faster_does_not_hold_where_its_interval_has_no_part_in_that() -> None:
    row = judge_one(0.02 + 0.002 * np.array([4, -3, 2, -4, 3, -2, 1]))
    assert row.low < 1.02 < row.high
    outcome = judged(row, "faster", "")
    assert (row.verdict, outcome.verdict, told(row, "faster")) == ("inconclusive", FAILS, "not faster")
    assert outcome.p == row.not_faster
    mirrored = judge_one(-0.02 - 0.002 * np.array([4, -3, 2, -4, 3, -2, 1]))
    assert (judged(mirrored, "slower", "").verdict, told(mirrored, "slower")) == (FAILS, "not slower")
    undecided = judged(row, "equivalent", "")
    assert (undecided.verdict, told(row, "equivalent")) == (OPEN, "inconclusive")
    assert "short of slower" in undecided.why or "short of equivalent" in undecided.why


def test_a_refuted_claim_rests_on_the_blocks_of_what_refutes_it() -> None:
    weak, sure = replace(refuted(0.02), blocks=6), replace(refuted(0.001), blocks=9)
    assert both([weak, sure, replace(held(0.01), blocks=4)]).blocks == 9
    assert both([replace(held(0.001), blocks=6), replace(held(0.01), blocks=9)]).blocks == 6


def test_what_is_open_says_how_near_it_is_to_either_outcome() -> None:
    row = judge_one(-0.02 + 0.01 * np.array([4, -3, 2, -4, 3.5, -2, 1]))
    outcome = judged(row, "faster", "")
    assert (outcome.verdict, outcome.against) == (OPEN, row.not_faster)
    assert "short of not faster" in outcome.why or "short of faster" in outcome.why
    near = replace(outcome, p=3.0, against=0.06)
    assert needed(near, 1) < needed(replace(near, against=None), 1)
    assert both([near, replace(outcome, p=0.5, against=0.4)]).against == pytest.approx(0.12)
    assert both([held(0.01), replace(outcome, against=None)]).against is None


@pytest.mark.parametrize("ahead", [-0.035, -0.02])
def test_a_choice_that_is_nearly_beaten_is_nearly_settled(ahead: float) -> None:
    scatter = np.array([0.02, -0.02, 0.015, -0.015, 0.005, -0.005, 0.01, -0.01, 0.0])
    pairs = pd.concat(
        pd.DataFrame({"name": name, "log_ratio": scatter + mean})
        for name, mean in (("near", ahead), ("behind", 0.2), ("far", 0.3))
    )
    outcome = nothing_faster(pairs)
    assert outcome.verdict == OPEN
    assert (needed(outcome, 1) < 50) == (ahead == -0.035)


def test_a_choice_beaten_alone_is_open_among_many_and_goes_on() -> None:
    scatter = np.array([0.02, -0.02, 0.015, -0.015, 0.005, -0.005, 0.01, -0.01, 0.0])
    outcome = nothing_faster(pd.DataFrame({"name": "ahead", "log_ratio": scatter - 0.042}))
    among = corrected([outcome, *[Outcome(OPEN, p=1.0, blocks=9)] * 9])[0]
    assert (outcome.verdict, among.verdict) == (FAILS, OPEN)
    assert is_open(among)


WITHIN = 0.001 * np.array([4, -3, 2, -4, 3, -2, 1, -1, 0])
"""The noise of nine blocks, little enough to tell half of the margin."""


@pytest.mark.parametrize(
    ("centre", "verdict", "said"),
    [
        (-0.04, HOLDS, "faster"),
        (-0.01, IN_DIRECTION, "faster, but by less than 2 %"),
        (0.0, FAILS, "equivalent"),
        (0.01, FAILS, "equivalent"),
        (0.04, FAILS, "slower"),
    ],
)
def test_an_improvement_within_the_margin_is_no_refutation(
    centre: float, verdict: Verdict, said: str
) -> None:
    row = judge_one(centre + WITHIN)
    outcome = judged(row, "faster", "")
    assert (outcome.verdict, told(row, "faster")) == (verdict, said)
    mirrored = judge_one(-centre - WITHIN)
    assert judged(mirrored, "slower", "").verdict == verdict
    assert outcome.p is not None
    assert outcome.p <= ERROR
    assert said != "equivalent" or judged(row, "equivalent", "").verdict == HOLDS


def test_the_interval_that_is_shown_is_the_one_that_tells_less_from_nothing() -> None:
    generator = np.random.default_rng(3)
    seen = set()
    for centre in np.linspace(-0.03, 0.01, 80):
        row = judge_one(generator.normal(centre, 0.006, 9))
        outcome = judged(row, "faster", "")
        in_direction = 1 / 1.02 < row.high < 1
        assert (outcome.verdict == IN_DIRECTION) == in_direction
        assert (outcome.verdict == FAILS) == (row.low > 1 / 1.02 and not in_direction)
        assert (outcome.verdict == HOLDS) == (row.high < 1 / 1.02)
        seen.add(outcome.verdict)
    assert seen == {HOLDS, IN_DIRECTION, FAILS, OPEN}


def test_parts_that_hold_in_direction_make_a_claim_that_does_and_it_is_corrected() -> None:
    in_direction, whole = (judged(judge_one(centre + WITHIN), "faster", "") for centre in (-0.01, -0.04))
    joined = both([whole, in_direction])
    assert (joined.verdict, joined.p) == (IN_DIRECTION, max(whole.p or 0, in_direction.p or 0))
    assert both([in_direction, refuted(0.001)]).verdict == FAILS
    assert both([in_direction, Outcome(OPEN)]).verdict == OPEN
    almost = replace(whole, p=0.04)
    assert corrected([almost, *[held(0.001)] * 3, *[Outcome(OPEN, p=1.0)] * 3])[0].verdict == IN_DIRECTION
    beside = corrected([almost, replace(held(0.001), p=0.03), Outcome(OPEN, p=1.0)])
    assert [one.verdict for one in beside] == [IN_DIRECTION, OPEN, OPEN], "what stands beside gains nothing"
    weak = replace(in_direction, p=0.04)
    among = corrected([weak, *[held(0.001)] * 3, *[Outcome(OPEN, p=1.0)] * 3])[0]
    assert among.verdict == OPEN
    assert "alone it would hold in direction" in among.why
