"""What a results folder says of the commands that `carom compare` runs."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from analysis.derived.comparisons import Stated, differences, reference, stated
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.statistics.looks import ERROR, next_look
from analysis.statistics.noise import blocks_to_decide
from analysis.statistics.pairs import rounds_of, runs_of
from analysis.statistics.ranking import ranking
from analysis.statistics.verdicts import INCONCLUSIVE, corrected, judge_one
from support.files import read_json
from support.vocabulary import AGAIN, ASKED, OWN, WALL

LEAGUE = 3
"""So many commands are a league, in which every pair is compared."""


def programs_compared(results: Path, many: int = 1, clock: str = WALL) -> dict[str, Any]:
    """Return `commands`: a row of `verdicts.judge` for each command but the reference and each case `x`, with
    the number of blocks that are `needed` to settle it, None where that is not in sight, and `low_of_all`,
    the lower end of the interval that holds together with those of all rows, in `many` calls; `controls`: the
    same of the reference under its second name, a row a case, and whether it `differs` from itself; `places`:
    with three commands or more, in the order of their times, the places and the bracket of each; `effects`:
    rows of the sums of logarithms that `asked.json` asks for; and `next`, the number of blocks at which
    to look again. The `clock` says whether what commands waited for a processor counts.
    """
    times = times_of(results)
    if clock == OWN and not times.empty:
        parts = [rounds_of("steps_seconds"), runs_of("steps_seconds")]
        times = times.assign(steps_seconds=times["own_seconds"]).drop(columns=parts)
    if times.empty:
        nothing: dict[str, Any] = {key: [] for key in ("commands", "controls", "places", "effects")}
        return {**nothing, "next": next_look(0)}
    against, by = reference(times), stated(times)
    is_control = times["series"] == against + AGAIN
    found = differences(times[~is_control], against)
    together = Stated(by.margin, by.error / (max(1, len(found)) * many))
    of_all = differences(times[~is_control], against, together).set_index(["series", "x"])["low"]
    rows = [{**_row(row), "low_of_all": _end(of_all[row.series, row.x])} for row in found.itertuples()]
    open_ones = max(1, sum(row["verdict"] == INCONCLUSIVE for row in rows))
    for row in rows:
        if row["verdict"] == INCONCLUSIVE:
            needed = blocks_to_decide(
                row["alone"], row["blocks"], max(1, round(open_ones * ERROR / by.error))
            )
            row["needed"] = int(needed) if math.isfinite(needed) else None
    controls = _controls(times[is_control | (times["series"] == against)], against)
    return {
        "commands": rows,
        "controls": controls,
        "places": _places(times[~is_control]),
        "effects": _effects(times, by, asked(results)["contrasts"]),
        "next": next_look(max((row["blocks"] for row in rows), default=0)),
    }


def asked(results: Path) -> dict[str, Any]:
    """Return the names of the `cases` and the `contrasts` that the caller has written down."""
    found = read_json(results / ASKED)
    return {"cases": [], "contrasts": [], **(found if isinstance(found, dict) else {})}


def times_of(results: Path) -> pd.DataFrame:
    """Return the times of what is compared; an empty table before anything is measured."""
    studies = split(load(results))
    return studies[0].times if studies else pd.DataFrame()


def _effects(times: pd.DataFrame, by: Stated, contrasts: Any) -> list[dict[str, Any]]:  # noqa: ANN401 - JSON
    """Return a row for each contrast: the sum of the logarithms of the series' times in a block, each with
    its weight, judged as a log ratio is, Holm-corrected over all contrasts.
    """
    if not contrasts:
        return []
    of_block = ["block", "session"]
    logs = np.log(times.pivot_table("steps_seconds", of_block, "series")).dropna()
    stops = times.groupby(of_block)["stops"].mean().loc[logs.index]
    rows = []
    for one in contrasts:
        weights = pd.Series(one["weights"], dtype=float)
        if set(weights.index) <= set(logs.columns):
            sums = logs[weights.index].to_numpy() @ weights.to_numpy()
            rows.append(
                {"series": one["name"], "x": 0, **vars(judge_one(sums, by.margin, by.error, stops=stops))}
            )
    table = pd.DataFrame(rows)
    return list(map(_row, corrected(table, by.error).itertuples())) if rows else []


def _controls(times: pd.DataFrame, against: str) -> list[dict[str, Any]]:
    """Return the rows of the reference against itself. It has to differ from itself in no case, so that each
    interval has its part of the error (Bonferroni).
    """
    by = stated(times)
    part = by.error / max(1, times["x"].nunique())
    return list(map(_row, differences(times, against, Stated(by.margin, part)).itertuples()))


def _places(times: pd.DataFrame) -> list[dict[str, Any]]:
    if times["series"].nunique() < LEAGUE or times["x"].nunique() > 1:
        return []
    return [
        {"series": str(row.series), "first": row.place[0], "last": row.place[1], "bracket": row.bracket}
        for row in ranking(times, stated(times).margin).itertuples()
    ]


def _row(row: Any) -> dict[str, Any]:  # noqa: ANN401 - of a table
    """Return the row as JSON has it; what reaches without end is None."""
    told = {"series": str(row.series), "verdict": row.verdict, "x": int(row.x), "blocks": int(row.blocks)}
    numbers = {key: float(getattr(row, key)) for key in ("ratio", "alone", "p")}
    differs = bool(np.isfinite(row.high) and not row.low <= 1 <= row.high)
    ends = {name: _end(getattr(row, name)) for name in ("low", "high", "totals", "start", "round")}
    return {**told, **numbers, **ends, "differs": differs}


def _end(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
