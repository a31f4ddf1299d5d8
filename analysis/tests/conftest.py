"""One complete synthetic study, shared by the tests that only read it."""

import fcntl
import json
import os
from pathlib import Path

import pytest

from analysis.claims import evidence_of
from analysis.claims.entry import Evidence
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import Noise
from analysis.tests.synthetic_study import failures, page_of, study, trace


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    write(folder, study(blocks=9, noise=Noise(process=0.003, repetition=0.002, burst_rate=0)))
    write(folder, failures())
    (folder / "timelines").mkdir()
    for schedule, chunks in (("guided", 12), ("static", 1)):
        text = json.dumps(trace(f"find_{schedule}, scene.in, 2 threads", chunks))
        (folder / "timelines" / f"{schedule}.json").write_text(text)
    return folder


@pytest.fixture(scope="session")
def page(results: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The report of it, which takes longer than any test: of the processes of pytest-xdist, which share the
    folder above, one makes it.
    """
    alone = "PYTEST_XDIST_WORKER" not in os.environ
    base = tmp_path_factory.getbasetemp()
    kept = (base if alone else base.parent) / "report-of-the-study.html"
    with kept.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not kept.exists():
            kept.write_text(page_of(results), encoding="utf-8")
    return kept.read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def data(results: Path) -> Evidence:
    return evidence_of(results)[0]
