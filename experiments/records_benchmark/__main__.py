"""Make folders of records, read them as the verbs do, and print a table: `make bench-records`."""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from experiments.records_benchmark.made_up import fill, made_up_study
from experiments.results.index import FOLDER
from experiments.run.study import Study
from support.command_line import Parser, exit_code_of
from support.home import ROOT

SIZES = ((2_160, 28_000), (20_000, 28_000), (100_000, 5_000))
"""Records, and the bytes of each."""


def main() -> int:
    """Returns the exit code."""
    parser = Parser(prog="experiments.records_benchmark", description=__doc__)
    told = "divide the numbers of records by this"
    parser.add_argument("--less", type=int, default=1, metavar="N", help=told)
    options = parser.parse_args()
    return exit_code_of(lambda: _run(options.less))


def _run(less: int) -> int:
    head = ["records", "bytes each", "`status`, nothing kept", "memory", "`status`, kept", "a task's start"]
    print(_line([*head, "report's reading", "memory"]))
    print(_line(["---"] * 8))
    for records, size in SIZES:
        with tempfile.TemporaryDirectory(prefix="carom-records-") as folder:
            print(_line(_measured(Path(folder), records // less, size)), flush=True)
    return 0


def _measured(folder: Path, records: int, size: int) -> list[str]:
    study = made_up_study(folder)
    fill(study, records, size)
    time.sleep(3)  # until no file is so new that its time could stay the same if it changed
    results = str(study.store.root)
    words = ["-m", "experiments", "status", "--questions", str(folder / "questions"), "--results", results]
    shutil.rmtree(study.store.root / FOLDER, ignore_errors=True)
    first, memory = _timed(words)
    kept, _ = _timed(words)
    reads = "import sys, pathlib; from analysis.records.reading import load; load(pathlib.Path(sys.argv[1]))"
    report, of_report = _timed(["-c", reads, results])
    start = _start_of_a_task(study)
    told = [f"{first:.1f} s", _megabytes(memory), f"{kept:.1f} s", f"{start:.2f} s", f"{report:.1f} s"]
    return [f"{records:,}", f"{size:,}", *told, _megabytes(of_report)]


def _start_of_a_task(study: Study) -> float:
    """What it takes to find what is to be measured of a block."""
    [experiment] = study.experiments
    began = time.perf_counter()
    study.store.find_block(experiment, 0)
    return time.perf_counter() - began


def _timed(words: Sequence[str]) -> tuple[float, float]:
    """Seconds of a Python process, and the bytes that it took at most."""
    began = time.perf_counter()
    child = subprocess.Popen([sys.executable, *words], cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise RuntimeError(f"{words}: exit code {child.returncode}")
    return time.perf_counter() - began, 1024.0 * usage.ru_maxrss


def _megabytes(amount: float) -> str:
    return f"{amount / 1e6:.0f} MB"


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    sys.exit(main())
