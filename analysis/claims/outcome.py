"""What became of a claim: holds, does not hold, or cannot be decided here, with what was measured and why."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from math import isfinite
from typing import Any

from numpy.typing import ArrayLike

from analysis.claims.effects import Effect
from analysis.statistics.intervals import FEWEST
from analysis.statistics.looks import ERROR
from analysis.statistics.verdicts import MARGIN, judge_one
from analysis.support.wording import count, percent


class Verdict(StrEnum):
    """What can be said of a claim; one tested elsewhere, on other threads or at a smaller scale than it was
    made, is neither confirmed nor refuted.
    """

    HOLDS = "holds"
    IN_DIRECTION = "holds in direction"
    FAILS = "does not hold"
    HOLDS_ELSEWHERE = "holds elsewhere than claimed"
    IN_DIRECTION_ELSEWHERE = "holds in direction elsewhere than claimed"
    FAILS_ELSEWHERE = "does not hold elsewhere than claimed"
    OPEN = "cannot be decided here"
    OTHER_SCALE = "cannot be decided at this scale"


HOLDS, FAILS, OPEN = Verdict.HOLDS, Verdict.FAILS, Verdict.OPEN
IN_DIRECTION = Verdict.IN_DIRECTION
ELSEWHERE = {
    HOLDS: Verdict.HOLDS_ELSEWHERE,
    IN_DIRECTION: Verdict.IN_DIRECTION_ELSEWHERE,
    FAILS: Verdict.FAILS_ELSEWHERE,
}
"""A verdict, and what is left of it where the claim was made on other threads or at another scale."""

PLAIN = {elsewhere: plain for plain, elsewhere in ELSEWHERE.items()}

NO_RECORDS = "no records yet"
SETTLES = {
    "faster": ("faster", "not faster"),
    "slower": ("slower", "not slower"),
    "equivalent": ("equivalent", "faster", "slower"),
}
"""What settles a claim that expects a verdict on a ratio."""
TOO_FEW = "the interval reaches across the margin: more blocks or a quieter machine would decide"


@dataclass(frozen=True)
class Compared:
    """One figure of the study beside ours; an en dash for what one of the two does not have."""

    what: str
    published: str
    here: str


@dataclass(frozen=True)
class Outcome:
    """`measured` is the effect with its 95 % interval, empty if there is none; `why` is the reason in
    words. `missing` tells a claim without records from one that they do not decide. `p` is the p-value of the
    verdict, or of the one best supported; None where nothing could be tested. `blocks` is how many it rests
    on, 0 where more of them would not help. `against` is, of a claim that is open, the p-value of its not
    holding, infinite if nothing speaks against it, None if `p` is of whatever speaks for the nearest verdict.
    """

    verdict: Verdict
    measured: str = ""
    why: str = ""
    figures: tuple[Compared, ...] = ()
    missing: bool = False
    p: float | None = None
    against: float | None = None
    direction: float | None = None
    """Of a claim that holds, the p-value of its holding in direction, where that is something else."""
    blocks: int = 0
    effects: tuple[Effect, ...] = ()
    """What it is about as numbers."""


def no_records(experiment: str, missing: str = "") -> Outcome:
    """Return the outcome of a claim whose experiment has not been measured, or not with all that it needs."""
    detail = f" of {missing}" if missing else ""
    return Outcome(OPEN, why=f"{NO_RECORDS}{detail} (experiment {experiment!r})", missing=True)


def directed(log_ratios: ArrayLike, margin: float = MARGIN, **more: Any) -> dict[str, Any]:  # noqa: ANN401
    """Return the row of `judge_one`, which takes `more`, with its `margin`, and the p-values of the ratio
    being less than 1 and more than 1, by however little: `any_faster` and `any_slower`.
    """
    level = judge_one(log_ratios, 0.0, **more)
    any_change = {"any_faster": level["not_slower"], "any_slower": level["not_faster"]}
    return {**judge_one(log_ratios, margin, **more), "margin": margin, **any_change}


def judged(
    row: Mapping[str, Any],
    expected: str,
    measured: str,
    figures: tuple[Compared, ...] = (),
    unsettled: str = TOO_FEW,
    unit: str = "block",
) -> Outcome:
    """Return what a verdict with its `p`, from so many `blocks` (or another unit), says of a claim that
    expects one; `unsettled` is why it is open where they are enough and do not decide.

    That one choice is faster, or slower, holds in direction where the interval of a row of `directed` lies
    wholly on that side of 0, but not beyond the margin. Else a claim does not hold where the interval has no
    part in what was expected, whether or not it tells the other verdicts from each other. A row without the
    p-value of that, e.g. `not_faster`, fails by another verdict.
    """
    outcome = Outcome(OPEN, measured, figures=figures, blocks=row["blocks"])
    if row["blocks"] < FEWEST:
        why = f"rests on {count(row['blocks'], unit)}: a verdict needs at least {FEWEST}"
        return replace(outcome, why=why)
    against = row.get(denial(expected))
    if row["verdict"] == expected:
        return replace(outcome, verdict=HOLDS, p=row["p"], direction=row.get(f"any_{expected}"))
    if _is_in_direction(row, expected):
        return replace(outcome, verdict=IN_DIRECTION, p=row[f"any_{expected}"])
    if against is not None and against <= ERROR:
        return replace(outcome, verdict=FAILS, p=against)
    if row["verdict"] != "inconclusive":
        return replace(outcome, verdict=FAILS, p=row["p"])
    return replace(outcome, why=unsettled + _short(row, expected), p=row["p"], against=against)


def told(row: Mapping[str, Any], expected: str) -> str:
    """Return the verdict of a row in words, with what it denies where it tells no more, e.g. `faster`, `not
    faster`, `faster, but by less than 2 %` or `faster, unknown whether by 2 %`.
    """
    is_denied = row.get(denial(expected), 1.0) <= ERROR
    if row["verdict"] != expected and _is_in_direction(row, expected):
        how = "but by less than" if is_denied else "unknown whether by"
        return f"{expected}, {how} {100 * row['margin']:g} %"
    if row["verdict"] == "inconclusive" and is_denied:
        return denial(expected).replace("_", " ")
    return str(row["verdict"])


def denial(expected: str) -> str:
    """Return the name of the p-value of an expected verdict's contrary (see `judge_one`)."""
    return f"not_{expected}"


def _is_in_direction(row: Mapping[str, Any], expected: str) -> bool:
    return row["blocks"] >= FEWEST and row.get(f"any_{expected}", 1.0) <= ERROR


def _short(row: Mapping[str, Any], expected: str) -> str:
    """Say by how much the interval of a ratio, if a row has one, misses the verdict that it is closest to."""
    if "low" not in row or not isfinite(row["low"]) or not isfinite(row["high"]):
        return ""
    margin = row.get("margin", MARGIN)
    least, most = 1 / (1 + margin), 1 + margin
    by = {
        "faster": row["high"] - least,
        "slower": most - row["low"],
        "equivalent": max(row["high"] - most, least - row["low"]),
        "not faster": least - row["low"],
        "not slower": row["high"] - most,
    }
    nearest = min(SETTLES[expected], key=lambda verdict: by[verdict])
    return f" ({percent(by[nearest]).lstrip('+')} short of {nearest})" if by[nearest] > 0 else ""
