"""Reads a results folder: every record validated, unreadable ones named and left out, the rest as tables."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from analysis.records import known
from support.errors import InputError

MEASURED = ["runs", "times", "trajectory", "phases", "threads", "counters"]
"""The tables of what was measured of a variant or a program."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Tables:
    """Records as tables, each with the columns that the function of its name tells.

    `runs` has a row per contender of a record, `times` per contender that was timed, `trajectory` per
    comparison with the reference, `phases` per phase and `threads` per phase and thread of a profiled run,
    `counters` per counter and thread, `limits` per rate that a machine reached at most, `failures` per
    failed point.
    """

    runs: pd.DataFrame
    times: pd.DataFrame
    trajectory: pd.DataFrame
    phases: pd.DataFrame
    threads: pd.DataFrame
    counters: pd.DataFrame
    limits: pd.DataFrame
    failures: pd.DataFrame


@dataclass(frozen=True, eq=False)
class Records(Tables):
    """One results folder as tables; `skipped` holds one line for every file that could not be counted."""

    skipped: list[str]


_KNOWN: dict[Path, dict[str, known.File]] = {}
"""By folder, as long as this process lives: whoever loads a growing folder again and again pays for what is
new.
"""


def load(results: Path, warn: Callable[[str], None] | None = None) -> Records:
    """Read `results/records/**.json`.

    A file that is torn, foreign or of another schema version is passed to `warn` (default: standard error)
    as one line, with all others of the same reason, and is not counted. Raises InputError if `results` is not
    a folder.
    """
    if not results.is_dir():
        raise InputError(f"{results}: no such folder (records are made by `make experiments`)")
    place = results.resolve()
    files = _KNOWN[place] = known.read(place, _KNOWN.get(place, {}))
    alike: dict[str, list[str]] = {}
    for name, why in known.told(files):
        if why is not None:
            alike.setdefault(why, []).append(name)
    skipped = [
        f"{results / first}: skipped: {why}" + (f" (and {len(others)} more alike)" if others else "")
        for why, (first, *others) in alike.items()
    ]
    for line in skipped:
        warn(line) if warn else print(line, file=sys.stderr)
    return Records(**known.frames(files), skipped=skipped)
