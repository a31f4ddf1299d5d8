"""What a results folder says of the commands that `carom compare` runs."""

import math
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.derived.comparisons import Stated, differences, reference, stated
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.statistics.forecast import blocks_to_decide
from analysis.statistics.looks import ERROR, next_look
from analysis.statistics.ranking import ranking
from support.vocabulary import AGAIN

LEAGUE = 3
"""So many commands are a league, in which every pair is compared."""


def programs_compared(results: Path) -> dict[str, Any]:
    """Return `commands`: a row of `verdicts.judge` for each command but the reference and each case `x`, with
    the number of blocks that are `needed` to settle it, None where that is not in sight; `controls`: the same
    of the reference under its second name, a row a case, and whether it `differs` from itself; `places`: with
    three commands or more, in the order of their times, the places and the bracket of each; and `next`, the
    number of blocks at which to look again.
    """
    studies = split(load(results))
    times = studies[0].times if studies else pd.DataFrame()
    if times.empty:
        return {"commands": [], "controls": [], "places": [], "next": next_look(0)}
    against, error = reference(times), stated(times).error
    is_control = times["series"] == against + AGAIN
    rows = [_row(row) for row in differences(times[~is_control], against).to_dict("records")]
    open_ones = max(1, sum(row["verdict"] == "inconclusive" for row in rows))
    for row in rows:
        if row["verdict"] == "inconclusive":
            needed = blocks_to_decide(row["alone"], row["blocks"], max(1, round(open_ones * ERROR / error)))
            row["needed"] = int(needed) if math.isfinite(needed) else None
    blocks = max((row["blocks"] for row in rows), default=0)
    controls = _controls(times[is_control | (times["series"] == against)], against)
    return {
        "commands": rows,
        "controls": controls,
        "places": _places(times[~is_control]),
        "next": next_look(blocks),
    }


def _controls(times: pd.DataFrame, against: str) -> list[dict[str, Any]]:
    """Return the rows of the reference against itself. It has to differ from itself in no case, so that each
    interval has its part of the error (Bonferroni).
    """
    by = stated(times)
    part = by.error / max(1, times["x"].nunique())
    return [_row(row) for row in differences(times, against, Stated(by.margin, part)).to_dict("records")]


def _places(times: pd.DataFrame) -> list[dict[str, Any]]:
    if times["series"].nunique() < LEAGUE or times["x"].nunique() > 1:
        return []
    return [
        {"series": str(row.series), "first": row.place[0], "last": row.place[1], "bracket": row.bracket}
        for row in ranking(times, stated(times).margin).itertuples()
    ]


def _row(row: dict[Any, Any]) -> dict[str, Any]:
    """Return the row as JSON has it; what reaches without end is None."""
    ends = {key: float(row[key]) if math.isfinite(row[key]) else None for key in ("low", "high")}
    told = {"series": str(row["series"]), "verdict": row["verdict"], "x": int(row["x"])}
    numbers = {key: float(row[key]) for key in ("ratio", "alone", "p")}
    differs = ends["low"] is not None and ends["high"] is not None and not ends["low"] <= 1 <= ends["high"]
    return {**told, **numbers, **ends, "blocks": int(row["blocks"]), "differs": differs}
