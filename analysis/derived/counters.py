"""Quantities derived from counters: per cycle, per disc and step, per step. Sources are never mixed."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import pandas as pd

CACHE_LINE_BYTES = 64
CYCLES = ("PAPI_TOT_CYC", "perf::CYCLES")
INSTRUCTIONS = ("PAPI_TOT_INS", "perf::INSTRUCTIONS")
SIMULATED_LAST_LEVEL = "llc_instruction_misses + llc_read_misses + llc_write_misses"
LAST_LEVEL = ("PAPI_L3_TCM", "perf::CACHE-MISSES")


@dataclass(frozen=True)
class Quantity:
    """What is derived from one source: the first of `events` that was counted, times `factor`, over `per`.

    An event may be a sum, as `a + b`. `per` is a unit of work, or another counter of the same source.
    """

    source: str
    name: str
    events: tuple[str, ...]
    per: Literal["disc and step", "step", "run"] | tuple[str, ...]
    factor: float = 1.0


def _per_disc(source: str, name: str, *events: str, factor: float = 1.0) -> Quantity:
    return Quantity(source, f"{name} per disc and step", events, "disc and step", factor)


def _per_step(source: str, name: str, *events: str) -> Quantity:
    return Quantity(source, f"{name} per step", events, "step")


QUANTITIES = [
    Quantity("papi-hardware", "instructions per cycle", INSTRUCTIONS, CYCLES),
    _per_disc("papi-hardware", "instructions", *INSTRUCTIONS),
    _per_disc("papi-hardware", "L1 data misses", "PAPI_L1_DCM", "perf::L1-DCACHE-LOAD-MISSES"),
    _per_disc("papi-hardware", "L2 misses", "PAPI_L2_TCM", "PAPI_L2_DCM"),
    _per_disc("papi-hardware", "last-level misses", *LAST_LEVEL),
    _per_disc("papi-hardware", "bytes from memory", *LAST_LEVEL, factor=CACHE_LINE_BYTES),
    _per_disc("papi-hardware", "branch misses", "PAPI_BR_MSP", "perf::BRANCH-MISSES"),
    _per_disc("papi-hardware", "TLB misses", "PAPI_TLB_DM", "perf::DTLB-LOAD-MISSES"),
    _per_disc("papi-hardware", "stalled cycles", "PAPI_RES_STL", "perf::STALLED-CYCLES-BACKEND"),
    _per_disc("papi-software", "CPU nanoseconds", "perf::TASK-CLOCK"),
    _per_step("papi-software", "context switches", "perf::CONTEXT-SWITCHES"),
    _per_step("papi-software", "migrations", "perf::CPU-MIGRATIONS"),
    _per_step("papi-software", "page faults", "perf::PAGE-FAULTS"),
    _per_disc("rusage", "user nanoseconds", "user_seconds", factor=1e9),
    _per_disc("rusage", "system nanoseconds", "system_seconds", factor=1e9),
    _per_step("rusage", "page faults", "minor_page_faults"),
    _per_step("rusage", "voluntary context switches", "voluntary_context_switches"),
    _per_step("rusage", "involuntary context switches", "involuntary_context_switches"),
    Quantity("rusage", "greatest memory, MiB", ("maximum_resident_bytes",), "run", 2**-20),
    _per_disc("cachegrind", "instructions", "instructions"),
    _per_disc("cachegrind", "data accesses", "data_reads + data_writes"),
    _per_disc("cachegrind", "L1 data misses", "l1_read_misses + l1_write_misses"),
    _per_disc("cachegrind", "last-level misses", SIMULATED_LAST_LEVEL),
    _per_disc("cachegrind", "bytes from memory", SIMULATED_LAST_LEVEL, factor=CACHE_LINE_BYTES),
    _per_disc("cachegrind", "branches", "conditional_branches + indirect_branches"),
    _per_disc("cachegrind", "branch misses", "conditional_branch_misses + indirect_branch_misses"),
]


def derived(counters: pd.DataFrame, quantities: Sequence[Quantity] = QUANTITIES) -> pd.DataFrame:
    """Return `experiment`, `series`, `source`, `quantity`, `value` (median), `least`, `greatest`, `runs`.

    Takes the rows of `tables.counters`, and works out these quantities. A counter's threads are summed within
    each profiled run; a run in which one of them has no value gives none, rather than too small a sum.
    Quantities without any value are left out.
    """
    keys = ["experiment", "series", "file", "source", "discs", "time_steps"]
    steps = counters["steps"] * counters["substeps"]
    measured = counters.assign(discs=counters["particles"], time_steps=steps)
    totals = measured.groupby([*keys, "name"])["value"].agg(lambda values: values.sum(skipna=False))
    wide = totals.unstack("name").reset_index()
    tables = [_quantity(wide[wide["source"] == one.source], one) for one in quantities]
    known = pd.concat(tables).dropna(subset="value")
    groups = known.groupby(["experiment", "series", "source", "quantity"], sort=False)
    return groups["value"].agg(value="median", least="min", greatest="max", runs="count").reset_index()


def _quantity(wide: pd.DataFrame, quantity: Quantity) -> pd.DataFrame:
    value = _first_counted(wide, quantity.events) * quantity.factor
    if isinstance(quantity.per, tuple):
        value = value / _first_counted(wide, quantity.per)
    elif quantity.per != "run":
        discs = wide["discs"] if quantity.per == "disc and step" else 1
        # A simulation says how few steps it ran, all else covers the whole run.
        steps = wide["steps"].fillna(wide["time_steps"]) if "steps" in wide else wide["time_steps"]
        value = value / (steps * discs)
    return wide[["experiment", "series", "source"]].assign(quantity=quantity.name, value=value)


def _first_counted(wide: pd.DataFrame, events: Sequence[str]) -> pd.Series:
    for event in events:
        parts = event.split(" + ")
        if all(part in wide and wide[part].notna().any() for part in parts):
            return wide[parts].sum(axis=1, skipna=False)
    return pd.Series(float("nan"), index=wide.index)
