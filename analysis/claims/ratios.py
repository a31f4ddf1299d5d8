"""Claims that one choice is faster than, or as fast as, another.

One rule for ties: where the interval has no part in faster by more than the margin, the claim does not hold,
be the two equivalent or the other one faster. But where the interval lies wholly below 0 it holds in
direction, by however little: the margin is ours, and no source of a claim stated it.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import nan
from typing import Any

import pandas as pd

from analysis.claims.effects import effect_of
from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import OPEN, Compared, Outcome, directed, judged, no_records, told
from analysis.statistics.pairs import log_ratios
from analysis.support.wording import blocks, change, exact, percent


def pair(
    evidence: Evidence,
    experiments: Sequence[str],
    axis: str,
    candidate: str,
    reference: str,
    expected: str,
    at: float | None = None,
) -> Outcome:
    """Test that `candidate` is faster than (or equivalent to) `reference` on an axis; in a sweep, at the
    value `at` of its parameter and nowhere else.
    """
    sides = (axis, candidate, reference)
    found = []
    for name in experiments:
        outcome = _one_pair(evidence, name, sides, expected, at)
        if len(experiments) > 1:
            told = name.rpartition("_")[2]
            outcome = replace(outcome, effects=tuple(replace(one, what=told) for one in outcome.effects))
        found.append(outcome)
    return both(found)


def _one_pair(
    evidence: Evidence, experiment: str, sides: tuple[str, str, str], expected: str, at: float | None
) -> Outcome:
    _, candidate, reference = sides
    row, outcome = _tested(evidence, experiment, sides, expected, at)
    what = f"{candidate} against {reference}"
    # As the study tells it, of means; `ratio` is the middle of its three runs.
    means = evidence.published.experiment(experiment).groupby("series")["seconds"].mean()
    known = {candidate, reference} <= set(means.index)
    published = float(means[candidate] / means[reference]) if known else nan
    return replace(outcome, effects=(effect_of(what, row, published, evidence.margin(experiment)),))


def _tested(
    evidence: Evidence, experiment: str, sides: tuple[str, str, str], expected: str, at: float | None
) -> tuple[dict[str, Any] | None, Outcome]:
    """Return the row that decides, if it was measured, and the outcome."""
    axis, candidate, reference = sides
    times = evidence.study.times_of(experiment)
    if times.empty:
        return None, no_records(experiment)
    chosen, against = (times[times[axis] == value] for value in (candidate, reference))
    missing = [name for name, side in ((candidate, chosen), (reference, against)) if side.empty]
    if missing:
        return None, no_records(experiment, " and ".join(f"{axis} = {name}" for name in missing))
    name, shared = times["x_name"].iloc[0], sorted(set(chosen["x"]) & set(against["x"]))
    if not shared:
        return None, no_records(experiment, f"{candidate} and {reference} at the same {name}")
    rows = {x: _judged(against, chosen, x, evidence.margin(experiment)) for x in shared}
    theirs = evidence.published.ratio(experiment, candidate, reference)
    published = percent(theirs["ratio"] - 1) if theirs else "–"
    what = f"time of {candidate} against {reference}"
    figures = tuple(
        Compared(f"{what}, {experiment if at is None else f'{name} = {exact(x)}'}", published, change(row))
        for x, row in rows.items()
    )
    if at is not None and at not in rows:
        return None, Outcome(OPEN, why=f"needs {name} = {exact(at)}", figures=figures)
    where, row = ("", rows[shared[-1]]) if at is None else (f" at {name} = {exact(at)}", rows[at])
    said = told(row, expected)
    measured = f"{candidate} against {reference}{where}: {change(row)} of time, {blocks(row)} ({said})"
    return row, judged(row, expected, measured, figures)


def _judged(against: pd.DataFrame, chosen: pd.DataFrame, x: float, margin: float) -> dict[str, Any]:
    pairs = log_ratios(against[against["x"] == x], chosen[chosen["x"] == x])
    return directed(pairs["log_ratio"], margin, biases=pairs["bias"], stops=pairs["stops"])
