"""What became of a claim: holds, does not hold, or cannot be decided here, with what was measured and why."""

from dataclasses import dataclass

HOLDS = "holds"
FAILS = "does not hold"
OPEN = "cannot be decided here"

NO_RECORDS = "no records yet"
TOO_FEW = "the interval reaches across the margin: more blocks or a quieter machine would decide"


@dataclass(frozen=True)
class Outcome:
    """`measured` is the effect with its 95 % interval, empty if there is none; `why` is the reason in
    words.
    """

    verdict: str
    measured: str = ""
    why: str = ""


def no_records(experiment: str, missing: str = "") -> Outcome:
    """Return the outcome of a claim whose experiment has not been measured, or not with all that it needs."""
    detail = f" of {missing}" if missing else ""
    return Outcome(OPEN, why=f"{NO_RECORDS}{detail} (experiment {experiment!r})")


def both(outcomes: list[Outcome]) -> Outcome:
    """Join the outcomes of a claim's parts: it holds if all do, fails if one does, and is open otherwise."""
    verdicts = [outcome.verdict for outcome in outcomes]
    verdict = FAILS if FAILS in verdicts else OPEN if OPEN in verdicts else HOLDS
    decisive = [outcome for outcome in outcomes if outcome.verdict == verdict]
    return Outcome(
        verdict,
        "; ".join(outcome.measured for outcome in outcomes if outcome.measured),
        "; ".join(dict.fromkeys(outcome.why for outcome in decisive if outcome.why)),
    )
