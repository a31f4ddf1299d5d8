"""Claims about how the time changes over a swept parameter."""

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite, nan

import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import OPEN, Outcome, judged, no_records, unmeasured
from analysis.claims.schedules import EFFECTS, nothing_faster
from analysis.statistics.intervals import FEWEST
from analysis.statistics.pairs import log_ratios
from analysis.statistics.trends import Minimum, growth, linearity, minimum
from analysis.statistics.verdicts import EXPONENT, Ratio
from analysis.support.wording import blocks, change, exact, interval, interval_of, listed, number

ONE_POINT = "needs at least two values of the swept parameter"
FOUR_POINTS = "needs four values measured in the same block"
BETWEEN = "the exponent's interval reaches across a bound: more blocks would decide"


def grows(evidence: Evidence, experiments: Sequence[str]) -> Outcome:
    """Test that the time grows over the range of each experiment, but for its degenerate ends.

    Those are measured and drawn, and do not decide. How much the time grows is said beside the published
    growth, and does not decide either: the claim is a direction.
    """
    return both([_grows(evidence, experiment) for experiment in experiments])


def _grows(evidence: Evidence, experiment: str) -> Outcome:
    curves = evidence.curves(experiment)
    published, kept = (evidence.published.without_degenerate(experiment, one) for one in curves)
    margin, processes = evidence.margin(experiment), curves[1]
    theirs = growth(published).change.ratio if published["x"].nunique() > 1 else nan
    nothing = unmeasured(experiment.replace("_", " "), theirs, margin)
    if processes.empty:
        return no_records(experiment, effects=[nothing])
    if kept["x"].nunique() < 2:
        return Outcome(OPEN, why=ONE_POINT, effects=(nothing,))
    trend, name = growth(kept, margin), processes["x_name"].iloc[0]
    without = sorted(set(processes["x"]) - set(kept["x"]))
    measured = (
        f"{change(trend.change)} of time from {name} = {exact(trend.first)} to {exact(trend.last)}, "
        f"exponent {interval(trend.exponent)}, {blocks(trend.change)}"
    ) + (f" (without the degenerate {name} = {listed(without)})" if without else "")
    return judged(trend.change.told_as(nothing), "grows", measured)


def linear(evidence: Evidence, experiment: str, within: tuple[float, float]) -> Outcome:
    """Test that the time is a straight line over x: its exponent, over any fixed cost, is within bounds."""
    published, processes = evidence.curves(experiment)
    nothing = _exponent(published, within)
    return no_records(experiment, effects=[nothing]) if processes.empty else _linear(processes, nothing)


def _exponent(published: pd.DataFrame, within: tuple[float, float]) -> Ratio:
    """Return the exponent of the published curve as an effect that was not measured here."""
    low, high = within
    return Ratio(what=EXPONENT, published=linearity(published, (low, high)).ratio, within=(low, high))


def _linear(processes: pd.DataFrame, nothing: Ratio) -> Outcome:
    line = linearity(processes, nothing.within).told_as(nothing)
    if not line.is_measured:
        return Outcome(OPEN, why=FOUR_POINTS, effects=(line,))
    low, high = nothing.within
    measured = (
        f"time = fixed + slope × {processes['x_name'].iloc[0]}^e with e = {interval_of(line, 'ratio')}, "
        f"taken as linear between {low} and {high}"
    )
    return judged(line, "linear", measured, BETWEEN)


def falls_then_rises(evidence: Evidence, experiment: str, least: float | None = None) -> Outcome:
    """Test that the time falls to some x inside the range and rises from there; with `least` also that
    nowhere in the range it is less than there, by more than the margin.
    """
    published, processes = evidence.curves(experiment)
    if processes.empty:
        return no_records(experiment, effects=_ends(published, None))
    if processes["x"].nunique() < 3:
        return Outcome(OPEN, why="needs at least three values of the swept parameter")
    margin = evidence.margin(experiment)
    ours, name = minimum(processes, margin), processes["x_name"].iloc[0]
    measured = (
        f"least at {name} = {exact(ours.lowest)}{_break(ours)}; against it {change(ours.fall)} at "
        f"the smallest and {change(ours.rise)} at the largest {name}, {blocks(ours.fall)}"
    )
    shape = judged(ours.fall, "falls then rises", measured)
    shape = replace(shape, why=shape.why or ours.fall.verdict, effects=_ends(published, ours))
    return shape if least is None else both([shape, _least_at(processes, least, margin)])


def _ends(published: pd.DataFrame, ours: Minimum | None) -> tuple[Ratio, ...]:
    """Return the times at both ends of the range against the least."""
    sides = (("at the smallest", "fall"), ("at the largest", "rise"))
    theirs = minimum(published) if len(published) else None
    return tuple(
        replace(getattr(ours, side, Ratio()), what=end, published=getattr(theirs, side, Ratio()).ratio)
        for end, side in sides
    )


def _break(least: Minimum) -> str:
    """Return the break point in words; nothing if it could not be fitted."""
    found = least.break_point
    if pd.isna(found.estimate):
        return ""
    if not isfinite(found.low):
        return f", break point {number(found.estimate)} (an interval needs {FEWEST} blocks)"
    return f", break point {interval(found)}"


def _least_at(processes: pd.DataFrame, least: float, margin: float) -> Outcome:
    """Test that no other x is faster than the one said to be the least; several may be within the margin."""
    name = processes["x_name"].iloc[0]
    chosen, others = processes[processes["x"] == least], processes[processes["x"] != least]
    if chosen.empty:
        return Outcome(OPEN, why=f"needs {name} = {exact(least)}")
    pairs = pd.concat(
        log_ratios(chosen, group).assign(name=f"{name} {exact(float(x))}") for x, group in others.groupby("x")
    )
    if pairs.empty:
        return Outcome(OPEN, why=f"needs another {name} in a block with {exact(least)}")
    found = nothing_faster(pairs, margin)
    (best,) = found.effects
    measured = f"{best.what} against {exact(least)}: {change(best)} of time, {blocks(best)}"
    return replace(found, measured=measured, effects=(replace(best, what=EFFECTS[0]),))


def spike_then_linear(evidence: Evidence, experiment: str, within: tuple[float, float]) -> Outcome:
    """Test for a fall at the small end of x and a straight line from the lowest point on."""
    spike = falls_then_rises(evidence, experiment)
    published, processes = map(_from_the_lowest, evidence.curves(experiment))
    nothing = _exponent(published, within)
    if not spike.measured:
        return replace(spike, effects=(*spike.effects, nothing))
    return both([spike, _linear(processes, nothing)])


def _from_the_lowest(processes: pd.DataFrame) -> pd.DataFrame:
    """Return the processes from the x with the least median on."""
    medians = processes.groupby("x")["steps_seconds"].median()
    return processes if medians.empty else processes[processes["x"] >= medians.idxmin()]
