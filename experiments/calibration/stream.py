"""One stream: rounds of all contenders of a kind, one call after the other until the time is over."""

import time
from datetime import UTC, datetime
from typing import Any

from experiments.calibration.kinds import PERCENT_MORE, Kind
from experiments.run.host_lock import host_lock
from support.errors import InputError

_TRIES = 3
"""Calls in a row that may fail, as one does that was suspended."""

_DIGITS = 9
"""Of seconds: no clock here tells less than a nanosecond."""


def measure(kind: Kind, condition: str, seconds: float) -> dict[str, Any]:
    """The stream as the file of results holds it: at least one call, then as many as begin within `seconds`.

    `blocks` has for each block its rounds, and for each round the seconds of every contender, in the order of
    `percent_more`. Raises InputError where calls fail again and again.
    """
    blocks: list[list[list[float]]] = []
    provenance: Any = None
    seed = failed = 0
    with host_lock():
        began_at, began = datetime.now(UTC), time.monotonic()
        while not blocks or time.monotonic() - began < seconds:
            seed += 1
            try:
                rounds, told = kind.call(seed)
            except InputError as error:
                failed += 1
                if failed == _TRIES:
                    raise InputError(f"calibrate: {kind.name}, {condition}: {error}") from error
                continue
            failed = 0
            provenance = provenance or told
            blocks += _blocks(rounds, kind.rounds_of_block)
    return {
        "kind": kind.name,
        "condition": condition,
        "percent_more": list(PERCENT_MORE),
        "began_at": began_at.isoformat(timespec="seconds"),
        "wall_seconds": round(time.monotonic() - began, 3),
        "provenance": provenance,
        "blocks": blocks,
    }


def _blocks(measured: list[list[float]], size: int) -> list[list[list[float]]]:
    """The rounds of a call in blocks of `size`; those that are left over are no block, unless all are."""
    shown = [[round(one, _DIGITS) for one in each] for each in measured]
    size = min(size, len(shown))
    return [shown[at : at + size] for at in range(0, len(shown) - size + 1, size)]
