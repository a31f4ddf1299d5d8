"""The verb `calibrate`: six streams, three kinds of contenders quiet and beside busy loops, into one file."""

import argparse
from functools import partial
from pathlib import Path
from typing import Any

from experiments.calibration.kinds import KINDS
from experiments.calibration.stream import measure
from experiments.plan.program import GENERATOR, Program, find_programs
from experiments.plan.site import load_site, this_machine
from experiments.run.progress import ProgressDisplay
from experiments.support.busy import busy
from experiments.support.vanishing import vanishing_folder
from support.command_line import number_above_zero
from support.errors import InputError
from support.files import locked, read_json, require_room_for_folder, write_json
from support.home import BUILDS

FILE = "calibration.json"
UNFINISHED = "unfinished.json"
SCHEMA_VERSION = 1

CONDITIONS = {"quiet": 0, "beside two busy loops": 2}
"""With so many loops beside."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """What the verb may be given."""
    parser.add_argument(
        "--results", type=Path, default=Path("results/calibration"), help="folder (default: %(default)s)"
    )
    told = "how long each of the six streams is measured (default: %(default)g)"
    parser.add_argument("--seconds", type=partial(number_above_zero, unit="seconds"), default=60.0, help=told)
    told = "folder of the programs (default: %(default)s)"
    parser.add_argument("--build", type=Path, default=BUILDS, help=told)


def calibrate(options: argparse.Namespace) -> int:
    """Measure the streams that are missing; returns the exit code 0.

    What an earlier call with the same program and time left unfinished is gone on with; what one finished is
    replaced, as a whole.
    """
    results: Path = options.results
    require_room_for_folder("results", results)
    where = load_site("local")
    program = find_programs(where, options.build)[GENERATOR]
    if program.sha256 is None:
        raise InputError(program.remedy)
    openmp = where.binding.environment(1, this_machine())
    with locked(results), ProgressDisplay() as display, vanishing_folder("carom-calibrate-") as folder:
        content = _begun(results / UNFINISHED, program, options.seconds)
        known = {(one["kind"], one["condition"]) for one in content["streams"]}
        for make in KINDS:
            display.now(f"{make.__name__}: making ready")
            kind = make(program, openmp, folder)
            for condition, loops in CONDITIONS.items():
                if (kind.name, condition) in known:
                    continue
                display.now(f"{kind.name}, {condition}: {options.seconds:g} s")
                with busy(loops):
                    stream = measure(kind, condition, options.seconds)
                content["streams"].append(stream)
                write_json(results / UNFINISHED, content, results)
                display.line(f"{kind.name}, {condition}: {len(stream['blocks'])} blocks")
        write_json(results / FILE, content, results)
        (results / UNFINISHED).unlink()
    return 0


def _begun(path: Path, program: Program, seconds: float) -> dict[str, Any]:
    """What an earlier call left unfinished, if this one would have measured the same; else nothing yet."""
    asked = {"schema_version": SCHEMA_VERSION, "program_sha256": program.sha256, "seconds": seconds}
    found = read_json(path)
    if isinstance(found, dict) and all(found.get(key) == value for key, value in asked.items()):
        return found
    return {**asked, "streams": []}
