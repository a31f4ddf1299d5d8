"""Claims about one ratio: of two choices, of counts, of the phases of a step.

Each is ln(candidate / reference) a block, or a seed, and the verdict on that. One rule for ties: where the
interval has no part in faster by more than the margin, the claim does not hold, be the two equivalent or the
other one faster. But where the interval lies wholly below 0 it holds in direction, by however little: the
margin is ours, and no source of a claim stated it.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import nan

import numpy as np
import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import OPEN, TOO_FEW, Outcome, judged, no_records, told, unmeasured
from analysis.statistics.looks import ERROR
from analysis.statistics.pairs import PAIR, log_ratios, ratios_of
from analysis.statistics.verdicts import Ratio, judge_one, judge_pairs
from analysis.support.wording import blocks, change, count, number, share
from support.vocabulary import COUNTS

OF_COUNTS = {"faster": "fewer", "slower": "more", "not faster": "not fewer"}
"""The verdicts on a ratio in words for a number of things; the others are the same."""
VARIANTS = ["published", "self_contained_off"]


def pair(
    evidence: Evidence,
    experiments: Sequence[str],
    axis: str,
    candidate: str,
    reference: str,
    expected: str,
) -> Outcome:
    """Test that `candidate` is faster than (or equivalent to) `reference` on an axis; in a sweep, at the
    greatest value of its parameter.
    """
    sides = (axis, candidate, reference)
    names = [one.rpartition("_")[2] if len(experiments) > 1 else "" for one in experiments]
    return both([_one_pair(evidence, *one, sides, expected) for one in zip(experiments, names, strict=True)])


def _one_pair(
    evidence: Evidence,
    experiment: str,
    name_of: str,
    sides: tuple[str, str, str],
    expected: str,
) -> Outcome:
    """Test one experiment; its effect is called so, or after the two sides."""
    axis, candidate, reference = sides
    # As the study tells it, of means; `Published.ratio` is the middle of its three runs.
    means = evidence.published.experiment(experiment).groupby("series")["seconds"].mean()
    known = {candidate, reference} <= set(means.index)
    published = float(means[candidate] / means[reference]) if known else nan
    margin, what = evidence.margin(experiment), f"{candidate} against {reference}"
    nothing = unmeasured(name_of or what, published, margin)
    times = evidence.study.times_of(experiment)
    if times.empty:
        return no_records(experiment, effects=[nothing])
    chosen, against = (times[times[axis] == value] for value in (candidate, reference))
    name, shared = times["x_name"].iloc[0], sorted(set(chosen["x"]) & set(against["x"]))
    if not shared:
        lacking = [f"{axis} = {one}" for one in (candidate, reference) if not (times[axis] == one).any()]
        needed = " and ".join(lacking) or f"{candidate} and {reference} at the same {name}"
        return no_records(experiment, needed, [nothing])
    pairs = log_ratios(against, chosen, match=("x",))
    row = judge_pairs(pairs[pairs["x"] == shared[-1]], margin).told_as(nothing)
    measured = f"{what}: {change(row)} of time, {blocks(row)} ({told(row, expected)})"
    return judged(row, expected, measured)


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
        value.replace("_", " "): judge_one(_over_seeds(before, after, value), once=True)
        for value in ("wasted_attempts", "pair_attempts", "pair_resolves")
    }
    said = "; ".join(f"{change(row)} of {what} ({_of_counts(row)})" for what, row in rows.items())
    wasted = rows["wasted attempts"]
    measured = f"{candidate} against {reference}, over {count(wasted.blocks, 'seed')}: {said}"
    if not (runs["question_kind"] == COUNTS).all():
        # The mean over the seeds of each block: what a block suffers, all its seeds do.
        pairs = ratios_of(evidence.study.times_of(experiment), axis, reference, candidate, match=("x",))
        row = judge_one(pairs.groupby(PAIR)["log_ratio"].mean())
        measured += f"; {change(row)} of time, {blocks(row)} ({row.verdict})"
    unsettled = TOO_FEW.replace("blocks or a quieter machine", "seeds")
    wasted = replace(wasted, what="wasted attempts")
    # More blocks bring no further seed.
    return replace(judged(wasted, "faster", measured, unsettled, unit="seed"), blocks=0)


def _of_counts(row: Ratio) -> str:
    verdict = told(row, "faster")
    return OF_COUNTS.get(verdict, verdict.replace("faster", "fewer"))


def _over_seeds(before: pd.DataFrame, after: pd.DataFrame, value: str) -> pd.Series:
    """Return ln(after / before) of each seed that both have; a count of 0 has no ratio."""
    counted = [side.groupby("x")[value].median() for side in (before, after)]
    ratios = np.log(counted[1] / counted[0])
    return ratios.replace([np.inf, -np.inf], np.nan).dropna()


_NOTHING = 1e-3
"""Of a step: where a disturbed process makes it less, it counts as this, which is far below all others."""


def phase_dominates(evidence: Evidence, experiment: str, phase: str, early: str) -> Outcome:
    """Test that the published variant spends more than half of a step in `phase`, with what it does of it
    early, in the phase `early`.

    Early (self-contained) resolves cannot be timed apart from the search around them. Without them `early` is
    the search alone: what it takes longer with them, in the same block, is theirs. This takes the search to
    last as long with them as without. The ratio tested is that of resolving to all the rest.

    Two ratios are judged, each with half of the error: that of the later resolves, a share within one
    process, and that of all of them. Since what is done early only adds, the claim holds where either is more
    than half: the surer one is told.
    """
    (phases,) = evidence.study.of(experiment, "phases")
    walls = phases[phases["variant"].isin(VARIANTS)].pivot_table(
        index=PAIR, columns=["variant", "phase"], values="wall_seconds"
    )
    for variant in VARIANTS:
        if not {(variant, phase), (variant, early)} <= set(walls.columns):
            return no_records(experiment, f"{phase} and {early} of the variant {variant}")
    with_early, without = (walls.dropna()[variant] for variant in VARIANTS)
    whole, resolved_early = with_early.sum(axis=1), with_early[early] - without[early]
    late = with_early[phase]
    resolving = (late + resolved_early).clip(lower=_NOTHING * whole)
    parts = pd.DataFrame({"late": late, early: with_early[early], "early": resolved_early, "all": resolving})
    part = parts.div(whole, axis=0).median().map(share)
    late_row, row = (
        judge_one(np.log(one / (whole - one)), error=ERROR / 2).scaled(2) for one in (late, resolving)
    )
    # Later ones of less than half refute nothing.
    is_surer = row.verdict != "slower" and _above(late_row) <= min(ERROR, _above(row))
    if late_row.verdict == "slower" or is_surer:
        row = late_row
        of = f"{part['late']} of a step in {phase} alone, without what is done early in {early}"
    else:
        late_and_early = f"{part['late']} in {phase} and {part['early']} early"
        of = f"{part['all']} of a step: {late_and_early}, of the {part[early]} of {early}"
    measured = (
        f"resolving takes {of}; the ratio to all the rest is {number(row.ratio)} [{number(row.low)}, "
        f"{number(row.high)}], {blocks(row)}"
    )
    return judged(replace(row, what="resolving against the rest"), "slower", measured)


def _above(row: Ratio) -> float:
    assert row.any_slower is not None
    return row.any_slower
