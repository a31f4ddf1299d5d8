"""What was measured as one tidy table for other tools: a row a timed repetition of a point."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from analysis.records.reading import load
from analysis.statistics.pairs import runs_of
from support.errors import InputError
from support.files import replacing


@dataclass(frozen=True)
class Column:
    """A column of the table: its name, its unit, and what it says."""

    name: str
    unit: str
    said: str


COLUMNS = [
    Column("experiment", "", "the question that was asked, by the name of its file"),
    Column("series", "", "which of the things compared: a variant, a program, a setting"),
    Column("label", "", "the label of a control, which tells two equal series apart"),
    Column("x_name", "", "what the experiment sweeps, `none` if nothing"),
    Column("x", "as `x_name`", "its value"),
    Column("scene_name", "", "which of the question's scenes, if there are several"),
    Column("block", "", "number of the block: compare only rows of one `node`, `block` and `session`"),
    Column("session", "", "which call of the runner measured it"),
    Column("position", "", "place in the order of its block, from 0"),
    Column("replicate", "", "which of several processes that a block has of one point, from 1"),
    Column("repetition", "", "number of the run within its process, from 1"),
    Column("seconds", "s", "time of the steps of this run; of a `process`, of all of it"),
    Column("process_seconds", "s", "time of the whole process, all its repetitions together"),
    Column("in_turns", "", "whether the process took turns with those that it is compared with"),
    Column("scale", "", "`paper` or `quick`: the size of the scenes"),
    Column("particles", "", "number of discs"),
    Column("side", "length", "side of the box"),
    Column("radius", "length", "radius of a disc"),
    Column("steps", "", "units of time that are simulated"),
    Column("area_fraction", "", "share of the box that the discs cover"),
    Column("variant", "", "the compiled combination of policies"),
    Column("neighbourhood", "", "policy: boxes that are searched for overlaps"),
    Column("order", "", "policy: order of the resolve"),
    Column("self_contained", "", "policy: early resolves of self-contained pairs"),
    Column("direction", "", "policy: direction of a disc's list of overlaps"),
    Column("find_schedule", "", "policy: OpenMP schedule of the search"),
    Column("resolve_schedule", "", "policy: OpenMP schedule of the resolve"),
    Column("storage", "", "policy: discs in memory by their numbers (`numbered`) or by box (`sorted`)"),
    Column("prefetch", "", "policy: whether memory is asked for ahead, `on` or `off`"),
    Column("box_side", "", "policy: side of the boxes, 4r + 1 (`wide`) or about 2r (`snug`)"),
    Column("overlaps_kept", "", "policy: a pair in two `lists` or once in `contacts`; `overlaps` in records"),
    Column("search", "", "policy: candidate by candidate (`exact`), or four at once before (`filtered`)"),
    Column("worklist", "", "policy: a sweep looks at `all`, or at what has changed (`active`)"),
    Column("impact", "", "policy: collisions at the `step_end`, `at_contact`, or `event_driven`"),
    Column("precision", "", "policy: `double` or `float`"),
    Column("find_chunk", "", "chunk of the search's schedule"),
    Column("resolve_chunk", "", "chunk of the resolve's schedule"),
    Column("threads", "", "OpenMP threads"),
    Column("substeps", "", "steps in a unit of time"),
    Column("tolerance", "", "rule by which two discs count as colliding"),
    Column("overlaps", "", "overlapping pairs, summed over the steps"),
    Column("pair_resolves", "", "resolves of pairs, summed over the steps"),
    Column("pair_attempts", "", "attempts at them, summed over the steps"),
    Column("sweeps", "", "sweeps, summed over the steps"),
    Column("energy_drift", "", "relative change of the kinetic energy"),
    Column("check_verdict", "", "`passed`, `failed` or `unchecked`: use no time of a result that failed"),
    Column("kind", "", "`bench`: a variant of Carom; `process`: a whole program"),
    Column("command", "", "the program's command line, of a `process`"),
    Column("machine", "", "what counts as one machine: host or partition, and processor"),
    Column("node", "", "the host"),
    Column("cpu_model", "", "its processor"),
    Column("cores", "", "its physical cores"),
    Column("hardware_threads", "", "its hardware threads"),
    Column("compiler", "", "compiler with version"),
    Column("compiler_flags", "", "its flags"),
    Column("openmp", "", "OpenMP runtime with version"),
    Column("revision", "", "commit of the source, and a hash of what was changed on top of it"),
    Column("recorded_at", "UTC", "when the record was written, in ISO 8601"),
    Column("file", "", "the record, below the results folder"),
]  # fmt: skip
"""Empty where a record does not say. A length is that of the scene file, which has no unit."""


def measurements(results: Path) -> pd.DataFrame:
    """Return the table of a results folder, with the columns of `COLUMNS`, in the order of the files.

    Raises InputError for a folder that is not there or has no timed record.
    """
    records = load(results)
    if records.times.empty:
        raise InputError(f"{results}: no timed records yet (they are made by `make experiments`)")
    only_in_runs = [column.name for column in COLUMNS if column.name not in records.times]
    beside = [name for name in only_in_runs if name in records.runs]
    table = records.times.merge(records.runs[["file", *beside]], on="file", how="left", sort=False)
    runs = runs_of("steps_seconds")
    numbers = table[runs].map(lambda one: np.arange(1, len(one) + 1))
    table = table.assign(repetition=numbers, seconds=table[runs]).explode(["repetition", "seconds"])
    table = table.astype({"repetition": int, "seconds": float})
    return table[[column.name for column in COLUMNS]].reset_index(drop=True)


def write(results: Path, output: Path | None) -> Path | None:
    """Write the table as CSV, into `measurements.csv` of the results folder if no `output` is named; return
    the file. An output of `-` is standard output, and None is returned. Raises what `measurements` raises.
    """
    table = measurements(results)
    if output is not None and str(output) == "-":
        table.to_csv(sys.stdout, index=False, lineterminator="\n")
        return None
    target = output or results / "measurements.csv"
    with replacing(target) as part:
        table.to_csv(part, index=False, lineterminator="\n")
    return target
