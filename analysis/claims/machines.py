"""The claim about machines, the only one that looks across studies."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import FAILS, OPEN, Outcome, judged, no_records, unmeasured
from analysis.records.published import Published
from analysis.statistics.verdicts import Ratio, judge_unpaired
from analysis.support.wording import listed, number


@dataclass(frozen=True)
class Measured:
    """One machine's processes, with its greatest clock if the study has a machine of the same processor."""

    machine: str
    gigahertz: float | None
    processes: pd.DataFrame

    @property
    def threads(self) -> set[int]:
        """The numbers of threads of its processes."""
        return {int(number) for number in self.processes["threads"]}

    @property
    def said(self) -> str:
        """The machine with its clock, threads and median time."""
        clock = f"{number(self.gigahertz, 2)} GHz" if self.gigahertz else "clock not known"
        seconds = number(float(self.processes["steps_seconds"].median()))
        return f"{self.machine}: {clock}, {listed(sorted(self.threads))} threads, {seconds} s"


def clock(evidence: Evidence, experiment: str) -> Outcome:
    """Test that machines ordered by their greatest clock are ordered by their time, at this study's scale.

    Only the greatest clocks of the published machines are known. The clock in a CPU's name is the base clock,
    and stands beside none of them. Machines are not interleaved, so their processes are compared unpaired,
    each with the next faster clock; all on one number of threads, or not at all.
    """
    machines = _machines(evidence, experiment)
    theirs = _published_effects(evidence.published, experiment)
    if not machines:
        return no_records(experiment, effects=theirs)
    measured = "; ".join(one.said for one in machines)
    why = _undecidable(machines)
    if why:
        return Outcome(OPEN, measured if len(machines) > 1 else "", why, effects=theirs)
    ordered = sorted((one for one in machines if one.gigahertz), key=lambda one: one.gigahertz or 0)
    faster = [two for two in pairwise(ordered) if two[0].gigahertz != two[1].gigahertz]
    outcomes = []
    for slow, fast in faster:
        row = judge_unpaired(slow.processes["steps_seconds"], fast.processes["steps_seconds"])
        row = replace(row, what=f"{fast.gigahertz} against {slow.gigahertz} GHz")
        outcomes.append(judged(row, "faster", unit="process"))
    joined = both(outcomes)
    why = "a higher clock was not faster" if joined.verdict == FAILS else joined.why
    return replace(joined, measured=measured, why=why)


def _published_effects(published: Published, experiment: str) -> tuple[Ratio, ...]:
    """Return the times of the published machines, each against the one with the next lower clock."""
    times = published.experiment(experiment).groupby("series")["seconds"].median()
    known = published.machines[published.machines["machine"].isin(times.index)]
    ordered = known.sort_values("maximum_gigahertz")[["maximum_gigahertz", "machine"]]
    return tuple(
        unmeasured(f"{fast[0]} against {slow[0]} GHz", float(times[fast[1]] / times[slow[1]]))
        for slow, fast in pairwise(ordered.itertuples(index=False, name=None))
    )


def _undecidable(machines: Sequence[Measured]) -> str:
    """Return why the machines present cannot be ordered, or nothing."""
    if len(machines) < 2:
        return "needs two machines of different clocks; only one is present"
    known = [one for one in machines if one.gigahertz]
    if len({one.gigahertz for one in known}) < 2:
        return "needs two machines whose greatest clocks are known and differ; a base clock in a name is none"
    threads = set().union(*(one.threads for one in known))
    if len(threads) > 1:
        return f"the machines ran on unequal numbers of threads: {listed(sorted(threads))}"
    return ""


def _machines(evidence: Evidence, experiment: str) -> list[Measured]:
    machines: dict[str, Measured] = {}
    # This study first: another one of its machine, of another revision, must not speak for it.
    for other in (evidence.study, *evidence.studies):
        processes = other.times_of(experiment)
        if other.scale == evidence.study.scale and not processes.empty:
            known = evidence.published.machines.set_index("processor")["maximum_gigahertz"].items()
            cpu = str(processes["cpu_model"].iloc[0]).lower()
            clock = next((float(most) for name, most in known if str(name).lower().split()[-1] in cpu), None)
            machines.setdefault(other.machine, Measured(other.machine, clock, processes))
    return list(machines.values())
