"""Whether anything measured beside a choice is faster than it."""

import math
from dataclasses import dataclass, replace
from typing import Any

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
        row = {
            "margin": self.margin,
            "blocks": blocks,
            "p": p,
            "verdict": "inconclusive" if undecided else "not faster",
        }
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
    alone = {
        name: judge_one(group["log_ratio"], margin, biases=group.get("bias"))
        for name, group in pairs.groupby("name")
    }
    table = judge(pairs, ["name"], margin)
    behind, ahead = ([p(alone[name]) for name in table["name"]] for p in (_behind, _ahead))
    return Alternatives(table.assign(behind=behind, ahead=ahead), margin)


def _behind(row: dict[str, Any]) -> float:
    return float(row["not_faster"])


def _ahead(row: dict[str, Any]) -> float:
    return float(row["not_equivalent"]) if row["ratio"] < 1 else math.inf
