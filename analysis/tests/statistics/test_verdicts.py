"""The verdicts' error rates, simulated with fixed seeds on noise like that of a shared two-CPU machine."""

from collections import Counter

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from analysis.statistics.pairs import log_ratios
from analysis.statistics.verdicts import holm, judge, judge_one
from analysis.tests.synthetic_noise import Noise, times_table

Floats = NDArray[np.float64]

STUDIES = 100
VM = Noise()
NOISY = Noise(process=0.02, repetition=0.03, burst_rate=0.1)


def verdicts(effect: float, blocks: int, noise: Noise, repetitions: int = 5) -> Counter[str]:
    """Return how often each verdict was given on `candidate` taking (1 + effect) times as long."""
    truth = {"reference": 1.0, "candidate": 1.0 + effect}
    tables = [times_table(truth, blocks, repetitions, noise, seed).assign(x=seed) for seed in range(STUDIES)]
    times = pd.concat(tables)
    processes = times.assign(file=times["file"] + times["x"].map("-study-{}".format))
    reference, candidate = (processes[processes["series"] == name] for name in truth)
    pairs = log_ratios(reference, candidate, match=("x",))
    return Counter(judge_one(study["log_ratio"]).verdict for _, study in pairs.groupby("x"))


@pytest.mark.parametrize(("blocks", "repetitions"), [(32, 3), (48, 1)])
def test_control_is_equivalent_in_95_of_100_studies(blocks: int, repetitions: int) -> None:
    assert verdicts(0.0, blocks, VM, repetitions)["equivalent"] >= 95


@pytest.mark.parametrize(("blocks", "found"), [(14, 70), (21, 95)])
def test_five_percent_is_found(blocks: int, found: int) -> None:
    assert verdicts(0.05, blocks, VM)["slower"] >= found
    assert verdicts(-0.05, blocks, VM)["faster"] >= found


@pytest.mark.parametrize("blocks", [6, 9, 14])
def test_one_percent_is_never_called_a_difference(blocks: int) -> None:
    counts = verdicts(0.01, blocks, VM)
    assert counts["slower"] + counts["faster"] <= 1


def test_one_percent_is_called_equivalent_with_enough_blocks() -> None:
    assert verdicts(0.01, blocks=72, noise=VM)["equivalent"] >= 95


@pytest.mark.parametrize("blocks", [6, 14])
def test_noise_leads_to_undecided_and_not_to_wrong(blocks: int) -> None:
    equal, far = verdicts(0.0, blocks, NOISY), verdicts(0.05, blocks, NOISY)
    assert equal["slower"] + equal["faster"] <= 5
    assert far["equivalent"] + far["faster"] <= 5
    assert equal["inconclusive"] > 50


def test_drift_over_the_blocks_cancels() -> None:
    drifting = Noise(burst_rate=0, drift=0.5)
    assert verdicts(0.0, blocks=12, noise=drifting) == verdicts(0.0, 12, Noise(burst_rate=0, drift=0.0))


def test_holm_as_worked_by_hand() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.9, 0.8]) == [1.0, 1.0]
    assert holm([]) == []


def test_the_table_is_corrected_over_its_rows() -> None:
    ratios = np.log(1.02) + np.array([0.014, 0.016, 0.018, 0.012, 0.015, 0.016])
    alone = judge_one(ratios)
    rows = pd.concat(pd.DataFrame({"row": row, "log_ratio": ratios}) for row in range(1000))
    assert alone.verdict == "slower"
    assert set(judge(rows, ["row"])["verdict"]) == {"inconclusive"}


def test_a_process_without_partner_and_a_block_over_two_sessions() -> None:
    table = times_table({"a": 1.0, "b": 1.1}, 4, 2, Noise(), seed=1)
    table.loc[table["file"] == "b-2", "session"] = "resumed"
    pairs = log_ratios(table[table["series"] == "a"].iloc[1:], table[table["series"] == "b"])
    assert list(pairs["block"]) == [1, 3], "of block 0 one side is missing, of block 2 the sides never met"
    other = table.assign(node="elsewhere")
    assert log_ratios(table[table["series"] == "a"], other[other["series"] == "b"]).empty
