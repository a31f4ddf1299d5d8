"""What was measured as one tidy table for other tools: a row a timed repetition of a point."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from analysis.records.reading import load
from analysis.statistics.pairs import runs_of
from support.errors import InputError
from support.files import replacing

COLUMNS = [
    "experiment", "series", "label", "x_name", "x", "scene_name", "block", "session", "position",
    "replicate", "repetition", "seconds", "process_seconds", "in_turns", "scale", "particles", "side",
    "radius", "steps", "area_fraction", "variant", "neighbourhood", "order", "self_contained",
    "direction", "find_schedule", "resolve_schedule", "storage", "prefetch", "box_side",
    "overlaps_kept", "search", "worklist", "impact", "precision", "find_chunk", "resolve_chunk",
    "threads", "substeps", "tolerance", "overlaps", "pair_resolves", "pair_attempts", "sweeps",
    "energy_drift", "check_verdict", "kind", "command", "machine", "node", "cpu_model", "cores",
    "hardware_threads", "compiler", "compiler_flags", "openmp", "revision", "recorded_at", "file",
]  # fmt: skip
"""What each says stands in docs/reference/data.md. Empty where a record does not say."""


def measurements(results: Path) -> pd.DataFrame:
    """Return the table of a results folder, with the columns of `COLUMNS`, in the order of the files.

    Raises InputError for a folder that is not there or has no timed record.
    """
    records = load(results)
    if records.times.empty:
        raise InputError(f"{results}: no timed records yet (they are made by `make experiments`)")
    only_in_runs = [name for name in COLUMNS if name not in records.times]
    beside = [name for name in only_in_runs if name in records.runs]
    table = records.times.merge(records.runs[["file", *beside]], on="file", how="left", sort=False)
    runs = runs_of("steps_seconds")
    numbers = table[runs].map(lambda one: np.arange(1, len(one) + 1))
    table = table.assign(repetition=numbers, seconds=table[runs]).explode(["repetition", "seconds"])
    table = table.astype({"repetition": int, "seconds": float})
    return table[COLUMNS].reset_index(drop=True)


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
