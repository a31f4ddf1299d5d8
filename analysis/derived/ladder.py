"""A ladder: series in the order of their question, each of which changes one choice of the one before, on
one or more scenes. What each rung costs and gains, from the records alone.
"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd

from analysis.derived.counters import QUANTITIES, derived
from analysis.records.studies import Study
from analysis.records.tables import COLUMN_OF
from analysis.statistics.bootstrap import summarise
from analysis.statistics.pairs import ratios_of, scaled
from analysis.statistics.verdicts import COLUMNS, judge
from analysis.support.wording import NO_INTERVAL, number, scene_in_words

RUNG = ["scene_name", "series_number"]
POLICIES = [
    "neighbourhood", "order", "self_contained", "direction", "find_schedule", "resolve_schedule",
    "storage", "prefetch", "box_side", "overlaps", "search", "worklist", "impact", "precision",
]  # fmt: skip
INSTRUCTIONS = "instructions per disc and step"
SOURCES = ("papi-hardware", "cachegrind")
COUNTED = [one for one in QUANTITIES if one.name == INSTRUCTIONS]

PairsOf = Callable[[list[float]], list[tuple[float, float]]]


def named(table: pd.DataFrame) -> pd.DataFrame:
    """Give the only scene of a question a name too, so that rows can be grouped by it."""
    return table.assign(scene_name=table["scene_name"].fillna("").astype(str))


def per_disc_step(times: pd.DataFrame) -> pd.DataFrame:
    """Return the times with `nanoseconds`: of the steps, per disc and step."""
    work = times["particles"] * times["steps"] * times["substeps"]
    return scaled(times, "nanoseconds", 1e9 / work.astype(float))


def rungs(runs: pd.DataFrame, times: pd.DataFrame, counters: pd.DataFrame) -> pd.DataFrame:
    """Return one row a scene and rung, in order.

    Takes the tables of one experiment, and the counters of every profiled run. Columns: `scene_name`,
    `series_number`, `series`, `variant`, `change` (what it changes of the rung before); `nanoseconds` per
    disc and step with `low`, `high`; `resolves` per disc and step, `sweeps` per step; `passed` of `records`
    checks; `instructions` per disc and step with their `source`, NaN where nobody counted them.
    """
    passed = runs[runs["check_verdict"] == "passed"]
    steps = passed["steps"] * passed["substeps"]
    work = passed.assign(
        resolves=passed["pair_resolves"] / (steps * passed["particles"]), sweeps=passed["sweeps"] / steps
    )
    table = runs.groupby(RUNG).agg(
        **{name: (name, "first") for name in ("series", "variant", "particles", "side", "radius")},
        passed=("check_verdict", lambda verdicts: int((verdicts == "passed").sum())),
        records=("check_verdict", "size"),
    )
    table = table.join(work.groupby(RUNG)[["resolves", "sweeps"]].median())
    summary = summarise(per_disc_step(times), RUNG, value="nanoseconds").set_index(RUNG)
    table = table.join(summary[["median", "low", "high"]].rename(columns={"median": "nanoseconds"}))
    table = table.reset_index()
    return table.assign(change=_changes(runs, table), **_instructions(table, counters))


def factors(times: pd.DataFrame) -> pd.DataFrame:
    """Return a row of `verdicts.judge` for every rung of each scene but the first, against the one below."""
    return _judged(times, lambda numbers: list(pairwise(numbers)), RUNG)


def totals(times: pd.DataFrame) -> pd.DataFrame:
    """Return a row of `verdicts.judge` for each scene: its last rung against its first."""
    return _judged(times, lambda numbers: [(numbers[0], numbers[-1])] if len(numbers) > 1 else [], RUNG[:1])


def speed_up(row: Any, digits: int = 3) -> str:  # noqa: ANN401 - a ratio, or a row of a table of them
    """Return a ratio as the factor by which it is faster, e.g. `9.87 × [9.52, 10.2]`, with
    its interval if it has one.
    """
    factor, low, high = (number(1 / end, digits) if end else "" for end in (row.ratio, row.high, row.low))
    if not math.isfinite(row.high):
        return f"{factor} × {NO_INTERVAL}"
    return f"{factor} × [{low}, {high}]"


def claims(runs: pd.DataFrame, times: pd.DataFrame) -> list[str]:
    """Return a sentence a scene: by how much the last rung is faster than the first, with its interval."""
    variant = str(runs.loc[runs["series_number"].idxmin(), "variant"])
    first = "the published best" if variant == "published" else variant
    return [
        f"{scene_title(runs, str(row.scene_name))}: {speed_up(row)} faster than {first} ({row.verdict})"
        for row in totals(times).itertuples()
    ]


def headlines(study: Study, experiment: str = "ladder") -> list[str]:
    """Return the claims of a study's ladder; none without records of it."""
    tables = tables_of(study, experiment)
    return claims(*tables) if tables else []


