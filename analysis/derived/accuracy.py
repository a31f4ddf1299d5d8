"""Error measures beside the time that they cost: from the tables of a study to one row a point.

A point is a series at a number of substeps on one scene. Its time is over all of its processes; its errors
come from the one that measured them, since every run of a point ends in the same bits. The event-driven
simulation takes no steps: it is a point with 0 substeps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd

from analysis.records.studies import Study
from analysis.statistics.bootstrap import summarise
from analysis.statistics.looks import ERROR
from analysis.statistics.pairs import log_ratios, narrow, scaled
from analysis.statistics.ranking import front
from analysis.statistics.trends import order
from analysis.statistics.verdicts import error_of_picked, judge_one
from analysis.support.values import Interval, rows_in

POINT = ["scene_name", "series", "x"]
Entrant = tuple[str, float]
"""A point of one scene: its series and its x."""

SMALL = 0.1
"""Errors below this follow their leading term in dt: a tenth of a radius, or of the reference's value."""


@dataclass(frozen=True)
class Measure:
    """An error measure: its name, the axis it is drawn on, what it means, and the `column` it is worked out
    from, relative to that of the reference or not; `converges` if it falls with dt.
    """

    key: str
    title: str
    label: str
    meaning: str
    column: str
    converges: bool
    is_relative: bool = False

    def value(self, runs: pd.DataFrame) -> pd.Series:
        """Return it of each run; NaN relative to 0, as where the exact run meets no wall."""
        values = runs[self.column]
        if self.is_relative:
            values = values / runs[f"{self.column}_reference"].replace(0, np.nan) - 1
        return values.abs()


MEASURES = rows_in(Path(__file__).with_name("measures.toml"), "measure", Measure)


def errors(study: Study, experiment: str) -> pd.DataFrame:
    """Return the records of an experiment that measured errors, a column a measure; NaN where it has none."""
    runs = study.runs_of(experiment)
    runs = runs[runs["has_errors"].astype(bool)]
    at_one = study.trajectory[study.trajectory["time"] == 1].set_index("file")["rms_distance"]
    runs = _without_steps(runs).assign(path=runs["file"].map(at_one))
    # 0 where the paths never part, NaN where there was no reference to part from.
    never = runs["path"].notna() & runs["time_to_tenth_radius"].isna()
    runs = runs.assign(parting=(1 / runs["time_to_tenth_radius"]).mask(never, 0.0))
    return runs.assign(**{measure.key: measure.value(runs) for measure in MEASURES})


def times(study: Study, experiment: str) -> pd.DataFrame:
    """Return the times with `seconds`, that of one unit of simulated time."""
    table = _without_steps(study.times_of(experiment))
    return scaled(table, "seconds", 1 / table["steps"].astype(float))


