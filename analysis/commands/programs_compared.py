"""What a results folder says of the commands that `carom compare` runs."""

import math
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.derived.comparisons import differences, reference, stated
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.statistics.forecast import blocks_to_decide
from analysis.statistics.looks import ERROR, next_look

AGAIN = " again"
"""Behind the name of the reference where it was run under a second one."""


def programs_compared(results: Path) -> dict[str, Any]:
    """Return `commands`: a row of `verdicts.judge` for each command but the reference, with the number of
    blocks that are `needed` to settle it, None where that is not in sight; `control`: the same of the
    reference under its second name, standing alone, and whether it `differs` from itself; and `next`, the
    number of blocks at which to look again.
    """
    studies = split(load(results))
    times = studies[0].times if studies else pd.DataFrame()
    if times.empty:
        return {"commands": [], "control": None, "next": next_look(0)}
    against, error = reference(times), stated(times).error
    is_control = times["series"] == against + AGAIN
    rows = [_row(row) for row in differences(times[~is_control], against).to_dict("records")]
    open_ones = max(1, sum(row["verdict"] == "inconclusive" for row in rows))
    for row in rows:
        if row["verdict"] == "inconclusive":
            needed = blocks_to_decide(row["alone"], row["blocks"], max(1, round(open_ones * ERROR / error)))
            row["needed"] = int(needed) if math.isfinite(needed) else None
    control = differences(times[is_control | (times["series"] == against)], against)
    found = next((_row(row) for row in control.to_dict("records")), None)
    blocks = max((row["blocks"] for row in rows), default=0)
    return {"commands": rows, "control": found, "next": next_look(blocks)}


def _row(row: dict[Any, Any]) -> dict[str, Any]:
    """Return the row as JSON has it; what reaches without end is None."""
    ends = {key: float(row[key]) if math.isfinite(row[key]) else None for key in ("low", "high")}
    told = {key: row[key] for key in ("series", "verdict")}
    numbers = {key: float(row[key]) for key in ("ratio", "alone", "p")}
    differs = ends["low"] is not None and ends["high"] is not None and not ends["low"] <= 1 <= ends["high"]
    return {**told, **numbers, **ends, "blocks": int(row["blocks"]), "differs": differs}
