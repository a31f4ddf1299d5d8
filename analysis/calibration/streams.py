"""The file that `experiments calibrate` leaves: streams of rounds, and where they were measured."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analysis.support.values import Floats
from support.errors import InputError

FILE = "calibration.json"
SCHEMA_VERSION = 1


@dataclass(frozen=True)
class Stream:
    """Blocks of rounds in which all contenders took turns, in the order of time.

    `seconds` has an axis of blocks, one of the rounds of a block, and one of contenders; contender k does
    `more[k]` more work than the first, as a part of it. `wall_seconds` are those of all of it.
    """

    kind: str
    condition: str
    more: tuple[float, ...]
    seconds: Floats
    wall_seconds: float

    @property
    def blocks(self) -> int:
        """How many there are."""
        return len(self.seconds)

    def log_ratios(self, reference: int, candidate: int) -> Floats:
        """The value of each block: the median over its rounds of ln(candidate / reference)."""
        logs = np.log(self.seconds)
        return np.median(logs[:, :, candidate] - logs[:, :, reference], axis=1)

    def seconds_of_block(self, reference: int, candidate: int) -> float:
        """What a block of these two alone takes: their part of the time, timed or not."""
        timed = self.seconds.sum(axis=(0, 1))
        share = (timed[reference] + timed[candidate]) / timed.sum()
        return float(self.wall_seconds * share / self.blocks)


def load(folder: Path) -> tuple[list[Stream], str]:
    """Return a folder's streams, and a line that says where, when and of what they are. Raises InputError
    where there is no file that `make calibrate` has written.
    """
    path = folder / FILE
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{path}: is not there, expected what `make calibrate` measures") from None
    except (OSError, ValueError) as error:
        told = f"{path}: cannot be read: {error}, expected what `make calibrate` measures"
        raise InputError(told) from None
    try:
        if content["schema_version"] != SCHEMA_VERSION:
            raise ValueError(f"schema_version {content['schema_version']}, expected {SCHEMA_VERSION}")
        return [_stream(one) for one in content["streams"]], _origin(content)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        told = f"{type(error).__name__}: {error}"
        raise InputError(f"{path}: found {told}, expected streams as `make calibrate` writes them") from None


def _stream(one: dict[str, Any]) -> Stream:
    more = tuple(float(percent) / 100 for percent in one["percent_more"])
    seconds = np.asarray(one["blocks"], dtype=float)
    if seconds.ndim != 3 or seconds.shape[2] != len(more):
        raise ValueError(f"blocks of the shape {seconds.shape} for {len(more)} contenders")
    if not (seconds > 0).all() or not np.isfinite(seconds).all():
        raise ValueError(f"a time that is not above 0 in {one['kind']}, {one['condition']}")
    return Stream(one["kind"], one["condition"], more, seconds, float(one["wall_seconds"]))


def _origin(content: dict[str, Any]) -> str:
    first = content["streams"][0]
    where = first.get("provenance") or {}
    machine = f"{where.get('cpu_model', 'a machine')}, {where.get('hardware_threads', '?')} hardware threads"
    commit = str(where.get("commit") or "unknown")[:7] + (", changed" if where.get("dirty") else "")
    return f"{machine}; commit {commit}; {first['began_at'][:10]}; {content['seconds']:g} s a stream"
