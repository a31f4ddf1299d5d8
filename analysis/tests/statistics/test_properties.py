"""What holds of any times whatever: of verdicts, pairs, bootstrap intervals and Holm's correction."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.statistics.bootstrap import FEWEST as FEWEST_PROCESSES
from analysis.statistics.bootstrap import summarise
from analysis.statistics.intervals import FEWEST
from analysis.statistics.looks import ERROR
from analysis.statistics.pairs import log_ratios, without_partner
from analysis.statistics.verdicts import MARGIN, judge_one
from analysis.tests.synthetic_noise import of_processes

RATIOS = st.builds(
    lambda middle, spread, values: [middle + spread * value for value in values],
    st.sampled_from([0, 0.01, -0.01, 0.02, -0.02, 0.03, -0.05]),
    st.sampled_from([3, 0.2, 0.01, 0.003]),
    st.lists(st.floats(-1, 1), min_size=1, max_size=20),
)
"""Far apart, and so near to each other and to the margin that something is known."""

SECONDS = st.floats(1e-6, 1e4)
MIRRORED = {"faster": "slower", "slower": "faster"}


def processes(rows: list[list[float]]) -> pd.DataFrame:
    """Processes with their timed repetitions, a list each, in blocks of their own."""
    return of_processes(
        pd.DataFrame(
            [
                {"file": f"{block}.json", "session": "s", "node": "n", "block": block, "steps_seconds": value}
                for block, values in enumerate(rows)
                for value in values
            ]
        )
    )


@given(RATIOS)
@settings(max_examples=200, deadline=None)
def test_a_verdict_is_that_of_its_interval_and_mirrored_by_changing_sides(values: list[float]) -> None:
    row, other = judge_one(values), judge_one([-value for value in values])
    assert other.verdict == MIRRORED.get(row.verdict, row.verdict)
    assert other.ratio == pytest.approx(1 / row.ratio)
    assert other.p == pytest.approx(row.p)
    assert row.low <= row.ratio <= row.high
    lowest, highest = 1 / (1 + MARGIN), 1 + MARGIN
    if row.verdict == "faster":
        assert row.high <= lowest + 1e-9
    elif row.verdict == "slower":
        assert row.low >= highest - 1e-9
    elif row.verdict == "equivalent":
        assert lowest - 1e-9 <= row.low <= row.high <= highest + 1e-9
    if len(values) < FEWEST:
        assert (row.verdict, row.p, row.not_faster) == ("inconclusive", 1, 1)
        return
    denied = {name: getattr(row, f"not_{name}") <= ERROR for name in ("faster", "slower", "equivalent")}
    assert denied["faster"] == (row.low >= lowest) or row.low == pytest.approx(lowest)
    assert denied["slower"] == (row.high <= highest) or row.high == pytest.approx(highest)
    assert denied["equivalent"] == (row.verdict in ("faster", "slower"))
    assert not denied.get(row.verdict, False)


@given(st.lists(st.tuples(SECONDS, SECONDS), min_size=2, max_size=8), st.floats(1e-3, 1e3))
@settings(max_examples=50, deadline=None)
def test_ratios_do_not_ask_for_the_unit_of_time(blocks: list[tuple[float, float]], unit: float) -> None:
    def ratios(scale: float) -> pd.Series:
        sides = (processes([[scale * pair[side]] for pair in blocks]) for side in (0, 1))
        return log_ratios(*sides)["log_ratio"]

    assert ratios(unit).to_numpy() == pytest.approx(ratios(1).to_numpy(), abs=1e-9)
    assert ratios(1).to_numpy() == pytest.approx([np.log(new / old) for old, new in blocks], abs=1e-9)


@given(
    st.lists(
        st.tuples(st.sampled_from("abc"), st.lists(SECONDS, min_size=1, max_size=4)), min_size=1, max_size=6
    )
)
@settings(max_examples=50, deadline=None)
def test_a_bootstrap_interval_stands_about_the_median_of_enough_processes(
    runs: list[tuple[str, list[float]]],
) -> None:
    sessions, rows = zip(*runs, strict=True)
    table = processes(list(rows)).assign(series="one")
    row = summarise(table.assign(session=table["block"].map(dict(enumerate(sessions)))), ["series"]).iloc[0]
    assert row["median"] == pytest.approx(np.median([np.median(values) for values in rows]))
    assert np.isnan(row["low"]) == np.isnan(row["high"]) == (len(rows) < FEWEST_PROCESSES)
    assert len(rows) < FEWEST_PROCESSES or row["low"] <= row["median"] * (1 + 1e-12)
    assert len(rows) < FEWEST_PROCESSES or row["high"] >= row["median"] * (1 - 1e-12)
    found = (row["sessions"], row["processes"], row["samples"])
    assert found == (len(set(sessions)), len(rows), sum(map(len, rows)))


@given(st.lists(st.tuples(*[st.sampled_from(["", "1", "2", "3"])] * 2), min_size=1, max_size=8))
@settings(max_examples=100, deadline=None)
def test_a_pair_is_of_one_session_and_all_else_is_named(sessions: list[tuple[str, str]]) -> None:
    """Each block has a session for either side, or none where the side was not measured in it."""
    rows = [
        {"node": "n", "block": block, "session": session, "series": series, "x": 0.0, "scene_name": None,
         "steps_seconds": 1.0 + block}
        for block, sides in enumerate(sessions)
        for series, session in zip("ab", sides, strict=True)
        if session
    ]  # fmt: skip
    table = pd.DataFrame(
        rows, columns=["node", "block", "session", "series", "x", "scene_name", "steps_seconds"]
    )
    a, b = (table[table["series"] == name] for name in "ab")
    met = {(block, one) for block, (one, other) in enumerate(sessions) if one == other != ""}
    pairs = log_ratios(a, b)
    assert set(zip(pairs["block"], pairs["session"], strict=True)) == met
    alone = without_partner(table)
    if len(a) and len(b):
        assert len(alone) == len(table) - 2 * len(met)
    else:
        assert alone.empty, "nothing is compared with anything"
