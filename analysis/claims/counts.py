"""The claim about work that is counted, not timed."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from analysis.claims.effects import effect_of
from analysis.claims.entry import Evidence
from analysis.claims.outcome import OPEN, TOO_FEW, Compared, Outcome, directed, judged, no_records, told
from analysis.statistics.pairs import PAIR, ratios_of
from analysis.statistics.verdicts import judge_one
from analysis.support.wording import blocks, change, count
from support.vocabulary import COUNTS

OF_COUNTS = {"faster": "fewer", "slower": "more", "not faster": "not fewer"}
"""The verdicts on a ratio in words for a number of things; the others are the same."""


def fewer_wasted_attempts(
    evidence: Evidence, experiment: str, axis: str, candidate: str, reference: str
) -> Outcome:
    """Test that `candidate` wastes fewer attempts: pairs asked whether they collide that then do not.

    A count is the same in each repetition, so that its repetitions are the seeds of the scene: the interval
    is over them. The question says how many, so that they are looked at once. Attempts, resolves and the
    time, where it was measured, stand beside, and do not decide.
    """
    runs = evidence.study.runs_of(experiment)
    runs = runs[runs["x_name"] == "seed"].assign(
        wasted_attempts=lambda one: one["pair_attempts"] - one["pair_resolves"]
    )
    before, after = (runs[runs[axis] == value] for value in (reference, candidate))
    if before.empty or after.empty:
        return no_records(experiment, "a sweep of seeds")
    if runs["pair_attempts"].isna().any():
        return Outcome(OPEN, why="attempts were not counted: whole processes tell none")
    rows = {
        value: directed(_over_seeds(before, after, value), once=True)
        for value in ("wasted_attempts", "pair_attempts", "pair_resolves")
    }
    times = evidence.study.times_of(experiment)
    what = {value: value.replace("_", " ") for value in rows}
    said = "; ".join(f"{change(row)} of {what[value]} ({_told(row)})" for value, row in rows.items())
    wasted = rows["wasted_attempts"]
    measured = f"{candidate} against {reference}, over {count(wasted['blocks'], 'seed')}: {said}"
    figures = [Compared(what[value], "–", change(row)) for value, row in rows.items()]
    if not (runs["question_kind"] == COUNTS).all():
        # The mean over the seeds of each block: what a block suffers, all its seeds do.
        pairs = ratios_of(times, axis, reference, candidate, match=("x",))
        row = judge_one(pairs.groupby(PAIR)["log_ratio"].mean())
        measured += f"; {change(row)} of time, {blocks(row)} ({row['verdict']})"
        figures.append(Compared("time", "–", change(row)))
    unsettled = TOO_FEW.replace("blocks or a quieter machine", "seeds")
    found = judged(wasted, "faster", measured, tuple(figures), unsettled, unit="seed")
    effect = effect_of("wasted attempts", wasted)
    return replace(found, blocks=0, effects=(effect,))  # more blocks bring no further seed


def _told(row: Mapping[str, Any]) -> str:
    verdict = told(row, "faster")
    return OF_COUNTS.get(verdict, verdict.replace("faster", "fewer"))


def _over_seeds(before: pd.DataFrame, after: pd.DataFrame, value: str) -> pd.Series:
    """Return ln(after / before) of each seed that both have; a count of 0 has no ratio."""
    counted = [side.groupby("x")[value].median() for side in (before, after)]
    ratios = np.log(counted[1] / counted[0])
    return ratios.replace([np.inf, -np.inf], np.nan).dropna()
