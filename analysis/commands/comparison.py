"""Two results folders against each other: two commits, two compilers, two machines."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.records.reading import load
from analysis.records.studies import split
from analysis.statistics.unpaired import judge_unpaired
from analysis.statistics.verdicts import COLUMNS, corrected
from support.errors import InputError

POINT = [
    "scale", "experiment", "series", "x", "label", "replicate", "scene_name", "scene_sha256", "threads",
    "find_chunk", "resolve_chunk", "substeps", "tolerance",
]  # fmt: skip
SHOWN = ["experiment", "series", "x", "label", "replicate", "scene_name"]
SLOWER, UNDECIDED = 3, 4

Point = tuple[Any, ...]
"""The values of the columns `POINT`."""


def compare(first: Path, second: Path, experiment: str | None = None) -> pd.DataFrame:
    """Return a row a point: its columns `POINT`, and `second` / `first` as `verdicts.judge`.

    Points match by figure, scene, threads and tunings. The folders were not interleaved, so processes are
    compared unpaired; the p-values are Holm-corrected within each experiment. A point that only one of the
    folders measured, as where it fails in the other, is inconclusive; of an experiment that only one of them
    has, nothing is said. Raises InputError if a folder mixes several machines, revisions or scales, or if
    nothing matches.
    """
    sides = [_processes(folder, experiment) for folder in (first, second)]
    groups = [dict(list(side.groupby(POINT)["steps_seconds"])) for side in sides]
    shared = [point for point in groups[0] if point in groups[1]]
    if not shared:
        raise InputError(f"{first} and {second}: no point in common to compare")
    names = set(sides[0]["experiment"]) & set(sides[1]["experiment"])
    column = POINT.index("experiment")
    lone = [point for point in groups[0].keys() ^ groups[1].keys() if point[column] in names]
    table = _judged(groups, shared)
    parts = [corrected(part) for _, part in table.groupby("experiment")]
    return pd.concat([*parts, *([_judged(groups, sorted(lone))] if lone else [])])[[*SHOWN, *COLUMNS]]


def _judged(groups: Sequence[Mapping[Point, pd.Series]], points: Sequence[Point]) -> pd.DataFrame:
    rows = [judge_unpaired(*(group.get(point, ()) for group in groups)) for point in points]
    return pd.concat([pd.DataFrame(points, columns=POINT), pd.DataFrame(rows)], axis=1)


def _processes(folder: Path, experiment: str | None) -> pd.DataFrame:
    studies = split(load(folder))
    if not studies:
        raise InputError(f"{folder}: no records to compare")
    if len(studies) > 1:
        names = "; ".join(study.name for study in studies)
        raise InputError(f"{folder}: found {len(studies)} studies, expected one to compare ({names})")
    study = studies[0]
    times = study.times if experiment is None else study.times_of(experiment)
    unsaid = dict.fromkeys(("label", "scene_name", "tolerance"), "")
    numbers = {"find_chunk": 0, "resolve_chunk": 0, "substeps": 1}
    return times.fillna({**unsaid, **numbers}).astype({"label": str})


def exit_code(table: pd.DataFrame) -> int:
    """Return 3 if anything is slower, 4 if anything is undecided, else 0."""
    if (table["verdict"] == "slower").any():
        return SLOWER
    return UNDECIDED if (table["verdict"] == "inconclusive").any() else 0
