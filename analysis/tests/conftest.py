"""One complete synthetic study, shared by the tests that only read it."""

import json
from pathlib import Path

import pytest

from analysis import report
from analysis.figures.style import Data
from analysis.records import published
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import Noise
from analysis.tests.synthetic_study import failures, study, trace


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    write(folder, study(blocks=8, noise=Noise(process=0.003, repetition=0.002, burst_rate=0)))
    write(folder, failures())
    (folder / "timelines").mkdir()
    for schedule, chunks in (("guided", 12), ("static", 1)):
        text = json.dumps(trace(f"find_{schedule}, scene.in, 2 threads", chunks))
        (folder / "timelines" / f"{schedule}.json").write_text(text)
    return folder


@pytest.fixture(scope="session")
def page(results: Path) -> str:
    """The report of it."""
    return report.render(results)


@pytest.fixture(scope="session")
def data(results: Path) -> Data:
    studies = split(load(results))
    return Data(studies[0], studies, published.load(), results)
