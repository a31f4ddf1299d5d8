"""What became of a claim: holds, does not hold, or cannot be decided here, with what was measured and why."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from math import nan

from analysis.statistics.intervals import FEWEST
from analysis.statistics.looks import ERROR
from analysis.statistics.verdicts import INCONCLUSIVE, MARGIN, Ratio, within_margin
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
    missing: bool = False
    p: float | None = None
    against: float | None = None
    direction: float | None = None
    """Of a claim that holds, the p-value of its holding in direction, where that is something else."""
    blocks: int = 0
    effects: tuple[Ratio, ...] = ()
    """What it is about as numbers."""


def no_records(experiment: str, missing: str = "", effects: Iterable[Ratio] = ()) -> Outcome:
    """Return the outcome of a claim whose experiment has not been measured, or not with all that it needs."""
    detail = f" of {missing}" if missing else ""
    why = f"{NO_RECORDS}{detail} (experiment {experiment!r})"
    return Outcome(OPEN, why=why, missing=True, effects=tuple(effects))


def unmeasured(what: str, published: float = nan, margin: float = MARGIN) -> Ratio:
    """Return a ratio of which there are no records."""
    return Ratio(what=what, published=published, within=within_margin(margin))


def judged(
    row: Ratio, expected: str, measured: str = "", unsettled: str = TOO_FEW, unit: str = "block"
) -> Outcome:
    """Return what a verdict, from so many `blocks` (or another unit), says of a claim that expects one, with
    the ratio as its effect; `unsettled` is why it is open where they are enough and do not decide.

    That one choice is faster, or slower, holds in direction where the interval lies wholly on that side of 0,
    but not beyond the margin. Else a claim does not hold where the interval has no part in what was expected,
    whether or not it tells the other verdicts from each other. What has no p-value of that, as where a curve
    `grows`, fails by another verdict.
    """
    outcome = Outcome(OPEN, measured, blocks=row.blocks, effects=(row,))
    if row.blocks < FEWEST:
        why = f"rests on {count(row.blocks, unit)}: a verdict needs at least {FEWEST}"
        return replace(outcome, why=why)
    against, direction = denial(row, expected), getattr(row, f"any_{expected}", None)
    if row.verdict == expected:
        return replace(outcome, verdict=HOLDS, p=row.p, direction=direction)
    if _is_in_direction(row, expected):
        return replace(outcome, verdict=IN_DIRECTION, p=direction)
    if against is not None and against <= ERROR:
        return replace(outcome, verdict=FAILS, p=against)
    if row.verdict != INCONCLUSIVE:
        return replace(outcome, verdict=FAILS, p=row.p)
    return replace(outcome, why=unsettled + _short(row, expected), p=row.p, against=against)


def told(row: Ratio, expected: str) -> str:
    """Return the verdict of a ratio in words, with what it denies where it tells no more, e.g. `faster`, `not
    faster`, `faster, but by less than 2 %` or `faster, unknown whether by 2 %`.
    """
    denied = denial(row, expected)
    is_denied = denied is not None and denied <= ERROR
    if row.verdict != expected and _is_in_direction(row, expected):
        how = "but by less than" if is_denied else "unknown whether by"
        return f"{expected}, {how} {100 * (row.within[1] - 1):g} %"
    return f"not {expected}" if row.verdict == INCONCLUSIVE and is_denied else row.verdict


def denial(row: Ratio, expected: str) -> float | None:
    """Return the p-value of an expected verdict's contrary, None of a verdict that has none."""
    p: float | None = getattr(row, f"not_{expected}", None)
    return p


def _is_in_direction(row: Ratio, expected: str) -> bool:
    p = getattr(row, f"any_{expected}", None)
    return row.blocks >= FEWEST and p is not None and p <= ERROR


def _short(row: Ratio, expected: str) -> str:
    """Say by how much an interval, if there is one, misses the verdict that it is closest to."""
    if expected not in SETTLES or not row.has_interval:
        return ""
    least, most = row.within
    by = {
        "faster": row.high - least,
        "slower": most - row.low,
        "equivalent": max(row.high - most, least - row.low),
        "not faster": least - row.low,
        "not slower": row.high - most,
    }
    nearest = min(SETTLES[expected], key=lambda verdict: by[verdict])
    return f" ({percent(by[nearest]).lstrip('+')} short of {nearest})" if by[nearest] > 0 else ""
