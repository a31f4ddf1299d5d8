"""The claim about where the time of a step goes."""

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from analysis.claims.effects import effect_of
from analysis.claims.entry import Evidence
from analysis.claims.outcome import Compared, Outcome, directed, judged, no_records
from analysis.statistics.looks import ERROR
from analysis.statistics.pairs import PAIR
from analysis.support.wording import count, number, share

VARIANTS = ["published", "self_contained_off"]
P_VALUES = ("p", "not_faster", "not_slower", "not_equivalent", "any_faster", "any_slower")


def phase_dominates(evidence: Evidence, experiment: str, phase: str, early: str) -> Outcome:
    """Test that the published variant spends more than half of a step in `phase`, with what it does of it
    early, in the phase `early`.

    Early (self-contained) resolves cannot be timed apart from the search around them. Without them `early` is
    the search alone: what it takes longer with them, in the same block, is theirs. This takes the search to
    last as long with them as without. The ratio tested is that of resolving to all the rest.
    """
    (phases,) = evidence.study.of(experiment, "phases")
    walls = phases[phases["variant"].isin(VARIANTS)].pivot_table(
        index=PAIR, columns=["variant", "phase"], values="wall_seconds"
    )
    for variant in VARIANTS:
        if not {(variant, phase), (variant, early)} <= set(walls.columns):
            return no_records(experiment, f"{phase} and {early} of the variant {variant}")
    walls = walls.dropna()
    with_early, without = (walls[variant] for variant in VARIANTS)
    row, of, said = _judged(with_early, without, phase, early)
    measured = (
        f"resolving takes {of}; the ratio to all the rest is {number(row['ratio'])} [{number(row['low'])}, "
        f"{number(row['high'])}], {count(row['blocks'], 'block')}"
    )
    figures = (Compared("share of a step that resolving takes", "–", said),)
    effect = effect_of("resolving against the rest", row)
    return replace(judged(row, "slower", measured, figures), effects=(effect,))


def _judged(
    with_early: pd.DataFrame, without: pd.DataFrame, phase: str, early: str
) -> tuple[dict[str, Any], str, str]:
    """Return the verdict on the ratio of resolving to the rest, of which shares of a step it is, and the
    share in short.

    Two ratios are judged, each with half of the error: that of the later resolves, a share within one
    process, and that of all of them. Since what is done early only adds, the claim holds where either is more
    than half: the surer one is told.
    """
    whole = with_early.sum(axis=1)
    resolved_early = with_early[early] - without[early]
    late, resolving = with_early[phase], with_early[phase] + resolved_early
    parts = pd.DataFrame({"late": late, early: with_early[early], "early": resolved_early, "all": resolving})
    part = parts.div(whole, axis=0).median().map(share)
    late_row, row = (_with_half_of_the_error(np.log(one / (whole - one))) for one in (late, resolving))
    # Later ones of less than half refute nothing.
    is_surer = row["verdict"] != "slower" and late_row["any_slower"] <= min(ERROR, row["any_slower"])
    if late_row["verdict"] == "slower" or is_surer:
        of = f"{part['late']} of a step in {phase} alone, without what is done early in {early}"
        return late_row, of, f"{part['late']} without early resolves"
    of = f"{part['all']} of a step: {part['late']} in {phase} and {part['early']} early, of the {part[early]}"
    return row, f"{of} of {early}", str(part["all"])


def _with_half_of_the_error(log_ratios: pd.Series) -> dict[str, Any]:
    row = directed(log_ratios, error=ERROR / 2)
    return {key: 2 * value if key in P_VALUES else value for key, value in row.items()}
