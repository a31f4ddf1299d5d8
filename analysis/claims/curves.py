"""Claims about how the time changes over a swept parameter."""

from collections.abc import Sequence
from dataclasses import replace
from math import isfinite, nan

import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import OPEN, Compared, Outcome, judged, no_records, unmeasured
from analysis.claims.schedules import EFFECTS, nothing_faster
from analysis.records.studies import Study
from analysis.statistics.intervals import FEWEST
from analysis.statistics.pairs import log_ratios, ratios_of
from analysis.statistics.trends import Minimum, growth, linearity, minimum
from analysis.statistics.verdicts import EXPONENT, Ratio
from analysis.support.wording import blocks, change, exact, factor, interval, interval_of, listed, number

ONE_POINT = "needs at least two values of the swept parameter"
FOUR_POINTS = "needs four values measured in the same block"


def published_processes(study: Study, experiment: str) -> pd.DataFrame:
    """Return the processes of the published variant, of which the claims speak, or of all if it has none."""
    processes = study.times_of(experiment)
    published = processes[processes["variant"] == "published"]
    return processes if published.empty else published


def grows(evidence: Evidence, experiments: Sequence[str]) -> Outcome:
    """Test that the time grows over the range of each experiment, but for its degenerate ends.

    Those are measured and drawn, and do not decide. How much the time grows is said beside the published
    growth, and does not decide either: the claim is a direction.
    """
    return both([_grows(evidence, experiment) for experiment in experiments])


def _grows(evidence: Evidence, experiment: str) -> Outcome:
    curve = evidence.published.without_degenerate(experiment, evidence.published.curve(experiment))
    published = growth(curve).change.ratio if curve["x"].nunique() > 1 else nan
    what, margin = experiment.replace("_", " "), evidence.margin(experiment)
    nothing = (unmeasured(what, published, margin),)
    processes = published_processes(evidence.study, experiment)
    if processes.empty:
        return replace(no_records(experiment), effects=nothing)
    kept = evidence.published.without_degenerate(experiment, processes)
    if kept["x"].nunique() < 2:
        return Outcome(OPEN, why=ONE_POINT, effects=nothing)
    trend, name = growth(kept, margin), processes["x_name"].iloc[0]
    without = sorted(set(processes["x"]) - set(kept["x"]))
    measured = (
        f"{change(trend.change)} of time from {name} = {exact(trend.first)} to {exact(trend.last)}, "
        f"exponent {interval(trend.exponent)}, {blocks(trend.change)}"
    ) + (f" (without the degenerate {name} = {listed(without)})" if without else "")
    figures = (_growth_compared(evidence, experiment, kept),)
    effect = replace(trend.change, what=what, published=published)
    return replace(judged(trend.change, "grows", measured, figures), effects=(effect,))


def _growth_compared(evidence: Evidence, experiment: str, processes: pd.DataFrame) -> Compared:
    """Return by which factor the time grows from the first to the last x, each over its own range."""
    curve = evidence.published.curve(experiment)
    theirs = evidence.published.without_degenerate(experiment, curve)
    said = [_factor(one) if one["x"].nunique() > 1 else "–" for one in (theirs, processes)]
    return f"growth of the time over {processes['x_name'].iloc[0]}", said[0], said[1]


def _factor(processes: pd.DataFrame) -> str:
    """Return the factor of the times and that of x, e.g. `×5.67 from 10 000 to 100 000`."""
    ends = processes["x"].min(), processes["x"].max()
    both = len(ratios_of(processes, "x", *ends))
    trend = growth(processes).change.ratio if both else nan
    return f"{factor(trend)} from {exact(ends[0])} to {exact(ends[1])}"


def linear(evidence: Evidence, experiment: str, within: tuple[float, float]) -> Outcome:
    """Test that the time is a straight line over x: its exponent, over any fixed cost, is within bounds."""
    processes = published_processes(evidence.study, experiment)
    curve = evidence.published.curve(experiment)
    if processes.empty:
        return replace(no_records(experiment), effects=(_exponent(curve, within),))
    outcome = _linear(processes, curve, within)
    grown = _growth_compared(evidence, experiment, processes)
    return replace(outcome, figures=(*outcome.figures, grown))


