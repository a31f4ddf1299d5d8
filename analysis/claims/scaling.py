"""The claim about threads: what the curve does up to the cores, to the hardware threads, and beyond."""

from dataclasses import dataclass, replace
from itertools import zip_longest

import pandas as pd

from analysis.claims.curves import published_processes
from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import (
    FAILS,
    HOLDS,
    OPEN,
    Compared,
    Outcome,
    judged,
    no_records,
    told,
    unmeasured,
)
from analysis.statistics.pairs import ratios_of
from analysis.statistics.scalability import doubt
from analysis.statistics.verdicts import MARGIN, Ratio, judge_one
from analysis.support.wording import blocks, change, exact, factor

ANOTHER_BINDING = "threads are bound at one end and not at the other: the binding changes with their number"


@dataclass(frozen=True)
class Stretch:
    """A stretch of the thread curve: what the claim says of it, and what a machine needs to have it."""

    what: str
    start: float
    end: float
    margin: float
    expected: str
    needs: str

    def judge(self, processes: pd.DataFrame) -> Ratio:
        """Return the time at its end against that at its start; of one that there is not no ratio."""
        if not self.start < self.end:
            return unmeasured(self.what, margin=self.margin)
        return judge_one(ratios_of(processes, "x", self.start, self.end)["log_ratio"], self.margin)

    def same_binding(self, processes: pd.DataFrame) -> bool:
        """Tell whether both ends were measured with threads bound alike."""
        return processes[processes["x"].isin([self.start, self.end])]["proc_bind"].nunique() == 1


def scaling(evidence: Evidence, experiment: str, flat_margin: float, published_machine: str) -> Outcome:
    """Test the three stretches of a thread curve: falling to the cores, flat to the hardware threads, rising.

    `flat_margin` is what counts as flat. A stretch that the machine does not have leaves the claim open
    unless another stretch already contradicts it; one whose ends were bound differently decides nothing.
    """
    processes = published_processes(evidence.study, experiment)
    if processes.empty:
        _, effects = _beside(evidence, experiment, [], processes, published_machine)
        return replace(no_records(experiment), effects=effects)
    study = evidence.study
    cores = study.cores or study.hardware_threads
    margin = evidence.margin(experiment)
    stretches = _stretches(processes, cores, study.hardware_threads, flat_margin, margin)
    there = [stretch for stretch in stretches if stretch.start < stretch.end]
    tested = [_judged(stretch, processes, cores) for stretch in there]
    absent = [Outcome(OPEN, why=f"needs {one.needs}") for one in stretches if one not in there]
    figures, effects = _beside(evidence, experiment, stretches, processes, published_machine)
    return both([*tested, *absent, Outcome(HOLDS, figures=figures, effects=effects)])


def _stretches(
    processes: pd.DataFrame, cores: int, hardware: int, flat_margin: float, margin: float = MARGIN
) -> list[Stretch]:
    x = sorted(processes["x"].unique())
    at_cores, at_hardware = (max((n for n in x if n <= limit), default=x[0]) for limit in (cores, hardware))
    beyond = "runs with more threads than the machine has"
    return [
        Stretch("up to the cores", x[0], at_cores, margin, "faster", "more than one core"),
        Stretch(
            "to the hardware threads", at_cores, at_hardware, flat_margin, "equivalent",
            "more hardware threads than cores",
        ),
        Stretch("beyond", at_hardware, x[-1], margin, "slower", beyond),
    ]  # fmt: skip


def _judged(stretch: Stretch, processes: pd.DataFrame, cores: int) -> Outcome:
    row, span = stretch.judge(processes), f"{stretch.start:g} to {stretch.end:g} threads"
    unlikely = doubt(1 / row.ratio, min(stretch.end, cores) / min(stretch.start, cores))
    measured = f"{span}: {change(row)} of time, {blocks(row)}{unlikely and f' ({unlikely})'}"
    if not stretch.same_binding(processes):
        return Outcome(OPEN, measured, ANOTHER_BINDING)
    outcome = judged(row, stretch.expected, measured)
    if outcome.verdict != FAILS:
        return outcome
    return replace(outcome, why=f"from {span} {told(row, stretch.expected)}, expected {stretch.expected}")


def _beside(
    evidence: Evidence, experiment: str, ours: list[Stretch], processes: pd.DataFrame, machine: str
) -> tuple[tuple[Compared, ...], tuple[Ratio, ...]]:
    """Return the change of time over each stretch on the study's machine and, where it is, on this one: in
    words, and as effects.
    """
    curve = evidence.published.curve(experiment)
    size = evidence.published.machines.set_index("machine").loc[machine]
    theirs = _stretches(curve, int(size["cores"]), int(size["hardware_threads"]), MARGIN)
    figures, effects = [], []
    for their, our in zip_longest(theirs, ours):
        published, row = their.judge(curve), our.judge(processes) if our else unmeasured("")
        figures.append((f"time {their.what}", _said(their, published), _said(our, row)))
        effects.append(replace(row, what=their.what, published=published.ratio))
    return tuple(figures), tuple(effects)


def _said(stretch: Stretch | None, row: Ratio) -> str:
    if stretch is None or not row.is_measured:
        return "–"
    return f"{factor(row.ratio)} from {exact(stretch.start)} to {exact(stretch.end)}"
