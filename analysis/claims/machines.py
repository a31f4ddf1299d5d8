"""The claim about machines, the only one that looks across studies."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import pandas as pd

from analysis.claims.outcome import FAILS, HOLDS, OPEN, TOO_FEW, Outcome, no_records
from analysis.records.published import Published
from analysis.records.studies import Study
from analysis.statistics.pairs import process_medians
from analysis.statistics.unpaired import judge_unpaired
from analysis.support.wording import number


@dataclass(frozen=True)
class Measured:
    """One machine's processes, with its clock in GHz if known."""

    machine: str
    gigahertz: float | None
    processes: pd.DataFrame


def clock(study: Study, studies: Sequence[Study], published: Published, experiment: str) -> Outcome:
    """Test that machines ordered by their clock are ordered by their time, at this study's scale.

    Machines are not interleaved, so their processes are compared unpaired, each with the next faster clock.
    """
    machines = _machines(study, studies, published, experiment)
    if not machines:
        return no_records(experiment)
    if len(machines) < 2:
        return Outcome(OPEN, why="needs two machines of different clocks; only one is present")
    known = sorted((one for one in machines if one.gigahertz), key=lambda one: one.gigahertz or 0)
    if len({one.gigahertz for one in known}) < 2:
        return Outcome(OPEN, why="the CPU models do not tell two different clocks")
    measured = "; ".join(
        f"{one.machine}: {number(one.gigahertz or 0, 2)} GHz, "
        f"{number(float(one.processes['steps_seconds'].median()))} s"
        for one in known
    )
    verdicts = {
        judge_unpaired(slow.processes["steps_seconds"], fast.processes["steps_seconds"])["verdict"]
        for slow, fast in pairwise(known)
        if slow.gigahertz != fast.gigahertz
    }
    if {"slower", "equivalent"} & verdicts:
        return Outcome(FAILS, measured, "a higher clock was not faster")
    return Outcome(OPEN, measured, TOO_FEW) if "inconclusive" in verdicts else Outcome(HOLDS, measured)


def _machines(
    study: Study, studies: Sequence[Study], published: Published, experiment: str
) -> list[Measured]:
    machines: dict[str, Measured] = {}
    # This study first: another one of its machine, of another revision, must not speak for it.
    for other in (study, *studies):
        processes = process_medians(other.times_of(experiment))
        if other.scale == study.scale and not processes.empty:
            speed = gigahertz(str(processes["cpu_model"].iloc[0]), published)
            machines.setdefault(other.machine, Measured(other.machine, speed, processes))
    return list(machines.values())


def gigahertz(cpu_model: str, published: Published) -> float | None:
    """Return the maximum clock of a CPU of the published study, the clock in the model's name, or None."""
    for row in published.machines.itertuples():
        if row.processor.split()[-1].lower() in cpu_model.lower():
            return float(row.maximum_gigahertz)
    stated = re.search(r"@\s*([0-9.]+)\s*GHz", cpu_model)
    return float(stated.group(1)) if stated else None
