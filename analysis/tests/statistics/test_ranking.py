"""Alternatives in order: brackets that hold what cannot be told apart, and nothing else."""

import numpy as np
import pandas as pd
import pytest

from analysis.statistics.ranking import brackets, ranking


def times(means: dict[str, float], blocks: int = 12, noise: float = 0.005) -> pd.DataFrame:
    """Return the times of processes, a block after the other, on a machine that drifts."""
    generator = np.random.default_rng(5)
    rows = [
        {
            "experiment": "league", "series": name, "x": 0.0, "block": block, "node": "n", "session": "s",
            "file": f"{name}-{block}", "repetition": 0,
            "steps_seconds": mean * (1 + 0.05 * block) * np.exp(noise * generator.standard_normal()),
        }
        for block in range(blocks)
        for name, mean in means.items()
    ]  # fmt: skip
    return pd.DataFrame(rows)


def test_those_alike_share_a_letter_and_those_apart_do_not() -> None:
    table = ranking(times({"slow": 1.5, "best": 1.0, "nearly": 1.002, "worst": 1.9})).set_index("series")
    assert list(table.index)[2:] == ["slow", "worst"]
    assert table.loc["best", "bracket"] == table.loc["nearly", "bracket"] == "a"
    assert list(table["bracket"])[2:] == ["b", "c"]
    assert list(table["place"]) == [(1, 2), (1, 2), (3, 3), (4, 4)]


def test_nothing_is_told_apart_from_too_few_blocks() -> None:
    table = ranking(times({"a": 1.0, "b": 3.0}, blocks=3))
    assert list(table["bracket"]) == ["a", "a"]
    assert list(table["place"]) == [(1, 2), (1, 2)]


def test_one_alone_is_first() -> None:
    table = ranking(times({"only": 1.0}))
    assert table.to_dict("records")[0]["place"] == (1, 1)


@pytest.mark.parametrize(
    ("apart", "expected"),
    [
        ([], {"p": "a", "q": "a", "r": "a"}),
        ([("p", "r")], {"p": "a", "q": "ab", "r": "b"}),
        ([("p", "q"), ("p", "r"), ("q", "r")], {"p": "a", "q": "b", "r": "c"}),
        ([("q", "r"), ("p", "r")], {"p": "a", "q": "a", "r": "b"}),
    ],
)
def test_brackets_are_the_longest_stretches(apart: list[tuple[str, str]], expected: dict[str, str]) -> None:
    assert brackets(["p", "q", "r"], apart) == expected


def test_letters_do_not_run_out() -> None:
    names = [f"n{number}" for number in range(60)]
    apart = [(one, two) for one in names for two in names if one < two]
    assert len(set(brackets(names, apart).values())) == 60
