"""Made-up records are as good as measured ones to whoever reads them, and as large as asked for."""

from pathlib import Path

from experiments.records_benchmark.made_up import POINTS, fill, made_up_study
from experiments.run.status import rows
from experiments.tests.compare.calls import needs_the_program

pytestmark = needs_the_program
SIZE = 9_000


def test_made_up_records_count(tmp_path: Path) -> None:
    study = made_up_study(tmp_path)
    fill(study, 2 * POINTS, SIZE)
    [row] = rows(study.store, study.experiments)
    assert (row.done, row.stale, row.alone) == (2 * POINTS, 0, 0)
    files = list((tmp_path / "results" / "records").rglob("*.json"))
    assert len(files) == 2 * POINTS
    assert all(0.5 * SIZE < file.stat().st_size < 1.1 * SIZE for file in files)
    [experiment] = study.experiments
    assert len(study.store.find_block(experiment, 1).seconds) == POINTS
