"""The claim about where the time of a step goes."""

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.outcome import Compared, Outcome, judged, no_records, points_of
from analysis.statistics.pairs import PAIR
from analysis.statistics.verdicts import judge_one
from analysis.support.wording import count, number, share

VARIANTS = ["published", "self_contained_off"]


def phase_dominates(evidence: Evidence, experiment: str, phase: str, early: str) -> Outcome:
    """Test that the published variant spends more than half of a step in `phase`, with what it does of it
    early, in the phase `early`.

    Early (self-contained) resolves cannot be timed apart from the search around them. Without them `early` is
    the search alone: what it takes longer with them, in the same block, is theirs. This takes the search to
    last as long with them as without. The ratio tested is that of resolving to all the rest.
    """
    phases = evidence.study.phases[evidence.study.phases["experiment"] == experiment]
    walls = phases[phases["variant"].isin(VARIANTS)].pivot_table(
        index=PAIR, columns=["variant", "phase"], values="wall_seconds"
    )
    for variant in VARIANTS:
        if not {(variant, phase), (variant, early)} <= set(walls.columns):
            return no_records(experiment, f"{phase} and {early} of the variant {variant}")
    walls = walls.dropna()
    with_early, without = (walls[variant] for variant in VARIANTS)
    whole = with_early.sum(axis=1)
    resolved_early = with_early[early] - without[early]
    resolving = with_early[phase] + resolved_early
    row = _row(with_early[phase], resolving, whole)
    parts = pd.DataFrame({phase: with_early[phase], early: with_early[early], "early": resolved_early})
    part = parts.div(whole, axis=0).median()
    measured = (
        f"resolving takes {share(float((resolving / whole).median()))} of a step: {share(part[phase])} in "
        f"{phase} and {share(part['early'])} early, of the {share(part[early])} of {early}; the ratio to all "
        f"the rest of {row['of']} is {number(row['ratio'])} [{number(row['low'])}, {number(row['high'])}], "
        f"{count(row['blocks'], 'block')}"
    )
    said = f"{share(float((resolving / whole).median()))}, {share(part[phase])} without early resolves"
    figures = (Compared("share of a step that resolving takes", "–", said),)
    return replace(
        judged(row, "slower", measured, figures),
        not_asked=points_of(phases[~phases["variant"].isin(VARIANTS)]),
    )


def _row(late: pd.Series, resolving: pd.Series, whole: pd.Series) -> dict[str, Any]:
    """Return the verdict on the ratio of resolving to the rest, and which resolving it is `of`: without what
    was done early where that is more than half already, since what is done early only adds. It is a share
    within one process, and so the surer one.
    """
    alone = judge_one(np.log(late / (whole - late)))
    if alone["ratio"] > 1 and alone["verdict"] != "equivalent":
        return {**alone, "of": "resolving without what is done early"}
    return {**judge_one(np.log(resolving / (whole - resolving))), "of": "all resolving"}
