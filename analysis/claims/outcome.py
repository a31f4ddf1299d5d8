"""What became of a claim: holds, does not hold, or cannot be decided here, with what was measured and why."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from analysis.statistics.intervals import FEWEST
from analysis.support.wording import count


class Verdict(StrEnum):
    """What can be said of a claim; one made on another number of threads is neither confirmed nor refuted."""

    HOLDS = "holds"
    FAILS = "does not hold"
    HOLDS_ELSEWHERE = "holds at another number of threads"
    FAILS_ELSEWHERE = "does not hold at another number of threads"
    OPEN = "cannot be decided here"
    OTHER_SCALE = "cannot be decided at this scale"


HOLDS, FAILS, OPEN = Verdict.HOLDS, Verdict.FAILS, Verdict.OPEN
ELSEWHERE = {HOLDS: Verdict.HOLDS_ELSEWHERE, FAILS: Verdict.FAILS_ELSEWHERE}
"""A verdict, and what is left of it where the claim was made on another number of threads."""

NO_RECORDS = "no records yet"
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
    verdict, or of the one best supported; None where nothing could be tested.
    """

    verdict: Verdict
    measured: str = ""
    why: str = ""
    figures: tuple[Compared, ...] = ()
    missing: bool = False
    p: float | None = None


def no_records(experiment: str, missing: str = "") -> Outcome:
    """Return the outcome of a claim whose experiment has not been measured, or not with all that it needs."""
    detail = f" of {missing}" if missing else ""
    return Outcome(OPEN, why=f"{NO_RECORDS}{detail} (experiment {experiment!r})", missing=True)


def judged(
    row: Mapping[str, Any],
    expected: str,
    measured: str,
    figures: tuple[Compared, ...] = (),
    unsettled: str = TOO_FEW,
    unit: str = "block",
) -> Outcome:
    """Return what a verdict with its `p`, from so many `blocks` (or another unit), says of a claim that
    expects
    one; `unsettled` is why it is open where they are enough and do not decide.
    """
    if row["blocks"] < FEWEST:
        why = f"rests on {count(row['blocks'], unit)}: a verdict needs at least {FEWEST}"
        return Outcome(OPEN, measured, why, figures)
    if row["verdict"] == "inconclusive":
        return Outcome(OPEN, measured, unsettled, figures, p=row["p"])
    return Outcome(HOLDS if row["verdict"] == expected else FAILS, measured, figures=figures, p=row["p"])
