"""Quantities derived from counters: per cycle, per disc and step, per step. Sources are never mixed."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from analysis.support.values import rows_in


@dataclass(frozen=True)
class Quantity:
    """What is derived from one source: the first of `events` that was counted, times `factor`, over `per`.

    An event may be a sum, as `a + b`. `per` is a unit of work, or another counter of the same source.
    """

    source: str
    name: str
    events: list[str]
    per: str | list[str]
    factor: float = 1.0


QUANTITIES = rows_in(Path(__file__).with_name("quantities.toml"), "quantity", Quantity)


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
    if isinstance(quantity.per, list):
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
