import tracemalloc

import numpy as np
import pandas as pd
import pytest

from analysis.statistics.bootstrap import _replicates, summarise
from analysis.tests.synthetic_noise import Noise, of_processes, samples_table, times_table


def summary_of(table: pd.DataFrame) -> pd.Series:
    return summarise(table, ["series"]).iloc[0]


def test_repetitions_of_one_process_do_not_count_as_processes() -> None:
    noise = Noise(process=0.05, repetition=0.001, burst_rate=0, drift=0)
    narrow = Noise(process=0.001, repetition=0.05, burst_rate=0, drift=0)
    clustered, spread = (summary_of(times_table({"a": 1.0}, 6, 50, one, seed=2)) for one in (noise, narrow))
    assert clustered["high"] - clustered["low"] > 2 * (spread["high"] - spread["low"])


def test_sessions_that_differ_widen_the_interval() -> None:
    table = samples_table({"a": 1.0}, 8, 3, Noise(burst_rate=0, drift=0), seed=3)
    paces = np.where(table["block"] >= 4, 1.3, 1.0)
    slower = of_processes(table.assign(steps_seconds=table["steps_seconds"] * paces))
    later = slower["block"] >= 4
    one = summary_of(slower)
    two = summary_of(slower.assign(session=np.where(later, "second", "first")))
    assert two["high"] - two["low"] >= one["high"] - one["low"]
    assert two["low"] < 1.05
    assert two["high"] > 1.25


@pytest.mark.parametrize("processes", [4, 7, 10])
def test_the_interval_covers_the_median_at_about_its_rate(processes: int) -> None:
    noise = Noise(process=0.02, repetition=0.005, burst_rate=0, drift=0)
    tables = [times_table({"a": 1.0}, processes, 2, noise, seed) for seed in range(150)]
    covered = sum(row["low"] <= 1.0 <= row["high"] for row in map(summary_of, tables))
    assert covered >= 0.93 * 150


@pytest.mark.parametrize("count", [1, 2, 3, 6, 7])
def test_repetitions_are_drawn_with_replacement(count: int) -> None:
    values = np.cumsum(np.arange(1.0, count + 1))
    generator = np.random.default_rng(1)
    drawn = np.median(generator.choice(values, (100_000, count)), axis=1)
    found = _replicates(np.tile(values, (1, 1, 1)))
    for value in np.unique(drawn):
        assert np.mean(found <= value) == pytest.approx(np.mean(drawn <= value), abs=0.05), value
    assert set(found) <= {(one + other) / 2 for one in values for other in values}


def test_very_many_repetitions_cost_no_more_memory_than_few() -> None:
    rows = 301 * 240
    table = pd.DataFrame(
        {"series": "a", "file": np.arange(rows) // 301, "session": np.arange(rows) // 3010}
    ).assign(steps_seconds=np.random.default_rng(2).uniform(1, 2, rows))
    tracemalloc.start()
    row = summary_of(of_processes(table))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert (row["sessions"], row["processes"], row["samples"]) == (24, 240, rows)
    assert most < 200e6, "2000 replicates of all repetitions would be 1.2 GB"
