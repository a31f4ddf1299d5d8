"""What of a study is still open: for whoever measures on, experiment by experiment."""

import math
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import pandas as pd

from analysis import claims
from analysis.claims.missing import DECIDED
from analysis.derived.comparisons import differences, reference, stated
from analysis.records.studies import Study
from analysis.statistics.looks import next_look
from analysis.statistics.noise import needed_by_rows
from analysis.statistics.verdicts import INCONCLUSIVE
from analysis.support.wording import change

COMPARED = ("comparison", "control")
"""Kinds of questions whose every difference has a verdict, also in a question that no claim is about."""

Item = tuple[str, int, float]
"""What has a verdict: its experiment, its blocks, and the blocks that it needs, NaN if it is decided."""

OPTIMISM = 12
"""How many times the blocks there are settle what seems to lie on a margin, should it lie a standard error
off: the square of the 3.5 standard errors that a look at one of a dozen claims asks for.
"""

PATIENCE = 32
"""Blocks up to which it is given that benefit. What still seems to lie on a margin then takes time from what
does not.
"""


def open_questions(results: Path, remembered: claims.Tested | None = None) -> dict[str, Any]:
    """Return `open`: experiment -> the `blocks` it has, the `next` number at which to look again, and those
    that are `needed` to settle the first thing that is open in it; `settled`: the experiments in which
    nothing is; `said`: name -> what was decided.

    Of the first study in the folder. What is not in sight, as measured, is given the benefit of a standard
    error (`OPTIMISM`), up to `PATIENCE` blocks; beyond, it is neither open nor settled. What is `remembered`
    of an earlier look at the folder is not tested again.
    """
    studies = claims.evidence_of(results)
    found: dict[str, Any] = {"open": {}, "settled": [], "said": {}}
    if not studies:
        return found
    table = claims.evaluate(studies[0], remembered)
    decided = table[table["verdict"].isin(DECIDED)]
    found["said"] = {row.id: f"{row.said}: {row.measured}" for row in decided.itertuples()}
    claimed = {experiment for claim in claims.load(results) for experiment in claim.experiments}
    items = [*_claims(table), *_comparisons(studies[0].study, claimed, found["said"])]
    experiments = dict.fromkeys(experiment for experiment, _, _ in items)
    for experiment in experiments:
        own = [
            (OPTIMISM * blocks if math.isinf(needed) and blocks <= PATIENCE else needed, blocks)
            for name, blocks, needed in items
            if name == experiment
        ]
        in_sight = [one for one in own if math.isfinite(one[0])]
        if in_sight:
            needed, blocks = min(in_sight)
            found["open"][experiment] = {"blocks": blocks, "next": next_look(blocks), "needed": int(needed)}
        elif all(math.isnan(needed) for needed, _ in own):
            found["settled"].append(experiment)
    return found


def _claims(table: pd.DataFrame) -> Iterator[Item]:
    """Yield the items of the claims."""
    for row in table.itertuples():
        if row.verdict in DECIDED or not math.isnan(row.needed):
            for experiment in row.experiments:
                yield experiment, int(row.blocks), float(row.needed)


def _comparisons(study: Study, claimed: Collection[str], said: dict[str, str]) -> Iterator[Item]:
    """Yield the items of the differences that comparisons draw; add to `said` what is decided."""
    for experiment, times in study.times.groupby("experiment"):
        if experiment in claimed or times["question_kind"].iloc[0] not in COMPARED:
            continue
        against = reference(times)
        table = differences(times, against)
        needed = needed_by_rows(table, stated(times).error)
        for row, wanted in zip(table.itertuples(), needed, strict=True):
            if row.verdict != INCONCLUSIVE:
                said[f"{experiment}: {row.series} against {against}"] = (
                    f"{row.verdict}: {change(row)} of time"
                )
            yield str(experiment), row.blocks, wanted
