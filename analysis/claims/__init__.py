"""The claims of the published study, each tested again on the records."""

import math
from collections.abc import Callable
from dataclasses import replace

import pandas as pd

from analysis.claims import family, missing, summary
from analysis.claims.curves import falls_then_rises, grows, linear, spike_then_linear
from analysis.claims.entry import Claim, Evidence, evidence_of, load
from analysis.claims.machines import clock
from analysis.claims.outcome import ELSEWHERE, FAILS, OPEN, PLAIN, Outcome, Verdict
from analysis.claims.ratios import fewer_wasted_attempts, pair, phase_dominates
from analysis.claims.scaling import scaling
from analysis.claims.schedules import best_schedule
from analysis.records.studies import Study
from analysis.support.wording import count, listed
from support.errors import InputError

__all__ = ["TESTS", "Claim", "Tested", "evaluate", "evidence_of", "load"]

TESTS: dict[str, Callable[..., Outcome]] = {
    test.__name__: test
    for test in (
        scaling, grows, linear, falls_then_rises, spike_then_linear, pair, fewer_wasted_attempts,
        best_schedule, phase_dominates, clock,
    )
}  # fmt: skip
"""Each a function of the evidence and of the claim's arguments, by its name."""

COLUMNS = [
    "id", "claim", "effect", "claimed_threads", "experiments", "tested_threads", "said", "verdict",
    "measured", "why", "figures", "missing", "p", "blocks", "needed", "name", "effects",
]  # fmt: skip

Tested = dict[str, tuple[object, Outcome]]
"""What claims were tested on, and what came of it, by their ids."""


def evaluate(evidence: Evidence, remembered: Tested | None = None) -> pd.DataFrame:
    """Return a row a claim, of those that the results folder brings along, or of the published ones.

    Columns: `id`, `claim`, `effect` and `claimed_threads` as published, `experiments`, `tested_threads`,
    `verdict` with `said`, the same in words, `measured`, `why`, `figures`, `missing`, the `blocks` it rests
    on and, where more can settle it, how many are `needed`; `name`, the claim in few words, and its
    `effects`, as published and as measured.

    Everything is judged on the records of one study, except the claim about machines, which needs all of
    them. Those that are decided at its scale are corrected for their number (see `family`). Raises InputError
    for a test that there is not.

    What was tested is `remembered` for the next time, and not tested again on the same records: whoever
    looks at a growing folder again and again pays for what is new.
    """
    study = evidence.study
    before = {} if remembered is None else remembered
    listed_claims = load(evidence.folder)
    tested = [_at_scale(_remembered(evidence, one, before), one, study.scale) for one in listed_claims]
    outcomes = family.corrected(tested)
    open_claims = sum(map(missing.is_open, outcomes))
    rows = []
    for claim, alone, outcome in zip(listed_claims, tested, outcomes, strict=True):
        wanted = missing.needed(alone, open_claims) if missing.is_open(outcome) else math.nan
        rows.append({**_row(claim, outcome, study, wanted), "needed": wanted})
    return pd.DataFrame(rows, columns=COLUMNS).astype({"missing": bool})


def _remembered(evidence: Evidence, claim: Claim, tested: Tested) -> Outcome:
    """Test a claim, unless it was tested on the same records before."""
    told = ["file", "recorded_at", "session"]
    records = []
    for study in evidence.studies:
        runs = study.runs[study.runs["experiment"].isin(claim.experiments)]
        records.append((study.name, *runs[told].itertuples(index=False, name=None)))
    known = (claim, evidence.study.name, records)
    if claim.id not in tested or tested[claim.id][0] != known:
        tested[claim.id] = (known, _tested(evidence, claim))
    return tested[claim.id][1]


def _tested(evidence: Evidence, claim: Claim) -> Outcome:
    if claim.test not in TESTS:
        raise InputError(f'claim {claim.id}: test: found "{claim.test}", expected one of {", ".join(TESTS)}')
    try:
        return TESTS[claim.test](evidence, **claim.arguments)
    except TypeError as error:
        raise InputError(f"claim {claim.id}: arguments: {error}") from error


