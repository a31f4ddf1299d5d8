"""A comparison of programs as a league table: who is faster than whom, who was not checked, who failed."""

import pandas as pd

from analysis.derived.comparisons import stated
from analysis.figures.style import Cell, Table
from analysis.records.studies import Study
from analysis.statistics.ranking import ranking
from analysis.support.wording import number

COLUMNS = ("place", "program", "time, s", "bracket", "checked")
UNCHECKED = "not checked"
ANOTHER = "another command"

_TRAJECTORY = "trajectory of "


def league(study: Study, experiment: str) -> Table | None:
    """Return the table of an experiment of whole processes at one place of its sweep, None for any other."""
    times, failures = (table[table["experiment"] == experiment] for table in (study.times, study.failures))
    if times.empty or (times["kind"] != "process").any() or times["x"].nunique() > 1:
        return None
    checked = study.runs_of(experiment).groupby("series")["check_scope"].agg(_checked)
    rows = [
        (
            Cell(_place(*row.place)),
            Cell(row.series),
            Cell(number(row.seconds)),
            Cell(row.bracket),
            Cell(checked[row.series], _mark(checked[row.series])),
        )
        for row in ranking(times, stated(times).margin).itertuples()
    ]
    failed = failures[~failures["series"].isin(checked.index)].groupby("series")["reason"].first()
    rows += [
        (Cell("–"), Cell(str(series)), Cell("–"), Cell(""), Cell(f"failed: {reason}", "fails"))
        for series, reason in failed.items()
    ]
    title = (
        "In the order of their times. Programs with a letter in common cannot be told apart, or differ by "
        "less than the margin; those without differ by more (all pairs, Holm-corrected)"
    )
    return Table(title, COLUMNS, rows)


def _checked(scopes: pd.Series) -> str:
    """Say what of a program was checked."""
    said = {UNCHECKED if scope == "nothing" else scope.removeprefix(_TRAJECTORY) for scope in scopes}
    return "; ".join(sorted(said))


def _mark(checked: str) -> str:
    """What was checked in another program, or not at all, says nothing of the one that was timed."""
    return "open" if UNCHECKED in checked or ANOTHER in checked else ""


def _place(first: int, last: int) -> str:
    return str(first) if first == last else f"{first} to {last}"
