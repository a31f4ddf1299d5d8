"""What became of a claim: holds, does not hold, or cannot be decided here, with what was measured and why."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum


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
    words. `missing` tells a claim without records from one that they do not decide.
    """

    verdict: Verdict
    measured: str = ""
    why: str = ""
    figures: tuple[Compared, ...] = ()
    missing: bool = False


def no_records(experiment: str, missing: str = "") -> Outcome:
    """Return the outcome of a claim whose experiment has not been measured, or not with all that it needs."""
    detail = f" of {missing}" if missing else ""
    return Outcome(OPEN, why=f"{NO_RECORDS}{detail} (experiment {experiment!r})", missing=True)


def both(outcomes: Sequence[Outcome]) -> Outcome:
    """Join the outcomes of a claim's parts: it holds if all do, fails if one does, and is open otherwise."""
    verdicts = [outcome.verdict for outcome in outcomes]
    verdict = FAILS if FAILS in verdicts else OPEN if OPEN in verdicts else HOLDS
    decisive = [outcome for outcome in outcomes if outcome.verdict == verdict]
    return Outcome(
        verdict,
        "; ".join(outcome.measured for outcome in outcomes if outcome.measured),
        "; ".join(dict.fromkeys(outcome.why for outcome in decisive if outcome.why)),
        tuple(dict.fromkeys(figure for outcome in outcomes for figure in outcome.figures)),
        all(outcome.missing for outcome in outcomes),
    )
