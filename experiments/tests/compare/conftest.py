"""Programs to compare, in a folder of their own."""

from pathlib import Path

import pytest

from experiments.tests.compare.calls import BENCHMARK, LOOP, script


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "tmp").mkdir()
    script(tmp_path / "short", LOOP.format(times=4000))
    script(tmp_path / "long", LOOP.format(times=12000))
    return tmp_path


@pytest.fixture
def benchmarks(folder: Path) -> Path:
    script(folder / "bench_old", BENCHMARK.format(names="BM_a BM_b/8 BM_gone", time=4))
    script(folder / "bench_new", BENCHMARK.format(names="BM_new BM_b/8 BM_a", time=3))
    return folder
