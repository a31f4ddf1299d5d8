"""Claims about how the time changes over a swept parameter."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from analysis.claims.outcome import FAILS, HOLDS, OPEN, TOO_FEW, Outcome, both, no_records
from analysis.records.studies import Study
from analysis.statistics.pairs import log_ratios, process_medians
from analysis.statistics.trends import growth, linearity, turn
from analysis.statistics.verdicts import ERROR, MARGIN, holm, judge_one
from analysis.support.wording import blocks, change, exact, interval

ONE_POINT = "needs at least two values of the swept parameter"
FOUR_POINTS = "needs four values measured in the same block"


def _processes(study: Study, experiment: str) -> pd.DataFrame:
    """Return the processes of the published variant, of which the claims speak, or of all if it has none."""
    processes = process_medians(study.times_of(experiment))
    published = processes[processes["variant"] == "published"]
    return processes if published.empty else published


def grows(study: Study, experiments: Sequence[str]) -> Outcome:
    """Test that the time grows over the whole range of each experiment."""
    return both([_grows(study, experiment) for experiment in experiments])


def _grows(study: Study, experiment: str) -> Outcome:
    processes = _processes(study, experiment)
    if processes.empty:
        return no_records(experiment)
    if processes["x"].nunique() < 2:
        return Outcome(OPEN, why=ONE_POINT)
    trend = growth(processes)
    name = processes["x_name"].iloc[0]
    measured = (
        f"{change(trend.change)} of time from {name} = {exact(trend.first)} to {exact(trend.last)}, "
        f"exponent {interval(trend.exponent)}, {blocks(trend.change)}"
    )
    if trend.verdict == "inconclusive":
        return Outcome(OPEN, measured, TOO_FEW)
    return Outcome(HOLDS if trend.verdict == "grows" else FAILS, measured)


def linear(study: Study, experiment: str, within: tuple[float, float]) -> Outcome:
    """Test that the time is a straight line over x: the exponent of x, over any fixed cost, within the
    bounds.
    """
    processes = _processes(study, experiment)
    return no_records(experiment) if processes.empty else _linear(processes, within)


def _linear(processes: pd.DataFrame, within: tuple[float, float]) -> Outcome:
    line = linearity(processes, within)
    if pd.isna(line.exponent.estimate):
        return Outcome(OPEN, why=FOUR_POINTS)
    measured = (
        f"time = fixed + slope × {processes['x_name'].iloc[0]}^e with e = {interval(line.exponent)}, "
        f"taken as linear between {within[0]} and {within[1]}"
    )
    if line.verdict == "inconclusive":
        return Outcome(
            OPEN, measured, "the exponent's interval reaches across a bound: more blocks would decide"
        )
    return Outcome(HOLDS if line.verdict == "linear" else FAILS, measured)


def falls_then_rises(study: Study, experiment: str) -> Outcome:
    """Test that the time falls to some x inside the range and rises from there."""
    processes = _processes(study, experiment)
    if processes.empty:
        return no_records(experiment)
    if processes["x"].nunique() < 3:
        return Outcome(OPEN, why="needs at least three values of the swept parameter")
    turning = turn(processes)
    name = processes["x_name"].iloc[0]
    where = "" if pd.isna(turning.break_point.estimate) else f", break point {interval(turning.break_point)}"
    measured = (
        f"least at {name} = {exact(turning.lowest)}{where}; against it {change(turning.fall)} at the "
        f"smallest and {change(turning.rise)} at the largest {name}, {blocks(turning.fall)}"
    )
    if turning.verdict == "inconclusive":
        return Outcome(OPEN, measured, TOO_FEW)
    return Outcome(HOLDS if turning.verdict == "falls then rises" else FAILS, measured, turning.verdict)


def spike_then_linear(study: Study, experiment: str, within: tuple[float, float]) -> Outcome:
    """Test for a fall at the small end of x and a straight line from the lowest point on."""
    spike = falls_then_rises(study, experiment)
    if not spike.measured:
        return spike
    processes = _processes(study, experiment)
    lowest = processes.groupby("x")["steps_seconds"].median().idxmin()
    return both([spike, _linear(processes[processes["x"] >= lowest], within)])


@dataclass(frozen=True)
class Stretch:
    """A stretch of the thread curve: what the claim says of it, and what a machine needs to have it."""

    start: float
    end: float
    margin: float
    expected: str
    needs: str


def scaling(study: Study, experiment: str, flat_margin: float) -> Outcome:
    """Test the three stretches of a thread curve: falling to the cores, flat to the hardware threads, rising.

    `flat_margin` is what counts as flat. A stretch that the machine does not have leaves the claim open
    unless another stretch already contradicts it. The tests are Holm-corrected.
    """
    processes = _processes(study, experiment)
    if processes.empty:
        return no_records(experiment)
    stretches = _stretches(sorted(processes["x"].unique()), study, flat_margin)
    there = [stretch for stretch in stretches if stretch.start < stretch.end]
    rows = [
        judge_one(
            log_ratios(processes[processes["x"] == stretch.start], processes[processes["x"] == stretch.end])[
                "log_ratio"
            ],
            stretch.margin,
        )
        for stretch in there
    ]
    tested = [
        _judged_stretch(stretch, row, p)
        for stretch, row, p in zip(there, rows, holm([row["p"] for row in rows]), strict=True)
    ]
    absent = [Outcome(OPEN, why=f"needs {stretch.needs}") for stretch in stretches if stretch not in there]
    return both(tested + absent)


def _stretches(x: list[float], study: Study, flat_margin: float) -> list[Stretch]:
    cores, hardware = study.cores or study.hardware_threads, study.hardware_threads
    at_cores, at_hardware = (max((n for n in x if n <= limit), default=x[0]) for limit in (cores, hardware))
    return [
        Stretch(x[0], at_cores, MARGIN, "faster", "more than one core"),
        Stretch(at_cores, at_hardware, flat_margin, "equivalent", "more hardware threads than cores"),
        Stretch(at_hardware, x[-1], MARGIN, "slower", "runs with more threads than the machine has"),
    ]


def _judged_stretch(stretch: Stretch, row: dict[str, Any], p: float) -> Outcome:
    measured = f"{stretch.start:g} to {stretch.end:g} threads: {change(row)} of time, {blocks(row)}"
    if p > ERROR or row["verdict"] == "inconclusive":
        return Outcome(OPEN, measured, TOO_FEW)
    if row["verdict"] == stretch.expected:
        return Outcome(HOLDS, measured)
    why = f"from {stretch.start:g} to {stretch.end:g} threads {row['verdict']}, expected {stretch.expected}"
    return Outcome(FAILS, measured, why)
