"""Make folders of records, read them as the verbs do, and print a table: `make bench-records`."""

import csv
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from experiments.records_benchmark.figure import draw
from experiments.records_benchmark.made_up import fill, made_up_study
from experiments.run.study import Study
from support.command_line import Parser, exit_code_of
from support.home import ROOT
from support.known_files import FOLDER

SIZES = (
    (2_160, 28_000),
    (7_000, 28_000),
    (20_000, 28_000),
    (10_000, 5_000),
    (30_000, 5_000),
    (100_000, 5_000),
)
"""Records, and the bytes of each."""

_READS = "import sys, pathlib; from analysis.records.reading import load; load(pathlib.Path(sys.argv[1]))"


@dataclass(frozen=True)
class Measured:
    """What one folder cost, in seconds and megabytes: first, with nothing kept yet, and again."""

    records: int
    bytes_each: int
    status_first: float
    status_first_memory: float
    status_again: float
    report_first: float
    report_first_memory: float
    report_again: float
    report_again_memory: float
    task_start: float


def main() -> int:
    """Returns the exit code."""
    parser = Parser(prog="experiments.records_benchmark", description=__doc__)
    told = "divide the numbers of records by this"
    parser.add_argument("--less", type=int, default=1, metavar="N", help=told)
    told = "write the rows as FILE.csv and draw them as FILE.svg, too"
    parser.add_argument("--output", type=Path, metavar="FILE", help=told)
    options = parser.parse_args()
    return exit_code_of(lambda: _run(options.less, options.output))


def _run(less: int, output: Path | None) -> int:
    rows = []
    for records, size in SIZES:
        with tempfile.TemporaryDirectory(prefix="carom-records-") as folder:
            rows.append(_measured(Path(folder), records // less, size))
        print(rows[-1], file=sys.stderr, flush=True)
    print(table(rows))
    if output is not None:
        output.parent.mkdir(parents=True, exist_ok=True)
        with output.with_suffix(".csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, [one.name for one in fields(Measured)], lineterminator="\n")
            writer.writeheader()
            writer.writerows(map(asdict, rows))
        draw([asdict(row) for row in rows], output.with_suffix(".svg"))
    return 0


def table(rows: Sequence[Measured]) -> str:
    """Return it as Markdown."""
    head = [
        "records",
        "KB each",
        "`status`, first / again",
        "memory",
        "report's reading, first / again",
        "memory",
    ]
    told = [
        [
            f"{row.records:,}",
            f"{row.bytes_each / 1000:.0f}",
            f"{row.status_first:.1f} / {row.status_again:.1f} s",
            f"{row.status_first_memory:.0f} MB",
            f"{row.report_first:.1f} / {row.report_again:.1f} s",
            f"{row.report_first_memory:.0f} / {row.report_again_memory:.0f} MB",
            f"{row.task_start:.2f} s",
        ]
        for row in rows
    ]
    lines = [[*head, "a task's start"], ["---:"] * 7, *told]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _measured(folder: Path, records: int, size: int) -> Measured:
    study = made_up_study(folder)
    fill(study, records, size)
    time.sleep(3)  # until no file is so new that its time could stay the same if it changed
    results = str(study.store.root)
    words = ["-m", "experiments", "status", "--questions", str(folder / "questions"), "--results", results]
    shutil.rmtree(study.store.root / FOLDER, ignore_errors=True)
    status = [_timed(words) for _ in range(2)]
    report = [_timed(["-c", _READS, results]) for _ in range(2)]
    costs = (*status[0], status[1][0], *report[0], *report[1])
    return Measured(records, size, *costs, _start_of_a_task(study))


def _start_of_a_task(study: Study) -> float:
    """What it takes to find what is to be measured of a block."""
    [experiment] = study.experiments
    began = time.perf_counter()
    study.store.find_block(experiment, 0)
    return time.perf_counter() - began


def _timed(words: Sequence[str]) -> tuple[float, float]:
    """Seconds of a Python process, and the megabytes that it took at most."""
    began = time.perf_counter()
    child = subprocess.Popen([sys.executable, *words], cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise RuntimeError(f"{words}: exit code {child.returncode}")
    return time.perf_counter() - began, usage.ru_maxrss / 1000


if __name__ == "__main__":
    sys.exit(main())
