"""Measure them all: `python -m experiments.usual_ways --rounds 10 --output FILE`, quiet and beside a load."""

import argparse
import csv
import itertools
import os
import random
import shutil
import subprocess
import sys
import tempfile
from datetime import UTC, datetime
from pathlib import Path

from experiments.plan.site import this_machine
from experiments.support.busy import busy
from experiments.support.places import BUILDS
from experiments.usual_ways.programs import build_loop, pair
from experiments.usual_ways.tables import COLUMNS, read, table
from experiments.usual_ways.ways import WAYS
from support.command_line import Parser, exit_code_of
from support.errors import InputError

MORE = (0.0, 0.01, 0.02, 0.05)
"""Fractions of work that the second program has more."""


def main() -> int:
    """Append rows to the file and print the table of all that it holds; returns the exit code."""
    parser = Parser(prog="experiments.usual_ways", description=__doc__)
    parser.add_argument("--rounds", type=int, default=10, help="of all pairs and ways, 0 for the table alone")
    parser.add_argument("--busy", type=int, default=0, help="loops that run beside them meanwhile")
    parser.add_argument("--output", type=Path, required=True, help="the file of the raw data, gone on with")
    options = parser.parse_args()
    return exit_code_of(lambda: _run(options))


def _run(options: argparse.Namespace) -> int:
    missing = [tool for tool in ("c++", "hyperfine", "perf") if shutil.which(tool) is None]
    if options.rounds and missing:
        raise InputError(
            f"found no {', '.join(missing)}, expected them: apt-get install hyperfine linux-perf"
        )
    with tempfile.TemporaryDirectory() as folder, busy(options.busy):
        program = build_loop(Path(folder)) if options.rounds else Path()
        for _ in range(options.rounds):
            _round(program, f"beside {options.busy} loops" if options.busy else "quiet", options.output)
    print(table(read(options.output)))
    return 0


def _round(program: Path, load: str, output: Path) -> None:
    carom = str(BUILDS / "gcc" / "carom")
    # In an order of its own each time: what drifts favours none.
    asked = list(itertools.product(MORE, WAYS.items()))
    for more, (way, ask) in random.sample(asked, len(asked)):
        answer = ask(carom, *pair(program, more))
        told = (this_machine().name, _commit(), f"{datetime.now(UTC):%Y-%m-%d}", load, str(more), way)
        _append(output, [*told, answer.said, f"{answer.ratio:.5f}", f"{answer.seconds:.2f}"])


def _append(output: Path, row: list[str]) -> None:
    """A row is kept as soon as it is there: whoever stops this loses at most the one it is at."""
    is_new = not output.exists()
    output.parent.mkdir(parents=True, exist_ok=True)
    with output.open("a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if is_new:
            writer.writerow(COLUMNS)
        writer.writerow(row)


def _commit() -> str:
    done = subprocess.run(
        ["git", "describe", "--always", "--dirty"], capture_output=True, text=True, check=False
    )
    return done.stdout.strip()


if __name__ == "__main__":
    os.chdir(Path(__file__).parents[2])
    sys.exit(main())
