"""Every variant against every hard case: what was expected, and what came of it."""

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from analysis.derived import accuracy
from analysis.derived.accuracy import MEASURES
from analysis.records.studies import Study

EXPECTATIONS_FILE = Path(__file__).parent / "hard_cases.toml"
HOLDS, FAILS, LIMIT, UNMEASURED = "holds", "fails", "limit of the method", "not measured"
COLUMNS = ["case", "title", "series", "precision", "impact", "verdict", "value", "bound", "reason"]
AT_CONTACT = "at_contact"


@dataclass(frozen=True)
class Expectation:
    """What a case is held to: a measure with the most that it may be in each precision, or how far all
    measures, which are free of units, may be from those of another case.

    Where the method cannot be right, `limit` says why, and the measure is expected to be `at_least` so much
    in that precision: a smaller one would mean that the case no longer tests what it is for.

    One with an `impact` is for the variants that make collisions then, in place of that for all.
    """

    name: str
    expects: str
    measure: str = ""
    at_most: dict[str, float] = field(default_factory=dict)
    at_least: dict[str, float] = field(default_factory=dict)
    equals: str | None = None
    limit: str = ""
    impact: str = ""

    @property
    def title(self) -> str:
        """The case, and for which variants this is if not for all of them."""
        return f"{self.name}, {self.impact}" if self.impact else self.name

    @property
    def label(self) -> str:
        """What the number in a cell is."""
        if self.equals:
            return f"greatest difference of any measure from {self.equals}"
        return LABELS.get(self.measure, "")


LABELS = {
    **{measure.key: measure.label for measure in MEASURES},
    "path_end": "RMS distance from the exact paths at the end, radii",
}


def load() -> list[Expectation]:
    """Read the expectations, in the order of the table."""
    tables = tomllib.loads(EXPECTATIONS_FILE.read_text(encoding="utf-8"))["case"]
    return [expectation for table in tables for expectation in _of_table(table)]


def _of_table(table: dict[str, Any]) -> Iterator[Expectation]:
    at_contact = table.pop(AT_CONTACT, None)
    yield Expectation(**table)
    if at_contact is not None:
        yield Expectation(table["name"], impact=AT_CONTACT, **at_contact)


def evaluate(study: Study, experiment: str) -> pd.DataFrame:
    """Return a row a case and series: `title` of its expectation, `verdict`, `value` (of the case's measure),
    `bound`, `reason`.

    *holds*: every step passed the check and the measure is within its bound; *fails*: not so, `reason` says
    why; *limit of the method*: wrong as it must be; *not measured*: there is neither a record nor a failure.
    A case that has no expectation of its own is held to the check alone.
    """
    runs = _with_ends(study, experiment)
    failures = study.failures[study.failures["experiment"] == experiment]
    series = sorted(set(runs["series"]) | set(failures["series"].dropna()))
    precision = dict(zip(runs["series"], runs["precision"], strict=True))
    impact = dict(zip(runs["series"], runs["impact"], strict=True))
    expectations = _expectations(runs, failures)
    special = {(expected.name, expected.impact) for expected in expectations if expected.impact}
    rows = [
        {
            "case": expected.name,
            "title": expected.title,
            "series": one,
            "precision": precision.get(one),
            "impact": impact.get(one),
            **_cell(expected, one, runs, failures),
        }
        for expected in expectations
        for one in series
        if ((expected.name, impact.get(one)) in special) == bool(expected.impact)
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def _with_ends(study: Study, experiment: str) -> pd.DataFrame:
    last = study.trajectory.sort_values("time").groupby("file")["rms_distance"].last()
    runs = accuracy.errors(study, experiment)
    return runs.assign(path_end=runs["file"].map(last))


def _expectations(runs: pd.DataFrame, failures: pd.DataFrame) -> list[Expectation]:
    known = load()
    measured = dict.fromkeys([*runs["scene_name"], *failures["scene_name"].dropna()])
    others = [name for name in measured if name not in {one.name for one in known}]
    return [*known, *(Expectation(name, "every step passes the check") for name in others)]


def _cell(expected: Expectation, series: str, runs: pd.DataFrame, failures: pd.DataFrame) -> dict[str, Any]:
    found = runs[(runs["scene_name"] == expected.name) & (runs["series"] == series)]
    if found.empty:
        failed = failures[(failures["scene_name"] == expected.name) & (failures["series"] == series)]
        reason = None if failed.empty else str(failed["reason"].iloc[-1])
        return {"verdict": FAILS if reason else UNMEASURED, "value": None, "bound": None, "reason": reason}
    run = found.iloc[-1]
    value = run[expected.measure] if expected.measure else np.nan
    if expected.equals:
        other = runs[(runs["scene_name"] == expected.equals) & (runs["series"] == series)]
        if other.empty:
            reason = f"{expected.equals} was not measured"
            return {"verdict": UNMEASURED, "value": None, "bound": None, "reason": reason}
        value = _difference(run, other.iloc[-1])
    return _judged(expected, str(run["precision"]), float(value))


def _judged(expected: Expectation, precision: str, value: float) -> dict[str, Any]:
    most, least = expected.at_most.get(precision), expected.at_least.get(precision)
    if np.isnan(value):
        asked = most is not None or least is not None
        reason = f"there is no {expected.label}" if asked else None
        return {"verdict": FAILS if asked else HOLDS, "value": None, "bound": None, "reason": reason}
    if least is not None:
        shows = value >= least
        reason = expected.limit if shows else f"expected at least {least:g}"
        return {"verdict": LIMIT if shows else FAILS, "value": value, "bound": least, "reason": reason}
    holds = most is None or value <= most
    reason = None if holds else f"expected at most {most:g}"
    return {"verdict": HOLDS if holds else FAILS, "value": value, "bound": most, "reason": reason}


def _difference(run: pd.Series, other: pd.Series) -> float:
    """Return the greatest difference of any measure; infinite where only one of the two has a measure."""
    keys = ["path_end", *(measure.key for measure in MEASURES)]
    one, two = run[keys].astype(float), other[keys].astype(float)
    return float((one - two).abs().mask(one.isna() & two.isna(), 0.0).fillna(np.inf).max())


def summary(table: pd.DataFrame) -> str:
    """Say in one sentence how many cells hold, fail, and show a limit of the method."""
    counts = table["verdict"].value_counts()
    said = ", ".join(
        f"{counts[verdict]} {verdict}" for verdict in (HOLDS, LIMIT, FAILS, UNMEASURED) if verdict in counts
    )
    return f"Of {len(table)} cells (a case with a variant): {said}."
