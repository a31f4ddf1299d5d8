"""Whether anything measured beside a choice is faster than it."""

import math
from dataclasses import dataclass, replace

import pandas as pd

from analysis.claims.outcome import FAILS, TOO_FEW, Outcome, judged
from analysis.statistics.looks import ERROR
from analysis.statistics.verdicts import MARGIN, judge, judge_one


@dataclass(frozen=True)
class Alternatives:
    """`table` is a row of `judge` an alternative, by `name`, for its time against that of the choice, with
    `behind`, the p-value of its not being faster, and `ahead`, that of its being so, infinite if slower.
    """

    table: pd.DataFrame
    margin: float = MARGIN

    @property
    def best(self) -> pd.Series:
        """The row of the fastest alternative."""
        return self.table.loc[self.table["ratio"].idxmin()]

    def outcome(self, measured: str) -> Outcome:
        """That nothing is faster by more than the margin holds, does not hold, or is not settled."""
        blocks, others = int(self.table["blocks"].min()), len(self.table)
        faster = self.table[self.table["verdict"] == "faster"]
        if len(faster):
            why = f"faster by more than {100 * self.margin:g} %: {', '.join(faster['name'])}"
            return Outcome(FAILS, measured, why, p=float(faster["p"].min()), blocks=blocks)
        p = float(self.table["behind"].max())
        undecided = int((self.table["behind"] > ERROR).sum())
        verdict = "inconclusive" if undecided else "not faster"
        row = {"margin": self.margin, "blocks": blocks, "p": p, "verdict": verdict}
        said = f"not settled against {undecided} of {others} others; {TOO_FEW}"
        found = judged(row, "not faster", measured, unsettled=said)
        why = found.why or f"none of {others} others is faster by more than {100 * self.margin:g} %"
        against = float(self.table["ahead"].min()) * others if undecided else None
        return replace(found, why=why, against=against)


def alternatives(pairs: pd.DataFrame, margin: float = MARGIN) -> Alternatives:
    """Judge the alternatives; `pairs` has `name` and `log_ratio` = ln(alternative / choice).

    That nothing is faster needs evidence against every alternative (an intersection of tests, each at 5 %);
    that something is faster is Holm-corrected over the alternatives.
    """
    groups = (group for _, group in pairs.groupby("name"))
    alone = [
        judge_one(group["log_ratio"], margin, biases=group.get("bias"), stops=group.get("stops"))
        for group in groups
    ]
    behind = [row["not_faster"] for row in alone]
    ahead = [row["not_equivalent"] if row["ratio"] < 1 else math.inf for row in alone]
    return Alternatives(judge(pairs, ["name"], margin).assign(behind=behind, ahead=ahead), margin)