def _row(claim: Claim, outcome: Outcome, study: Study, wanted: float) -> dict[str, object]:
    runs = study.runs[study.runs["experiment"].isin(claim.experiments)]
    tested = tuple(sorted(int(number) for number in runs["threads"].unique()))
    # What those would have shown that failed is not known.
    failed = int(study.failures["experiment"].isin(claim.experiments).sum())
    lost = f"{count(failed, 'process')} failed and left no time" if failed else ""
    outcome = _because(_elsewhere(outcome, claim, tested, study.scale), lost)
    if not math.isnan(wanted):
        outcome = _because(outcome, missing.said(study, claim, outcome.blocks, wanted))
    figures = _setting(claim, tested, runs) + [
        (one.what, summary.published_in_short(one), summary.change_in_short(one)) for one in outcome.effects
    ]
    return {
        "id": claim.id,
        "claim": claim.claim,
        "effect": claim.published.effect,
        "claimed_threads": () if claim.published.threads is None else (claim.published.threads,),
        "experiments": list(claim.experiments),
        "tested_threads": tested,
        "said": _said(outcome, claim, tested, study.scale),
        **vars(outcome),
        "name": claim.name,
        "figures": figures if len(runs) else [],
    }


def _elsewhere(outcome: Outcome, claim: Claim, tested: tuple[int, ...], scale: str) -> Outcome:
    """A verdict on other threads than those of the claim, or at a smaller scale, is one about them alone."""
    if outcome.verdict not in ELSEWHERE or (scale in claim.scales and _on_its_threads(claim, tested)):
        return outcome
    elsewhere = replace(outcome, verdict=ELSEWHERE[outcome.verdict])
    return elsewhere if scale in claim.scales else _because(elsewhere, claim.other_scales)


def _because(outcome: Outcome, more: str) -> Outcome:
    return replace(outcome, why="; ".join(filter(None, (outcome.why, more))))


def _on_its_threads(claim: Claim, tested: tuple[int, ...]) -> bool:
    return claim.published.threads is None or tested == (claim.published.threads,)


def _at_scale(outcome: Outcome, claim: Claim, scale: str) -> Outcome:
    """A scale that says nothing of a claim leaves what was measured, and no verdict."""
    if scale in (*claim.scales, *claim.smaller_scales) or (outcome.verdict == OPEN and not outcome.measured):
        return outcome
    return replace(outcome, verdict=Verdict.OTHER_SCALE, why=claim.other_scales, p=None, blocks=0)


def _said(outcome: Outcome, claim: Claim, tested: tuple[int, ...], scale: str) -> str:
    """What refutes a difference as large as the margin alone says so: a smaller one may be there."""
    verdict = outcome.verdict
    if verdict == Verdict.OTHER_SCALE:
        return f"cannot be decided at {scale} scale"
    if verdict not in PLAIN:
        return str(verdict)
    plain = PLAIN[verdict]
    at_scale = "" if scale in claim.scales else f" at {scale} scale"
    found = [one for one in outcome.effects if one.has_interval]
    if plain == FAILS and found and all(one.low < 1 < one.high for one in found):
        at_scale = f" by {100 * (found[0].within[1] - 1):g} %{at_scale}"
    if _on_its_threads(claim, tested):
        return f"{plain}{at_scale}"
    comma = "," if at_scale else ""
    threads = count(tested[0], "thread") if len(tested) == 1 else f"{listed(tested)} threads"
    return f"{plain}{at_scale}{comma} at {threads} (claimed at {claim.published.threads})"


def _setting(claim: Claim, tested: tuple[int, ...], runs: pd.DataFrame) -> list[tuple[str, str, str]]:
    """The study's parameters beside those of our records."""
    origin = claim.published
    number = "" if origin.threads is None else str(origin.threads)
    said = ", ".join(part for part in (number, origin.threads_said) if part) or "not stated"
    scenes = runs[["particles", "radius", "side", "steps"]].dropna()
    ends = {
        name: listed(sorted({float(one.min()), float(one.max())}), " to ") for name, one in scenes.items()
    }
    scene = (
        "{particles} discs of radius {radius}, side {side}, {steps} steps".format(**ends)
        if len(scenes)
        else "–"
    )
    models = listed(sorted(runs["cpu_model"].unique()))
    return [
        ("threads", said, listed(tested)),
        ("machine", origin.machine, models),
        ("scene", origin.scene, scene),
        ("tolerance", "published", listed(sorted(runs["tolerance"].dropna().unique())) or "–"),
    ]