def _linear(processes: pd.DataFrame, published: pd.DataFrame, within: tuple[float, float]) -> Outcome:
    nothing = _exponent(published, within)
    line, name = linearity(processes, nothing.within), processes["x_name"].iloc[0]
    effects = (replace(line, published=nothing.published),)
    if not line.is_measured:
        return Outcome(OPEN, why=FOUR_POINTS, effects=effects)
    measured = (
        f"time = fixed + slope × {name}^e with e = {interval_of(line, 'ratio')}, "
        f"taken as linear between {within[0]} and {within[1]}"
    )
    figures = ((f"exponent over {name}", number(nothing.published), interval_of(line, "ratio")),)
    why = "the exponent's interval reaches across a bound: more blocks would decide"
    return replace(judged(line, "linear", measured, figures, why), effects=effects)


def _exponent(published: pd.DataFrame, within: tuple[float, float]) -> Ratio:
    """Return the exponent of the published curve as an effect that was not measured here."""
    low, high = within
    return Ratio(what=EXPONENT, published=linearity(published, (low, high)).ratio, within=(low, high))


def falls_then_rises(evidence: Evidence, experiment: str, least: float | None = None) -> Outcome:
    """Test that the time falls to some x inside the range and rises from there; with `least` also that
    nowhere in the range it is less than there, by more than the margin.
    """
    processes = published_processes(evidence.study, experiment)
    curve = evidence.published.curve(experiment)
    if processes.empty:
        return replace(no_records(experiment), effects=_ends(curve, None))
    if processes["x"].nunique() < 3:
        return Outcome(OPEN, why="needs at least three values of the swept parameter")
    margin = evidence.margin(experiment)
    shape = _shape(processes, curve, margin)
    return shape if least is None else both([shape, _least_at(processes, least, margin)])


def _shape(processes: pd.DataFrame, published: pd.DataFrame, margin: float) -> Outcome:
    ours = minimum(processes, margin)
    name = processes["x_name"].iloc[0]
    measured = (
        f"least at {name} = {exact(ours.lowest)}{_break(ours)}; against it {change(ours.fall)} at "
        f"the smallest and {change(ours.rise)} at the largest {name}, {blocks(ours.fall)}"
    )
    theirs = minimum(published)
    figures = (
        (f"least time at {name}", exact(theirs.lowest), exact(ours.lowest)),
        (f"smallest {name} against it", factor(theirs.fall.ratio), factor(ours.fall.ratio)),
        (f"largest {name} against it", factor(theirs.rise.ratio), factor(ours.rise.ratio)),
    )
    outcome = judged(ours.fall, "falls then rises", measured, figures)
    return replace(outcome, why=outcome.why or ours.fall.verdict, effects=_ends(published, ours))


def _ends(published: pd.DataFrame, ours: Minimum | None) -> tuple[Ratio, ...]:
    """Return the times at both ends of the range against the least."""
    theirs = minimum(published) if len(published) else None
    effects = []
    for end, side in (("smallest", "fall"), ("largest", "rise")):
        row = getattr(ours, side) if ours else Ratio()
        told = getattr(theirs, side).ratio if theirs else nan
        effects.append(replace(row, what=f"at the {end}", published=told))
    return tuple(effects)


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
    theirs = _from_the_lowest(evidence.published.curve(experiment))
    if not spike.measured:
        return replace(spike, effects=(*spike.effects, _exponent(theirs, within)))
    ours = _from_the_lowest(published_processes(evidence.study, experiment))
    return both([spike, _linear(ours, theirs, within)])


def _from_the_lowest(processes: pd.DataFrame) -> pd.DataFrame:
    """Return the processes from the x with the least median on."""
    return processes[processes["x"] >= processes.groupby("x")["steps_seconds"].median().idxmin()]
