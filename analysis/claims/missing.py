"""What is missing where a claim is open: blocks, minutes, and the command that measures them."""

import math

import pandas as pd

from analysis.claims.entry import Claim, setting
from analysis.claims.outcome import ELSEWHERE, OPEN, Outcome
from analysis.records.studies import Study
from analysis.statistics.noise import MOST_BLOCKS, blocks_to_decide
from analysis.statistics.pairs import PAIR, without_partner
from analysis.support.wording import count, number

DECIDED = frozenset({*ELSEWHERE, *ELSEWHERE.values()})


def is_open(outcome: Outcome) -> bool:
    """Tell whether more blocks can settle it; nothing else that is undecided can be settled here."""
    return outcome.verdict == OPEN and outcome.blocks > 0


def needed(outcome: Outcome, open_claims: int) -> float:
    """Return the blocks that are expected to settle an open claim, infinite if it is not in sight; NaN for a
    claim that is not open. `outcome` is the claim standing alone, before it is corrected.
    """
    if outcome.blocks == 0:
        return math.nan
    p = 1.0 if outcome.p is None else outcome.p
    nearest = p if outcome.against is None else min(p, outcome.against)
    return blocks_to_decide(nearest, outcome.blocks, max(1, open_claims))


def said(study: Study, claim: Claim, blocks: int, wanted: float) -> str:
    """Say in numbers what is missing to settle a claim that rests on so many blocks."""
    if not math.isfinite(wanted):
        return f"not in sight: more than {MOST_BLOCKS} blocks, or the effect lies on the margin"
    minutes = (wanted - blocks) * sum(seconds_per_block(study, name) for name in claim.experiments) / 60
    scale = "" if study.scale == "paper" else f" SCALE={study.scale}"
    asked = f"STUDY={','.join(claim.experiments)}{scale}{setting(claim.questions)}"
    command = f"make experiments {asked} BUDGET={math.ceil(minutes) + 1}"
    more = count(int(wanted) - blocks, "more block")
    return f"open: {more} would be expected to settle it, {number(max(minutes, 0.1), 2)} min: `{command}`"


def seconds_per_block(study: Study, experiment: str) -> float:
    """Return the median time that a block of the experiment took, all processes together; 0 for none."""
    (runs,) = study.of(experiment, "runs")
    each = runs.drop(without_partner(runs).index).groupby(PAIR)["process_seconds"].sum()
    return float(each.median()) if len(each) else 0.0


def tally(table: pd.DataFrame) -> dict[str, int]:
    """Return how many claims of a table of `evaluate` are decided, open, not measured or not decidable."""
    decided, still_open = table["verdict"].isin(DECIDED), table["needed"].notna()
    unmeasured = table["missing"] & ~decided & ~still_open
    states = {"decided": decided, "open": still_open, "not measured": unmeasured}
    counted = {state: int(rows.sum()) for state, rows in states.items()}
    return {**counted, "not decidable here": len(table) - sum(counted.values())}
