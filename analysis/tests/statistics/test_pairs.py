"""Ratios within blocks, of what a block measures once and of what it measures several times."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.claims.alternatives import alternatives
from analysis.statistics.looks import ERROR
from analysis.statistics.pairs import join_replicates, log_ratios, without_partner

OTHERS = 16
REPLICATES = 4
STUDIES = 12


def processes(logs: NDArray[np.float64]) -> pd.DataFrame:
    """Return a row a process of one configuration, of ln(time) as blocks x replicates."""
    block, _ = (axis.ravel() for axis in np.indices(logs.shape))
    return pd.DataFrame(
        {"node": "node", "session": "session", "block": block, "steps_seconds": np.exp(logs.ravel())}
    )


def test_replicates_in_skewed_noise_are_as_slow_as_a_single_run() -> None:
    generator = np.random.default_rng(3)
    single, several = (generator.exponential(0.1, (4000, number)) for number in (1, REPLICATES))
    ratios = log_ratios(processes(several), processes(single))["log_ratio"]
    assert abs(ratios.mean()) < 3 * ratios.std() / np.sqrt(len(ratios))
    of_medians = single[:, 0] - np.median(several, axis=1)
    assert of_medians.mean() > 3 * of_medians.std() / np.sqrt(len(of_medians))


def test_replicates_are_one_sample_of_their_block() -> None:
    logs = np.array([[0.0, 0.2], [1.0, 1.4]])
    times = processes(logs).assign(series="guided", x=4.0, file=["a", "b", "c", "d"])
    joined = join_replicates(times)
    assert list(joined["block"]) == [0, 1]
    assert np.allclose(np.log(joined["steps_seconds"]), [0.1, 1.2])
    single = times.drop_duplicates("block")
    assert join_replicates(single) is single


def test_replicates_of_the_choice_leave_less_open_in_the_same_time() -> None:
    """Sixteen others, a margin from being faster: 21 blocks of 20 processes take the time of 24 of 17."""
    assert unsettled(REPLICATES, blocks=21) < 0.8 * unsettled(1, blocks=24)


def test_replicates_of_the_choice_halve_the_deviation_from_the_average_of_the_others() -> None:
    several, single = (
        comparisons(replicates, 3000, seed=1).groupby("block")["log_ratio"].mean().std()
        for replicates in (REPLICATES, 1)
    )
    assert several < 0.6 * single


def comparisons(replicates: int, blocks: int, seed: int) -> pd.DataFrame:
    """Return the log ratios of the others against a choice that has replicates, all equally fast."""
    generator = np.random.default_rng(seed)
    choice, *others = (
        processes(generator.normal(0, 0.015, (blocks, number))) for number in (replicates, *[1] * OTHERS)
    )
    return pd.concat(log_ratios(choice, one).assign(name=str(k)) for k, one in enumerate(others))


def unsettled(replicates: int, blocks: int) -> int:
    """Return of how many others, over all studies, it is not settled that they are no faster."""
    tables = [alternatives(comparisons(replicates, blocks, seed)).table for seed in range(STUDIES)]
    return sum(int((table["behind"] > ERROR).sum()) for table in tables)


def measured(*rows: tuple[str, float, int, str]) -> pd.DataFrame:
    """Return a row a run: its series, x, block and session."""
    table = pd.DataFrame(rows, columns=["series", "x", "block", "session"])
    return table.assign(node="n", scene_name=None)


def test_a_series_has_its_partners_at_the_same_x() -> None:
    first = [(name, x, 0, "1") for name in "ab" for x in (1.0, 2.0)]
    later = [("a", x, 1, "1") for x in (1.0, 2.0)]
    assert list(without_partner(measured(*first, *later)).index) == [4, 5], "of b nothing is left"
    again = [("b", 2.0, 1, "2")]
    assert list(without_partner(measured(*first, *later, *again)).index) == [4, 5, 6]


def test_a_single_series_has_its_partners_along_the_sweep() -> None:
    whole = [("a", x, 0, "1") for x in (1.0, 2.0)]
    assert list(without_partner(measured(*whole, ("a", 1.0, 1, "1"), ("a", 2.0, 1, "2"))).index) == [2, 3]
    assert without_partner(measured(("a", 1.0, 0, "1"), ("a", 1.0, 1, "2"))).empty, (
        "it is compared with nothing"
    )


def test_scenes_are_no_partners() -> None:
    runs = measured(("a", 0.0, 0, "1"), ("b", 0.0, 0, "1"), ("a", 0.0, 1, "1"), ("b", 0.0, 1, "1"))
    named = runs.assign(scene_name=["one", "one", "one", "other"])
    assert list(without_partner(named).index) == [2]
