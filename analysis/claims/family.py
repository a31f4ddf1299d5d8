"""The one place where claims are corrected for their number: their parts, and the claims among each other.

Two families, both by Holm's method (Scand. J. Stat. 6, 1979), which asks nothing of how the tests depend on
each other:

* the parts of one claim. It holds if all parts do, which needs no correction: the greatest p-value is its own
  (an intersection-union test, Berger, Technometrics 24, 1982). It does not hold if any part does not, and
  that is corrected for the number of parts;
* the claims of one report that may be decided there: at the study's scale, from enough blocks. Of all of
  them together, "holds" or "does not hold" is said wrongly of any in at most 5 % of studies.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace

from analysis.claims.outcome import FAILS, HOLDS, IN_DIRECTION, OPEN, Outcome, Verdict
from analysis.statistics.looks import ERROR
from analysis.statistics.verdicts import holm
from analysis.support.wording import count, number

ALONE = {HOLDS: "hold", IN_DIRECTION: "hold in direction", FAILS: "not hold"}
IN_ORDER = (FAILS, OPEN, IN_DIRECTION, HOLDS)
"""What a claim comes to is the first of these that one of its parts comes to."""


def both(outcomes: Sequence[Outcome]) -> Outcome:
    """Join the outcomes of a claim's parts: it holds if all do, in direction if one does so, fails if one
    does, and is open otherwise.
    """
    parts = _corrected(outcomes, [FAILS], "part")
    verdicts = [outcome.verdict for outcome in parts]
    verdict = next((one for one in IN_ORDER if one in verdicts), HOLDS)
    # That a claim holds, by whatever, rests on all of its parts.
    decisive = [one for one in parts if one.verdict == verdict or verdict == IN_DIRECTION]
    p = [outcome.p for outcome in decisive if outcome.p is not None]
    return Outcome(
        verdict,
        "; ".join(outcome.measured for outcome in outcomes if outcome.measured),
        "; ".join(dict.fromkeys(outcome.why for outcome in decisive if outcome.why)),
        all(outcome.missing for outcome in outcomes),
        (min(p) if verdict == FAILS else max(p)) if p else None,
        blocks=_blocks(decisive, verdict),
        effects=tuple(effect for outcome in outcomes for effect in outcome.effects),
        against=_against(parts) if verdict == OPEN else None,
        direction=_direction(parts) if verdict == HOLDS else None,
    )


def _direction(parts: Sequence[Outcome]) -> float | None:
    """Return the p-value of all parts' holding in direction at least; None if that is nothing else."""
    if all(one.direction is None for one in parts):
        return None
    return max((one.p or 0.0) if one.direction is None else one.direction for one in parts)


def _blocks(decisive: Sequence[Outcome], verdict: Verdict) -> int:
    """Return the blocks that a verdict rests on: the fewest, but those of the surest part that refutes it."""
    tested = [one for one in decisive if one.p is not None]
    if verdict == FAILS and tested:
        return min(tested, key=lambda one: one.p or 0.0).blocks
    return min((one.blocks for one in decisive), default=0)


def _against(parts: Sequence[Outcome]) -> float | None:
    """Return the p-value of any part's not holding, corrected for their number."""
    against = [one.against for one in parts if one.against is not None]
    return len(parts) * min(against) if against else None


def corrected(claims: Sequence[Outcome]) -> list[Outcome]:
    """Return the outcomes of the claims of one report, open where their verdict no longer stands. What holds
    alone, and not among all, may still hold in direction.
    """
    found = _corrected(claims, list(ALONE), "claim")
    weaker = [
        replace(one, verdict=IN_DIRECTION, p=one.direction)
        if one.verdict == HOLDS and after.verdict == OPEN and one.direction is not None
        else one
        for one, after in zip(claims, found, strict=True)
    ]
    # The others keep what they came to: whoever picks the better of two corrections errs more often.
    retried = _corrected(weaker, list(ALONE), "claim")
    return [
        again if one.verdict == HOLDS and after.verdict == OPEN else after
        for one, after, again in zip(claims, found, retried, strict=True)
    ]


def _corrected(outcomes: Sequence[Outcome], said: Collection[Verdict], noun: str) -> list[Outcome]:
    """Return the outcomes with the p-values of the verdicts `said` corrected for the number of all tests."""
    tested = [one for one in outcomes if one.p is not None]
    adjusted = iter(holm([one.p or 0.0 if one.verdict in said else 1.0 for one in tested]))
    result = []
    for one in outcomes:
        p = 1.0 if one.p is None else next(adjusted)
        stands = one.p is None or one.verdict not in said
        result.append(one if stands else _standing(one, p, count(len(tested), noun)))
    return result


def _standing(outcome: Outcome, p: float, family: str) -> Outcome:
    if p <= ERROR:
        return replace(outcome, p=p)
    why = (
        f"alone it would {ALONE[outcome.verdict]} (p = {number(outcome.p or 0, 2)}), corrected for {family} "
        "it is not settled: more blocks would decide"
    )
    return replace(outcome, verdict=OPEN, why=why, p=p)
