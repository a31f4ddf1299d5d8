"""Every variant against every hard case: what was expected, and what came of it."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from analysis.derived import accuracy
from analysis.derived.accuracy import MEASURES
from analysis.records.studies import Study
from analysis.support.values import rows_in

HOLDS, FAILS, LIMIT, UNMEASURED = "holds", "fails", "limit of the method", "not measured"
COLUMNS = [
    *("case", "title", "expects", "label", "series", "precision", "impact"),
    *("verdict", "value", "bound", "reason"),
]
AT_CONTACT = "at_contact"

Told = tuple[str, float | None, float | None, str | None]
"""Verdict, value, bound and reason of a cell."""
NOTHING = (None, None, None)


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
    return [
        one for case in rows_in(Path(__file__).with_name("hard_cases.toml"), "case", _case) for one in case
    ]


def _case(at_contact: dict[str, Any] | None = None, **told: Any) -> list[Expectation]:  # noqa: ANN401
    """Return what a case is held to, and what in place of that for collisions at contact, if it says so."""
    others = [Expectation(told["name"], impact=AT_CONTACT, **at_contact)] if at_contact else []
    return [Expectation(**told), *others]


def evaluate(study: Study, experiment: str) -> pd.DataFrame:
    """Return a row a case and series: `title`, `expects` and `label` of its expectation, `verdict`, `value`
    (of the case's measure), `bound`, `reason`.

    *holds*: every step passed the check and the measure is within its bound; *fails*: not so, `reason` says
    why; *limit of the method*: wrong as it must be; *not measured*: there is neither a record nor a failure.
    A case that has no expectation of its own is held to the check alone.
    """
    last = study.trajectory.sort_values("time").groupby("file")["rms_distance"].last()
    runs = accuracy.errors(study, experiment)
    runs = runs.assign(path_end=runs["file"].map(last))
    (failures,) = study.of(experiment, "failures")
    series = sorted(set(runs["series"]) | set(failures["series"].dropna()))
    precision = dict(zip(runs["series"], runs["precision"], strict=True))
    impact = dict(zip(runs["series"], runs["impact"], strict=True))
    known = {expected.name: expected for expected in load()}
    measured = dict.fromkeys([*runs["scene_name"], *failures["scene_name"].dropna()])
    others = (Expectation(name, "") for name in measured if name not in known)
    expectations = [*load(), *others]
    special = {(expected.name, expected.impact) for expected in expectations if expected.impact}
    rows = [
        (
            *(expected.name, expected.title, expected.expects, expected.label),
            *(one, precision.get(one), impact.get(one)),
            *_cell(expected, one, runs, failures),
        )
        for expected in expectations
        for one in series
        if ((expected.name, impact.get(one)) in special) == bool(expected.impact)
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def _cell(expected: Expectation, series: str, runs: pd.DataFrame, failures: pd.DataFrame) -> Told:
    def of(table: pd.DataFrame, case: str) -> pd.DataFrame:
        return table[(table["scene_name"] == case) & (table["series"] == series)]

    found = of(runs, expected.name)
    if found.empty:
        failed = of(failures, expected.name)
        return (UNMEASURED, *NOTHING) if failed.empty else (FAILS, None, None, str(failed["reason"].iloc[-1]))
    run = found.iloc[-1]
    value = run[expected.measure] if expected.measure else np.nan
    if expected.equals:
        other = of(runs, expected.equals)
        if other.empty:
            return UNMEASURED, None, None, f"{expected.equals} was not measured"
        value = _difference(run, other.iloc[-1])
    return _judged(expected, str(run["precision"]), float(value))


def _judged(expected: Expectation, precision: str, value: float) -> Told:
    most, least = expected.at_most.get(precision), expected.at_least.get(precision)
    if np.isnan(value):
        asked = most is not None or least is not None
        return (FAILS, None, None, f"there is no {expected.label}") if asked else (HOLDS, *NOTHING)
    if least is not None and value >= least:
        return LIMIT, value, least, expected.limit
    if least is not None:
        return FAILS, value, least, f"expected at least {least:g}"
    if most is None or value <= most:
        return HOLDS, value, most, None
    return FAILS, value, most, f"expected at most {most:g}"


def _difference(run: pd.Series, other: pd.Series) -> float:
    """Return the greatest difference of any measure; infinite where only one of the two has a measure."""
    keys = ["path_end", *(measure.key for measure in MEASURES)]
    one, two = run[keys].astype(float), other[keys].astype(float)
    return float((one - two).abs().mask(one.isna() & two.isna(), 0.0).fillna(np.inf).max())
