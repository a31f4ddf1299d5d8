"""Whether anything measured beside a choice is faster than it."""

from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd

from analysis.claims.outcome import FAILS, HOLDS, OPEN, TOO_FEW, Outcome
from analysis.statistics.verdicts import ERROR, MARGIN, holm, judge_one, not_faster
from analysis.support.wording import share


@dataclass(frozen=True)
class Alternatives:
    """`table` is a row of `judge` an alternative, by `name`, for its time against that of the choice."""

    table: pd.DataFrame
    undecided: int
    """Alternatives of which it is not established that they are not faster."""
    further: list[float]
    """The corrected p-values of the further ways to refute the claim."""

    @property
    def best(self) -> pd.Series:
        """The row of the fastest alternative."""
        return self.table.loc[self.table["ratio"].idxmin()]

    def outcome(self, measured: str) -> Outcome:
        """That nothing is faster by more than the margin holds, does not hold, or is not settled."""
        faster = list(self.table.loc[self.table["verdict"] == "faster", "name"])
        if faster:
            return Outcome(FAILS, measured, f"faster by more than {share(MARGIN)}: {', '.join(faster)}")
        if self.undecided:
            said = f"not settled against {self.undecided} of {len(self.table)} others; {TOO_FEW}"
            return Outcome(OPEN, measured, said)
        return Outcome(
            HOLDS, measured, f"none of {len(self.table)} others is faster by more than {share(MARGIN)}"
        )


def alternatives(pairs: pd.DataFrame, further: Sequence[float] = ()) -> Alternatives:
    """Judge the alternatives; `pairs` has `name` and `log_ratio` = ln(alternative / choice).

    That nothing is faster needs evidence against every alternative (an intersection of tests, each at 5 %);
    that something is faster is Holm-corrected over the alternatives, and over the p-values of `further` ways
    to refute the same claim.
    """
    groups = list(pairs.groupby("name"))
    rows = pd.DataFrame([{"name": name, **judge_one(group["log_ratio"])} for name, group in groups])
    adjusted = holm([*rows["p"], *further])
    stands = [p <= ERROR for p in adjusted[: len(rows)]]
    table = rows.assign(verdict=rows["verdict"].where(stands, "inconclusive"))
    undecided = sum(not not_faster(group["log_ratio"]) for _, group in groups)
    return Alternatives(table, undecided, adjusted[len(rows) :])
