"""The usual ways say what their users would read, and the table counts it."""

import csv
import math
import shutil
from pathlib import Path

import pytest

from experiments.tests.conftest import ROOT
from experiments.usual_ways import ways
from experiments.usual_ways.programs import TURNS, build_loop, pair
from experiments.usual_ways.tables import COLUMNS, read, table

CAROM = ROOT / "build" / "gcc" / "carom"
NEEDS = {"hyperfine": "hyperfine", "perf stat -r 10": "perf", "carom compare": str(CAROM)}


@pytest.mark.parametrize("way", ways.WAYS)
def test_three_times_as_long_is_slower_in_every_way(way: str) -> None:
    if way in NEEDS and shutil.which(NEEDS[way]) is None:
        pytest.skip(f"{NEEDS[way]} is not here")
    try:
        answer = ways.WAYS[way](str(CAROM), ["sleep", "0.02"], ["sleep", "0.06"])
    except RuntimeError as error:
        if not way.startswith("perf"):
            raise
        pytest.skip(f"{way}: {error}")  # without the right to count, say
    assert answer.said == ways.SLOWER
    assert 1.5 < answer.ratio < 4
    assert answer.seconds > 0


def test_the_loop_has_as_much_more_work_as_is_said(tmp_path: Path) -> None:
    program = build_loop(tmp_path)
    first, second = pair(program, 0.05)
    assert first == [str(program), str(TURNS)]
    assert math.isclose(int(second[1]) / int(first[1]), 1.05)


def test_the_table_counts_what_each_way_said(tmp_path: Path) -> None:
    file = tmp_path / "rows.csv"
    rows = [
        ("quiet", "0.05", "hyperfine", "slower", "1.05", "3"),
        ("quiet", "0.05", "hyperfine", "nothing", "1.26", "5"),
        ("quiet", "0.05", "carom compare", "slower", "1.05", "9"),
        ("beside 2 loops", "0.0", "hyperfine", "faster", "0.9", "4"),
    ]
    with file.open("w", encoding="utf-8", newline="") as lines:
        csv.writer(lines).writerows([COLUMNS, *(("m", "c", "d", *row) for row in rows)])
    *_, carom, hyperfine, busy = table(read(file)).splitlines()
    assert carom == "| quiet | 5 % | carom compare | 1 of 1 | 0 of 1 | 0 of 1 | 0 of 1 | 0.0 % | 9 |"
    assert hyperfine == "| quiet | 5 % | hyperfine | 1 of 2 | 0 of 2 | 0 of 2 | 1 of 2 | 20.0 % | 4 |"
    assert busy == "| beside 2 loops | 0 % | hyperfine | 0 of 1 | 1 of 1 | 0 of 1 | 0 of 1 | 10.0 % | 4 |"
