"""What a results folder says of the commands that `carom compare` runs."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from analysis.derived.comparisons import Stated, differences, reference, stated
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.statistics.looks import next_look
from analysis.statistics.noise import needed_by_rows
from analysis.statistics.pairs import rounds_of, runs_of
from analysis.statistics.ranking import ranking
from analysis.statistics.verdicts import corrected, judge_one
from support.files import read_json
from support.vocabulary import AGAIN, ASKED, OWN, WALL

ENDS = ("low", "high", "totals", "start", "round", "low_of_all", "needed")
"""Of a row of `judge`, what may not be known or have no end."""

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
    table = differences(times[~is_control], against)
    together = Stated(by.margin, by.error / (max(1, len(table)) * many))
    table["low_of_all"] = differences(times[~is_control], against, together)["low"]
    table["needed"] = needed_by_rows(table, by.error)
    # The reference has to differ from itself in no case: each has its part of the error (Bonferroni).
    part = Stated(by.margin, by.error / max(1, times["x"].nunique()))
    controls = differences(times[is_control | (times["series"] == against)], against, part)
    return {
        "commands": _rows(table),
        "controls": _rows(controls),
        "places": _places(times[~is_control]),
        "effects": _rows(_effects(times, by, asked(results)["contrasts"])),
        "next": next_look(int(table["blocks"].max()) if len(table) else 0),
    }


def asked(results: Path) -> dict[str, Any]:
    """Return the names of the `cases` and the `contrasts` that the caller has written down."""
    found = read_json(results / ASKED)
    return {"cases": [], "contrasts": [], **(found if isinstance(found, dict) else {})}


def times_of(results: Path) -> pd.DataFrame:
    """Return the times of what is compared; an empty table before anything is measured."""
    studies = split(load(results))
    return studies[0].times if studies else pd.DataFrame()


def _effects(times: pd.DataFrame, by: Stated, contrasts: Any) -> pd.DataFrame:  # noqa: ANN401 - JSON
    """Return a row for each contrast: the sum of the logarithms of the series' times in a block, each with
    its weight, judged as a log ratio is, Holm-corrected over all contrasts.
    """
    of_block = ["block", "session"]
    logs = np.log(times.pivot_table("steps_seconds", of_block, "series")).dropna()
    stops = times.groupby(of_block)["stops"].mean().loc[logs.index]
    rows = []
    for one in contrasts:
        weights = pd.Series(one["weights"], dtype=float)
        if set(weights.index) <= set(logs.columns):
            sums = logs[weights.index].to_numpy() @ weights.to_numpy()
            found = judge_one(sums, by.margin, by.error, stops=stops)
            rows.append({"series": one["name"], "x": 0, **vars(found)})
    return corrected(pd.DataFrame(rows), by.error) if rows else pd.DataFrame()


def _places(times: pd.DataFrame) -> list[dict[str, Any]]:
    if times["series"].nunique() < LEAGUE or times["x"].nunique() > 1:
        return []
    return [
        {"series": str(row.series), "first": row.place[0], "last": row.place[1], "bracket": row.bracket}
        for row in ranking(times, stated(times).margin).itertuples()
    ]


def _rows(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the rows as JSON has them and whether each `differs` from 1; what has no end is None."""
    rows = []
    for row in table.to_dict("records"):
        ends = {name: float(row[name]) if np.isfinite(row.get(name, np.nan)) else None for name in ENDS}
        needed = None if ends["needed"] is None else int(ends["needed"])
        numbers = {name: float(row[name]) for name in ("ratio", "alone", "p")}
        told = {"series": row["series"], "verdict": row["verdict"], "x": int(row["x"]), **numbers, **ends}
        differs = ends["high"] is not None and not row["low"] <= 1 <= row["high"]
        rows.append({**told, "blocks": int(row["blocks"]), "needed": needed, "differs": differs})
    return rows
