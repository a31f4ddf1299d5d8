"""Nodes of one partition that differ: two machines, and no ratio from one to the other."""

from pathlib import Path

import pandas as pd

from analysis.derived.comparisons import differences
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.statistics.pairs import ratios_of
from analysis.tests.synthetic import Machine, write
from analysis.tests.synthetic_study import study

BLOCKS = 8
OLD = Machine(host="n1", cpu_model="Old CPU", partition="xs")
NEW = Machine(host="n2", cpu_model="New CPU", partition="xs")


def split_over_models(folder: Path) -> None:
    """Every other block of a study on a node of another model, twice as fast."""
    for machine, speed, side in ((OLD, 1.0, 0), (NEW, 2.0, 1)):
        records = study(["row"], blocks=BLOCKS, machine=machine, speed=speed)
        write(folder, [record for record in records if record["tags"]["block"] % 2 == side])


def test_a_partition_of_two_models_is_two_machines(tmp_path: Path) -> None:
    split_over_models(tmp_path)
    studies = {one.machine: one for one in split(load(tmp_path))}
    assert studies.keys() == {"xs: Old CPU", "xs: New CPU"}
    for one in studies.values():
        times = one.times_of("row")
        verdicts = differences(times, str(times["series"].iloc[0]))
        assert set(verdicts["blocks"]) == {BLOCKS // 2}, "each machine is judged by its own blocks"


def test_a_block_that_two_nodes_measured_gives_no_ratio(tmp_path: Path) -> None:
    split_over_models(tmp_path)
    times = pd.concat([one.times_of("row") for one in split(load(tmp_path))])
    first, second = times["series"].unique()[:2]
    whole = ratios_of(times, "series", first, second)
    on_one = times[(times["series"] == first) == (times["node"] == "n1")]
    crossed = ratios_of(on_one, "series", first, second)
    assert len(whole) == BLOCKS
    assert crossed.empty
