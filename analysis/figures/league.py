"""A comparison of programs as a league table: who is faster than whom, who was not checked, who failed."""

import pandas as pd

from analysis.derived.comparisons import stated
from analysis.records.studies import Study
from analysis.statistics.ranking import ranking
from analysis.support.values import Cell, Table, table_of
from analysis.support.wording import listed, number

COLUMNS = ("place", "program", "time, s", "bracket", "checked")
UNCHECKED = "not checked"
ANOTHER = "another command"

_TRAJECTORY = "trajectory of "


def league(study: Study, experiment: str) -> Table | None:
    """Return the table of an experiment of whole processes at one place of its sweep, None for any other."""
    times, failures = study.of(experiment, "times", "failures")
    if times.empty or (times["kind"] != "process").any() or times["x"].nunique() > 1:
        return None
    checked = study.runs_of(experiment).groupby("series")["check_scope"].agg(_checked)
    rows = []
    for row in ranking(times, stated(times).margin).itertuples():
        said = checked[row.series]
        # What was checked in another program, or not at all, says nothing of the one that was timed.
        mark = "open" if UNCHECKED in said or ANOTHER in said else ""
        place = listed(sorted(set(row.place)), " to ")
        rows.append((place, row.series, number(row.seconds), row.bracket, Cell(said, mark)))
    failed = failures[~failures["series"].isin(checked.index)].groupby("series")["reason"].first()
    rows += [
        ("–", str(series), "–", "", Cell(f"failed: {reason}", "fails")) for series, reason in failed.items()
    ]
    title = (
        "In the order of their times. Programs with a letter in common cannot be told apart, or differ by "
        "less than the margin; those without differ by more (all pairs, Holm-corrected)"
    )
    return table_of(title, COLUMNS, rows)


def _checked(scopes: pd.Series) -> str:
    """Say what of a program was checked."""
    said = {UNCHECKED if scope == "nothing" else scope.removeprefix(_TRAJECTORY) for scope in scopes}
    return "; ".join(sorted(said))