def tables_of(study: Study, experiment: str) -> tuple[pd.DataFrame, pd.DataFrame] | None:
    """Return the `runs` and the `times` of a ladder; None without records that tell its order."""
    runs, times = map(named, study.of(experiment, "runs", "times"))
    return None if times.empty or times["series_number"].isna().any() else (runs, times)


def scene_title(runs: pd.DataFrame, scene: str) -> str:
    """Return what tells a scene from the others: discs and area fraction."""
    one = runs[runs["scene_name"] == scene].iloc[0]
    return scene_in_words(one["particles"], one["area_fraction"])


def _judged(times: pd.DataFrame, pairs_of: PairsOf, by: list[str]) -> pd.DataFrame:
    # The rungs of all scenes, so that one that a scene lacks has no ratio there, not that of its neighbour.
    rungs_of_all = sorted(times["series_number"].unique())
    pairs = []
    for scene, group in times.groupby("scene_name"):
        for before, after in pairs_of(rungs_of_all):
            ratios = ratios_of(group, "series_number", before, after)
            pairs.append(ratios.assign(scene_name=scene, series_number=after))
    found = [part for part in pairs if len(part)]
    return judge(pd.concat(found), by) if found else pd.DataFrame(columns=[*by, *COLUMNS])


def _changes(runs: pd.DataFrame, table: pd.DataFrame) -> list[str]:
    """Return for each row of the table the policies that differ from the rung below, its name for none."""
    columns = {COLUMN_OF.get(name, name): name for name in POLICIES}
    first = runs.drop_duplicates("series_number").set_index("series_number").sort_index()
    policies = first[list(columns)].rename(columns=columns)
    before = policies.shift()
    # A choice that means nothing to a variant has no value, and did not change.
    changed = (policies != before) & policies.notna() & before.notna()
    said = {
        rung: ", ".join(
            f"{name} {row[name]}".replace("_", " ") for name in POLICIES if changed.loc[rung, name]
        )
        for rung, row in policies.iterrows()
    }
    rungs = zip(table["series_number"], table["series"], strict=True)
    return [said[rung] or series for rung, series in rungs]


def _instructions(table: pd.DataFrame, counters: pd.DataFrame) -> dict[str, Sequence[object]]:
    """Return `instructions` and `source`, from profiled runs of the variant on a scene of the same size."""
    known = counters[counters["source"].isin(SOURCES) & counters["name"].notna()]
    keys = ["variant", "particles", "side", "radius"]
    found: dict[object, tuple[float, str]] = {}
    for key, group in known.groupby(keys):
        medians = derived(group, COUNTED).groupby("source")["value"].median()
        found |= [(key, (medians[source], source)) for source in reversed(SOURCES) if source in medians]
    pairs = [found.get(scene, (np.nan, "")) for scene in table[keys].itertuples(index=False, name=None)]
    return {"instructions": [value for value, _ in pairs], "source": [source for _, source in pairs]}
