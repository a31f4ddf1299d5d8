import numpy as np
import pandas as pd
import pytest

from analysis.statistics.looks import LOOKS
from analysis.statistics.noise import blocks_needed, needed_said, process_noise, warning
from analysis.statistics.verdicts import judge_one
from analysis.tests.synthetic_noise import Noise, times_table


def noise_of(noise: Noise, blocks: int = 40, figure: str = "comparison") -> pd.Series:
    table = times_table({"a": 1.0, "b": 1.3, "c": 2.0}, blocks, 1, noise, seed=1)
    return process_noise(table.assign(question_kind=figure)).iloc[0]


@pytest.mark.parametrize("deviation", [0.005, 0.02])
@pytest.mark.parametrize("drift", [0.0, 0.3])
def test_the_noise_is_found_under_drift_and_bursts(deviation: float, drift: float) -> None:
    row = noise_of(Noise(process=deviation, repetition=0, burst_rate=0.03, burst_size=1, drift=drift))
    assert row["noise"] == pytest.approx(deviation, rel=0.3)
    assert row["bursts"] > 0


def test_the_blocks_needed_grow_with_the_noise() -> None:
    needed = [blocks_needed(deviation) for deviation in (0.001, 0.005, 0.01, 0.02)]
    assert needed == sorted(needed)
    assert needed[0] == LOOKS[0]


@pytest.mark.parametrize("deviation", [0.004, 0.01, 0.015])
def test_with_the_blocks_needed_equal_variants_come_out_equivalent(deviation: float) -> None:
    blocks = int(blocks_needed(deviation))
    generator = np.random.default_rng(7)
    ratios = generator.normal(0, deviation * np.sqrt(2), (300, blocks))
    verdicts = [judge_one(row).verdict for row in ratios]
    assert verdicts.count("equivalent") >= 0.91 * 300


def test_no_number_of_blocks_is_said_where_more_than_can_be_told_are_needed() -> None:
    assert needed_said(blocks_needed(0.3)) == "more than 1000"
    row = noise_of(Noise(process=0.3, repetition=0, burst_rate=0), blocks=8)
    assert "which needs more than 1000 blocks" in str(warning(pd.DataFrame([row])))


def test_a_label_on_one_side_and_a_configuration_that_soon_failed_leave_the_estimate() -> None:
    table = times_table({"a": 1.0, "b": 1.3, "c": 2.0}, 8, 1, Noise(burst_rate=0, drift=0), seed=1)
    whole = process_noise(table.assign(question_kind="comparison"))
    labelled = table.assign(question_kind="comparison", label=table["series"].map({"a": "A"}))
    assert process_noise(labelled)["noise"].tolist() == whole["noise"].tolist()
    failed = labelled[(labelled["series"] != "c") | (labelled["block"] == 0)]
    assert process_noise(failed)["blocks"].tolist() == [8]


def test_what_has_no_partner_leaves_the_estimate_as_it_is() -> None:
    table = times_table({"a": 1.0, "b": 1.3}, 20, 1, Noise(burst_rate=0, drift=0), seed=1)
    changed = table[(table["series"] == "a") | (table["block"] >= 12)].assign(question_kind="comparison")
    whole = table[table["block"] >= 12].assign(question_kind="comparison")
    assert process_noise(changed).equals(process_noise(whole))


def test_the_warning_names_the_worst_and_what_to_do() -> None:
    loud, quiet = (Noise(process=level, repetition=0, burst_rate=0) for level in (0.03, 0.001))
    table = process_noise(
        pd.concat(
            times_table({f"{name}-a": 1.0, f"{name}-b": 1.0}, 6, 1, noise, seed=2).assign(
                experiment=name, question_kind="comparison"
            )
            for name, noise in (("loud", loud), ("quiet", quiet))
        )
    )
    text = warning(table)
    assert text is not None
    assert "1 of 2" in text
    assert "'loud'" in text
    assert "blocks" in text
    assert "experiments about small ones: loud." in text
    assert warning(table[table["experiment"] == "quiet"]) is None
    assert warning(table, {"loud"}) is None, "its verdicts are settled all the same"


def test_trends_are_not_warned_about() -> None:
    row = noise_of(Noise(process=0.05, repetition=0), blocks=5, figure="trend")
    assert not row["enough"]
    assert warning(pd.DataFrame([row])) is None


def test_one_block_has_no_noise() -> None:
    table = times_table({"a": 1.0, "b": 1.0}, 1, 3, Noise(), seed=1).assign(question_kind="control")
    assert process_noise(table).empty
