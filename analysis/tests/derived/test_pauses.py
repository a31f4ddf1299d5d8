"""Programs in slices against the same ones without a pause."""

from pathlib import Path

import numpy as np
import pytest

from analysis.cli import main
from analysis.derived.pauses import IN_SLICES, WITHOUT, ratios
from analysis.records.reading import load
from analysis.tests.synthetic import process, write
from support.vocabulary import PAUSES

BLOCKS = 6
SECONDS = {
    "spinning": {IN_SLICES: 1.04, WITHOUT: 1.0},
    "sleeping": {IN_SLICES: 2.0, WITHOUT: 2.0},
}


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Each program in each way, the sleeping one never stopped; each block slower by a factor."""
    noise = np.random.default_rng(5)
    for block in range(BLOCKS):
        of_block = float(noise.uniform(0.8, 1.2))
        for number, (series, ways) in enumerate(SECONDS.items()):
            for label, seconds in ways.items():
                made = process("pauses", series, block, seconds * of_block * float(noise.normal(1, 0.001)))
                made["tags"] |= {"figure": PAUSES, "label": label, "point": f"{series}-{label}"}
                made["tags"]["series_number"] = number + 1
                if series == "spinning" and label != WITHOUT:
                    made["slices"] = {"seconds": [seconds], "seconds_alone": 0.0}
                write(tmp_path, [made])
    return tmp_path


def test_ratios_are_those_of_the_programs_whatever_the_blocks_suffer(results: Path) -> None:
    found = ratios(load(results).times).set_index("series")
    assert list(found.index) == list(SECONDS)
    for series, row in found.iterrows():
        truth = np.log(SECONDS[str(series)][IN_SLICES] / SECONDS[str(series)][WITHOUT])
        assert row["ratio"].low < truth < row["ratio"].high
        assert row["ratio"].high - row["ratio"].low < 0.02
        assert row["blocks"] == BLOCKS
        assert row["sliced"] == (series == "spinning")


def test_the_figure_is_drawn_and_says_who_was_not_stopped(
    results: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["report", "--results", str(results)]) == 0
    page = (results / "report.html").read_text(encoding="utf-8")
    assert "(not stopped)" in page
    assert "skipped" not in capsys.readouterr().err
