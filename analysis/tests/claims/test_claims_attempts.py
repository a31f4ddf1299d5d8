"""The claim about wasted attempts: counted, on several seeds."""

from pathlib import Path

import pandas as pd
import pytest

from analysis import claims
from analysis.claims.outcome import FAILS, HOLDS, OPEN
from analysis.records.reading import load
from analysis.tests.claims.judging import row_of
from analysis.tests.synthetic import Machine, Point, bench

SEEDS = (1, 2, 3, 4, 5, 6)


def reverse(
    folder: Path, attempts: dict[str, list[int]], resolves: dict[str, int] | None = None, scale: str = "paper"
) -> pd.Series:
    """Return the claim's row: attempts of each direction by seed; reverse is the slower one."""
    resolved = resolves or {"reverse": 1000, "forward": 1000}
    points = [
        Point(direction, seed, 1.2 if direction == "reverse" else 1.0, "seed", axes={"direction": direction},
              pair_resolves=resolved[direction], pair_attempts=count)
        for direction, counts in attempts.items()
        for seed, count in zip(SEEDS, counts, strict=False)
    ]  # fmt: skip
    records = [
        bench("reverse", point, block, [point.seconds * (1 + block / 1000)], Machine(), scale=scale)
        for point in points
        for block in range(3)
    ]
    return row_of(folder, records, "reverse")


FEWER = {"reverse": [1500, 1510, 1490, 1505, 1495, 1500], "forward": [2000, 2010, 1990, 1980, 2020, 2000]}


def test_fewer_wasted_attempts_hold_whatever_the_time_and_the_resolves(tmp_path: Path) -> None:
    row = reverse(tmp_path, FEWER, {"reverse": 1000, "forward": 1000})
    assert row["verdict"] == HOLDS
    assert "over 6\u00a0seeds" in row["measured"]
    assert "of wasted attempts (fewer)" in row["measured"]
    assert "of pair resolves (equivalent)" in row["measured"]
    assert "+20.0\u00a0% [+20.0\u00a0%, +20.0\u00a0%] of time" in row["measured"]


def test_the_same_waste_does_not_hold_though_fewer_are_resolved(tmp_path: Path) -> None:
    attempts = {
        "reverse": [1500, 1510, 1490, 1505, 1495, 1500],
        "forward": [1600, 1610, 1590, 1605, 1595, 1600],
    }
    row = reverse(tmp_path, attempts, {"reverse": 1000, "forward": 1100})
    assert row["verdict"] == FAILS
    assert "of pair resolves (fewer)" in row["measured"]


def test_blocks_are_no_repetitions_of_a_count(tmp_path: Path) -> None:
    one = {direction: counts[:1] for direction, counts in FEWER.items()}
    row = reverse(tmp_path, one)
    assert row["verdict"] == OPEN
    assert row["why"] == "rests on 1\u00a0seed: a verdict needs at least 6"


def test_seeds_that_disagree_decide_nothing(tmp_path: Path) -> None:
    row = reverse(tmp_path, {"reverse": [1220, 1700, 1300, 1650, 1250, 1600], "forward": [1500] * 6})
    assert row["verdict"] == OPEN
    assert "more seeds" in row["why"]


def test_attempts_that_were_not_counted_are_no_zero(tmp_path: Path) -> None:
    reverse(tmp_path, FEWER)
    [evidence] = claims.evidence_of(load(tmp_path))
    evidence.study.runs["pair_attempts"] = float("nan")  # as it is of whole processes
    row = claims.evaluate(evidence).set_index("id").loc["reverse"]
    assert row["verdict"] == OPEN
    assert "not counted" in row["why"]


@pytest.mark.parametrize("scale", ["paper", "quick"])
def test_a_count_is_decided_at_both_scales(tmp_path: Path, scale: str) -> None:
    assert reverse(tmp_path, FEWER, scale=scale)["verdict"] == HOLDS
