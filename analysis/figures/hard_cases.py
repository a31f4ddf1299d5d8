"""The hard cases: how far each variant stays from the bound of each case, and the table of all verdicts."""

from collections.abc import Iterable, Sequence
from textwrap import fill
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.derived import hard_cases as cases
from analysis.derived.hard_cases import AT_CONTACT, FAILS, HOLDS, LIMIT, UNMEASURED
from analysis.figures.hover import Told, point
from analysis.figures.labels import key, name_rows
from analysis.figures.speed_against_error import power_of_ten
from analysis.figures.style import BLUE, FAINT, INK, VERMILLION, Data, Drawing, new_figure
from analysis.support.values import Cell, Table, table_of
from analysis.support.wording import count

COLOURS = {"double": BLUE, "float": VERMILLION}
MARKS = {HOLDS: "holds", FAILS: "fails", LIMIT: "open", UNMEASURED: "open"}
SIGNS = {HOLDS: "✓", FAILS: "✗", LIMIT: "!", UNMEASURED: "–"}
LABEL_WIDTH = 30
"""Letters in a line of what a row measures."""

WIDEST = 6
"""Variants side by side in one table, so that it fits a printed page."""


def hard_cases(data: Data, experiment: str, subject: str) -> Drawing | None:
    """Draw the measure of every case and variant against its bound, with the table of verdicts, if any."""
    table = cases.evaluate(data.study, experiment)
    if table.empty or (table["verdict"] == UNMEASURED).all():
        return None
    expected = {one.title: one for one in cases.load()}
    labels = {title: expected[title].label if title in expected else "" for title in table["title"]}
    drawn = list(dict.fromkeys(table.loc[table["value"].notna(), "title"]))
    figure, (axes,) = new_figure(0.9 + 0.22 * max(1, len(drawn)))
    _dots(axes, table, drawn)
    _name_measures(axes, [labels[title] for title in drawn])
    present = [precision for precision in COLOURS if (table["precision"] == precision).any()]
    key(axes, [*((f"● {one}", COLOURS[one]) for one in present), ("| bound", INK)])
    caption = (
        f"{subject}: {count(table['case'].nunique(), 'case')} and "
        f"{count(table['series'].nunique(), 'variant')}, a process for each. A dot is a variant on a case, "
        "at the measure that the case is about; a bar is the most that it may be in the dot's precision. "
        f"Hollow: a limit of the method, and the bar the least that it must be. {cases.summary(table)}"
    )
    return Drawing(figure, caption, tables=list(_tables(table, labels)))


def _dots(axes: Axes, table: pd.DataFrame, titles: list[str]) -> None:
    shown = table[table["title"].isin(titles) & table["value"].notna()]
    positive = pd.concat([shown["value"], shown["bound"].dropna()])
    positive = positive[positive > 0]
    zero = 10.0 ** (np.floor(np.log10(positive.min())) - 1) if len(positive) else 1e-16
    heights = {title: -number for number, title in enumerate(titles)}
    for row in shown.to_dict("records"):
        colour = COLOURS.get(row["precision"], INK)
        height = heights[row["title"]] - (0.14 if row["precision"] == "float" else -0.14)
        value = max(row["value"], zero)
        look: Any = {"color": colour, "mfc": "white" if row["verdict"] == LIMIT else colour, "zorder": 3}
        bound = "" if pd.isna(row["bound"]) else f" (bound {row['bound']:.1e})"
        told = Told(f"{row['case']}, {row['series']}: {row['verdict']}", f"{row['value']:.1e}{bound}")
        point(axes, value, height, "o", told, markersize=3.5, **look)
        if pd.notna(row["bound"]):
            axes.plot([max(row["bound"], zero)] * 2, [height - 0.14, height + 0.14], color=INK, linewidth=1.1)
    axes.set_xscale("log")
    name_rows(axes, [title.replace("_", " ") for title in heights], list(heights.values()))
    axes.set_xlabel("what stands to the right of each case; relative where it has no unit")
    powers = range(round(np.log10(zero)) + 1, int(np.floor(np.log10(axes.get_xlim()[1]))) + 1)
    axes.set_xticks([zero, *(10.0**power for power in powers if power % 2 == 0)])
    axes.xaxis.set_major_formatter(lambda value, _: "0" if value <= zero else power_of_ten(value))
    axes.minorticks_off()
    for height in heights.values():
        axes.axhline(height - 0.5, color=FAINT, linewidth=0.3, zorder=1)


def _name_measures(axes: Axes, labels: Sequence[str]) -> None:
    """Write to the right of each row what its axis measures."""
    right = axes.twinx()
    right.set_ylim(axes.get_ylim())
    lines = [fill(label, LABEL_WIDTH) for label in labels]
    right.set_yticks([-float(line) for line in range(len(lines))], lines, fontsize=6, color=FAINT)
    right.tick_params(axis="y", length=0)
    right.set_zorder(axes.get_zorder() - 1)
    axes.patch.set_visible(False)


def _tables(verdicts: pd.DataFrame, labels: dict[str, str]) -> Iterable[Table]:
    """Yield a table for at most `WIDEST` variants of one precision and one time of impact: a row a case, a
    cell a verdict and a number.
    """
    expects = {one.title: one.expects for one in cases.load()}
    known = verdicts.fillna({"precision": ""})
    for (precision, at_contact), alike in known.groupby(["precision", known["impact"] == AT_CONTACT]):
        collisions = ", collisions at contact" if at_contact else ""
        heading = f"In {precision} precision{collisions}:" if precision else "Without any record:"
        series = list(dict.fromkeys(alike["series"]))
        for first in range(0, len(series), WIDEST):
            chosen = series[first : first + WIDEST]
            part = alike[alike["series"].isin(chosen)]
            rows: list[list[Cell | str]] = [
                [
                    f"{case.replace('_', ' ')}: {expects.get(title, '')}",
                    labels.get(title, ""),
                    *map(_verdict, group.to_dict("records")),
                ]
                for (case, title), group in part.groupby(["case", "title"], sort=False)
            ]
            yield table_of(heading, ["Case, and what is expected", "Number", *chosen], rows)


def _verdict(row: dict[str, object]) -> Cell:
    verdict, value, reason = str(row["verdict"]), row["value"], row["reason"]
    number = "" if pd.isna(value) else f" {value:.1e}" if value else " 0"
    said = f": {reason}" if verdict in (FAILS, LIMIT) and reason else ""
    return Cell(f"{SIGNS[verdict]}{number}{said}", MARKS[verdict])
