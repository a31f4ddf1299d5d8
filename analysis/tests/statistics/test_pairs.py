"""Ratios within blocks, of what a block measures once and of what it measures several times."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from analysis.statistics.pairs import join_replicates, log_ratios, scaled, without_partner
from analysis.statistics.turns import location
from analysis.statistics.verdicts import judge_pairs

REPLICATES = 4


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
    assert ratios.std() < 0.85 * 0.1 * np.sqrt(2), "which two single ones have"
    of_medians = single[:, 0] - np.median(several, axis=1)
    assert of_medians.mean() > 3 * of_medians.std() / np.sqrt(len(of_medians))


def in_rounds(turns: NDArray[np.float64], block: int = 0) -> pd.DataFrame:
    """Return a process with these turns, whose time is their sum."""
    return processes(np.log([[turns.sum()]])).assign(
        block=block, steps_seconds_of_runs=[np.array([turns.sum()])], steps_seconds_of_rounds=[turns]
    )


def test_a_burst_in_a_turn_moves_the_ratio_of_sums_and_not_that_of_rounds() -> None:
    generator = np.random.default_rng(4)
    machine = np.exp(generator.normal(0, 0.2, 24))  # what a round suffers its turns share
    reference = machine * np.exp(generator.normal(0, 0.01, 24))
    candidate = machine * np.exp(generator.normal(0.05, 0.01, 24))
    candidate[7] *= 10
    [ratio] = log_ratios(in_rounds(reference), in_rounds(candidate))["log_ratio"]
    assert abs(ratio - 0.05) < 0.01
    assert np.log(candidate.sum() / reference.sum()) > 0.3


def test_processes_without_turns_or_with_unlike_ones_are_compared_by_their_middles() -> None:
    none = np.empty(0)
    sides = [in_rounds(np.full(4, seconds)).assign(steps_seconds_of_rounds=[none]) for seconds in (1.0, 2.0)]
    assert np.isclose(log_ratios(*sides)["log_ratio"][0], np.log(2))
    unlike = log_ratios(in_rounds(np.full(4, 1.0)), in_rounds(np.full(5, 3.0)))
    assert np.isclose(unlike["log_ratio"][0], np.log(3))


def test_a_factor_scales_rounds_as_it_scales_the_time() -> None:
    times = scaled(in_rounds(np.array([1.0, 3.0])), "seconds", pd.Series([2.0]))
    assert list(times["seconds_of_rounds"][0]) == [2.0, 6.0]
    assert times["seconds"][0] == 8.0


def test_the_location_is_the_mean_where_nothing_is_far_off_and_hardly_moved_where_something_is() -> None:
    values = np.random.default_rng(5).normal(3, 1, 1000)
    assert abs(location(values) - values.mean()) < 0.03
    assert abs(location(np.r_[values, np.full(50, 1e9)]) - 3) < 0.15
    assert location(np.array([2.0, 2.0, 2.0, 9.0])) == 2.0


def test_replicates_are_one_sample_of_their_block() -> None:
    logs = np.array([[0.0, 0.2], [1.0, 1.4]])
    times = processes(logs).assign(series="guided", x=4.0, file=["a", "b", "c", "d"])
    joined = join_replicates(times)
    assert list(joined["block"]) == [0, 1]
    assert np.allclose(np.log(joined["steps_seconds"]), [0.1, 1.2])
    single = times.drop_duplicates("block")
    assert join_replicates(single) is single


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


def test_what_a_start_draws_and_what_a_round_does_are_told_apart() -> None:
    generator = np.random.default_rng(5)
    sides: list[list[pd.DataFrame]] = [[], []]
    for block, start in enumerate(generator.normal(0, 0.1, 48)):
        sides[0].append(in_rounds(np.ones(24), block))
        sides[1].append(in_rounds(np.exp(0.05 + start + generator.normal(0, 0.02, 24)), block))
    found = judge_pairs(log_ratios(*map(pd.concat, sides)))
    assert 0.07 < found.start < 0.13
    assert 0.015 < found.round < 0.025
    steady = judge_pairs(log_ratios(*(pd.concat(one) for one in (sides[0], _unlike(generator)))))
    assert steady.start < 0.01, "rounds explain all of it"


def _unlike(generator: np.random.Generator) -> list[pd.DataFrame]:
    return [in_rounds(np.exp(generator.normal(0, 0.02, 24)), block) for block in range(48)]


def test_the_ratio_of_all_time_counts_rare_slow_rounds_in_full() -> None:
    steady = pd.concat([in_rounds(np.ones(24), block) for block in range(6)])
    lumps = pd.concat([in_rounds(np.append(np.ones(23), 13.0), block) for block in range(6)])
    found = judge_pairs(log_ratios(steady, lumps))
    assert np.isclose(found.ratio, 1)
    assert np.isclose(found.totals, 1.5)
