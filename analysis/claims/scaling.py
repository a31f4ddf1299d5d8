"""The claim about threads: what the curve does up to the cores, to the hardware threads, and beyond."""

from dataclasses import dataclass, replace

import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import FAILS, OPEN, Outcome, judged, no_records, told, unmeasured
from analysis.statistics.pairs import ratios_of
from analysis.statistics.scalability import doubt
from analysis.statistics.verdicts import MARGIN, Ratio, judge_one
from analysis.support.wording import blocks, change

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

    def outcome(self, processes: pd.DataFrame, published: Ratio, cores: int) -> Outcome:
        """Return what becomes of it; one whose ends were bound differently decides nothing."""
        row = self.judge(processes).told_as(published)
        if not self.start < self.end:
            return Outcome(OPEN, why=f"needs {self.needs}", effects=(row,))
        span = f"{self.start:g} to {self.end:g} threads"
        unlikely = doubt(1 / row.ratio, min(self.end, cores) / min(self.start, cores))
        measured = f"{span}: {change(row)} of time, {blocks(row)}{unlikely and f' ({unlikely})'}"
        if processes[processes["x"].isin([self.start, self.end])]["proc_bind"].nunique() != 1:
            return Outcome(OPEN, measured, ANOTHER_BINDING, effects=(row,))
        found = judged(row, self.expected, measured)
        why = f"from {span} {told(row, self.expected)}, expected {self.expected}"
        return replace(found, why=why) if found.verdict == FAILS else found


def scaling(evidence: Evidence, experiment: str, flat_margin: float, published_machine: str) -> Outcome:
    """Test the three stretches of a thread curve: falling to the cores, flat to the hardware threads, rising.

    `flat_margin` is what counts as flat. A stretch that the machine does not have leaves the claim open
    unless another stretch already contradicts it.
    """
    curve, processes = evidence.curves(experiment)
    machine = evidence.published.machines.set_index("machine").loc[published_machine]
    size = int(machine["cores"]), int(machine["hardware_threads"])
    theirs = [
        unmeasured(one.what, one.judge(curve).ratio) for one in _stretches(curve, *size, MARGIN, MARGIN)
    ]
    if processes.empty:
        return no_records(experiment, effects=theirs)
    study, margin = evidence.study, evidence.margin(experiment)
    cores = study.cores or study.hardware_threads
    ours = _stretches(processes, cores, study.hardware_threads, flat_margin, margin)
    return both([one.outcome(processes, their, cores) for one, their in zip(ours, theirs, strict=True)])


def _stretches(
    processes: pd.DataFrame, cores: int, hardware: int, flat_margin: float, margin: float
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
