"""The table for other tools: a row a repetition, the columns that the page tells, bad input in one line."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.cli import main
from analysis.commands.export import COLUMNS, measurements
from analysis.records.reading import load
from analysis.records.tables import AXIS_COLUMNS
from analysis.statistics.pairs import timed_runs
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import study

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "data.md"


@pytest.fixture
def results(tmp_path: Path) -> Path:
    folder = tmp_path / "results"
    write(folder, study(["neighbourhood", "phases"], blocks=6, repetitions=3, noise=QUIET))
    return folder


def test_a_row_is_a_timed_repetition(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "--results", str(results)]) == 0
    target = results / "measurements.csv"
    assert capsys.readouterr().out == f"{target}\n"
    table = pd.read_csv(target)
    assert list(table.columns) == COLUMNS
    times = load(results).times
    assert len(table) == timed_runs(times) == 36
    assert sorted(table["repetition"].unique()) == [1, 2, 3]
    assert not table.duplicated(["file", "repetition"]).any()
    medians = table.groupby("file")["seconds"].median()
    np.testing.assert_allclose(medians[times["file"]], times["steps_seconds"], rtol=1e-12)
    assert set(table["check_verdict"]) == {"passed"}


def test_the_page_tells_each_column() -> None:
    assert (
        re.findall(r"^\| `(\w+)` \| .*? \| .+ \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE) == COLUMNS
    )


def test_every_policy_has_a_column() -> None:
    assert set(AXIS_COLUMNS) <= set(COLUMNS)


def test_the_example_of_the_page_runs(results: Path) -> None:
    assert main(["export", "--results", str(results)]) == 0
    (example,) = re.findall(
        r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    assert len([line for line in example.splitlines() if line]) <= 10
    done = subprocess.run(
        [sys.executable, "-c", example], cwd=results.parent, capture_output=True, text=True, check=True
    )
    assert re.fullmatch(
        r"four against nine: -4\.\d% of time, standard error \d\.\d%, 6 blocks\n", done.stdout
    )


def test_standard_output(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "--output", "-", "--results", str(results)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("experiment,series,")
    assert len(lines) == 1 + len(measurements(results))
    assert not (results / "measurements.csv").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--results", "empty"], "empty: no timed records yet"),
        (["--output", "file/table.csv"], "expected a writable place with room"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(
    results: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    words: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(results.parent)
    Path("empty").mkdir()
    Path("file").touch()
    assert main(["export", *words]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not list(results.parent.rglob("*.csv")) + list(results.parent.rglob("*.part*"))