def _without_steps(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table with a text for every scene, and no substeps where there are no steps."""
    steps = table["impact"] != "event_driven"
    return table.assign(
        x=table["x"].where(steps, 0.0),
        substeps=table["substeps"].where(steps, 0),
        scene_name=table["scene_name"].fillna(""),
    )


def points(study: Study, experiment: str, measure: Measure) -> pd.DataFrame:
    """Return a row a point with both a time and an error: `median`, `low`, `high` of the seconds for a unit
    of simulated time, and `error`, `error_low`, `error_high`.

    The error has an interval, its range, where several processes measured different ones. `on_front` tells
    which points of each scene are on its Pareto front.
    """
    measured = errors(study, experiment).dropna(subset=[measure.key])
    summary = _summary(study, experiment)
    if measured.empty or summary.empty:
        return pd.DataFrame()
    grouped = measured.groupby(POINT, sort=True)
    error = grouped[measure.key].agg(error="median", error_low="min", error_high="max")
    first = grouped[["variant", "precision", "area_fraction", "particles", "substeps"]].first()
    table = summary.merge(first.join(error).reset_index(), on=POINT)
    parts = [
        part.assign(on_front=front(part["error"], part["median"])) for _, part in table.groupby("scene_name")
    ]
    return pd.concat(parts).sort_values(["particles", "area_fraction", "series", "x"], ignore_index=True)


@cache
def _summary(study: Study, experiment: str) -> pd.DataFrame:
    return summarise(times(study, experiment), POINT, "seconds")


def orders(table: pd.DataFrame) -> pd.DataFrame:
    """Return per scene and series of `points` the fitted `order` of the error in dt, an Interval."""
    keys = ["scene_name", "series"]
    table = table[table["substeps"] > 0]
    rows = [
        {**dict(zip(keys, key, strict=True)), "order": order(1 / part["substeps"], part["error"], SMALL)}
        for key, part in table.groupby(keys, sort=False)
    ]
    return pd.DataFrame(rows, columns=[*keys, "order"])


@dataclass(frozen=True)
class Choice:
    """The cheapest point below a bound, its seconds for a unit of time, and those that may be as cheap."""

    series: str
    substeps: float
    seconds: Interval
    others: list[tuple[str, float]]


def advice(table: pd.DataFrame, races: Mapping[str, "Race"]) -> list[tuple[float, dict[str, Choice | None]]]:
    """Return, for bounds in powers of ten from the loosest, the cheapest choice in each scene of `points`, by
    the scenes' `races`.

    Of bounds with the same choices only the tightest is kept: whoever needs less gets it for the same price.
    """
    found: list[tuple[float, dict[str, Choice | None]]] = []
    parts = {str(scene): part for scene, part in table.groupby("scene_name", sort=False)}
    for bound in _bounds(table["error"]):
        choices = {
            scene: cheapest(part[part["error"] <= bound], races[scene]) for scene, part in parts.items()
        }
        if found and found[-1][1] == choices:
            found.pop()
        found.append((bound, choices))
    return found


class Race:
    """The times of one scene's points. All that is said of them holds together in 95 % of studies, whoever is
    chosen by looking at them, for whichever measure and bound.
    """

    def __init__(self, timed: pd.DataFrame) -> None:
        self.all = narrow(timed, "series", "x", value="seconds")
        self.timed = dict(iter(self.all.groupby(["series", "x"])))


@cache
def seconds_of(race: Race, entrant: Entrant) -> Interval:
    """Return the entrant's time, with an interval that holds together with those of all others."""
    level = 1 - ERROR / len(race.timed)
    row = summarise(race.timed[entrant], ["series", "x"], "seconds", level).iloc[0]
    return Interval(row["median"], row["low"], row["high"])


@cache
def _is_slower(race: Race, candidate: Entrant, reference: Entrant) -> bool:
    """Whether the candidate was found slower, from ratios within blocks, as one of all pairs."""
    ratios = _ratios_to(race, reference).get(candidate, pd.Series(dtype=float))
    return judge_one(ratios, error=error_of_picked(len(race.timed))).verdict == "slower"


@cache
def _ratios_to(race: Race, reference: Entrant) -> dict[Entrant, pd.Series]:
    """Return the log ratios of every entrant to one of them, taken at once."""
    first = race.timed[reference].drop(columns=["series", "x"])
    pairs = log_ratios(first, race.all, value="seconds", by=("series", "x"))
    groups = pairs.groupby(["series", "x"])["log_ratio"]
    return {(str(key[0]), float(key[1])): part for key, part in groups}


@cache
def races(study: Study, experiment: str) -> dict[str, Race]:
    """Return the race of each scene. The same for each measure of the errors, so that no two points of an
    experiment are compared twice.
    """
    timed = times(study, experiment)
    return {str(scene): Race(part) for scene, part in timed.groupby("scene_name", sort=False)}


def cheapest(candidates: pd.DataFrame, race: Race) -> Choice | None:
    """Return the candidate with the least median time, None if there is no candidate.

    `others` are the candidates that were not found slower than it.
    """
    if candidates.empty:
        return None
    ordered = candidates.sort_values("median", kind="stable")
    best, *entrants = zip(ordered["series"].astype(str), ordered["x"].astype(float), strict=True)
    others = [entrant for entrant in entrants if not _is_slower(race, entrant, best)]
    return Choice(*best, seconds_of(race, best), others)


def _bounds(values: Sequence[float] | pd.Series) -> list[float]:
    """Return the powers of ten that some but not all of the positive values exceed, and one above all."""
    found = np.asarray(values, dtype=float)
    found = found[found > 0]
    if len(found) == 0:
        return []
    low, high = np.floor(np.log10(found.min())) + 1, np.ceil(np.log10(found.max()))
    return [float(f"1e{power:.0f}") for power in np.arange(max(low, high), low - 1, -1)]
