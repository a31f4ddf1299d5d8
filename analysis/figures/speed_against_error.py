"""Time against error: a figure an error measure, a panel a scene, all from the same records."""

import re
from collections.abc import Mapping
from functools import partial as bound
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.derived import accuracy
from analysis.derived.accuracy import SMALL, Choice, Measure, Race
from analysis.figures.captions import opening
from analysis.figures.hover import Told, tell
from analysis.figures.labels import HOLLOW_SIGNS, SIGNS, key, label_points, logarithmic_ticks, plain_ticks
from analysis.figures.layout import when_laid_out
from analysis.figures.style import FAINT, INK, Data, Drawing, Look, lighten, looks, new_grid
from analysis.support.values import Cell, Interval, Row, Table, table_of
from analysis.support.wording import NO_BREAK, exact, interval, number

Label = tuple[str, float, float]
"""A text beside a point: the text, and the point's x and y."""

MOST_POWERS = 5
"""Of ten that have room below a panel."""

MILLI = 1e3
OTHERS = 2
"""How many of the choices that may be as cheap a table names."""


def draw(data: Data, experiment: str, subject: str, measure: Measure) -> Drawing | None:
    """Draw the time of a unit of simulated time over one error measure, a line a series, a panel a scene.

    None without records, and where the measure is 0 everywhere.
    """
    table = accuracy.points(data.study, experiment, measure)
    if table.empty or not (table["error"] > 0).any():
        return None
    scenes = dict(list(table.groupby("scene_name", sort=False)))
    figure, [panels] = new_grid(3.0, 1, len(scenes), sharex=True, sharey=True)
    shown = _looks(table)
    zero = 10 ** np.floor(np.log10(table.loc[table["error"] > 0, "error"].min()) - 1)
    labels: dict[str, list[Label]] = {}
    for axes, (scene, part) in zip(panels, scenes.items(), strict=True):
        labels[str(scene)] = _front(axes, part, zero)
        for series, line in part.groupby("series"):
            _line(axes, line, zero, shown[str(series)])
        axes.set(xscale="log", yscale="log")
        corner: Any = {"xycoords": "axes fraction", "ha": "right", "va": "top"}
        axes.annotate(_panel_name(str(scene), part), (1, 1), fontsize=7, color=INK, **corner)
    _settle_limits(panels[0], (table["error"] <= 0).any(), zero)
    panels[0].set_ylabel("time per unit of simulated time, ms")
    figure.supxlabel(measure.label, fontsize=8, color=INK)
    entries = [
        (f"{(SIGNS if look.dashes == '-' else HOLLOW_SIGNS)[look.marker]} {series}", look.colour)
        for series, look in shown.items()
    ]
    key(panels[0], [*entries, ("▬ Pareto front (substeps)", FAINT)])
    for axes, texts in zip(panels, labels.values(), strict=True):
        when_laid_out(figure, bound(label_points, axes, texts, INK))
    tables = [_advice(table, accuracy.races(data.study, experiment), measure)]
    if measure.converges:
        tables.append(_orders(table))
    return Drawing(figure, _caption(table, data, experiment, subject, measure), tables=tables)


def _looks(table: pd.DataFrame) -> dict[str, Look]:
    """Return the look of each series: one for a variant's precisions, hollow and dashed for float."""
    rows = table.drop_duplicates("series")
    families = [
        re.sub(r"(^|-)float(?=-|$)", "", variant).strip("-") or "published" for variant in rows["variant"]
    ]
    shown = looks(families)
    return {
        str(series): shown[family]._replace(dashes="-" if precision == "double" else "--")
        for series, precision, family in zip(rows["series"], rows["precision"], families, strict=True)
    }


def _line(axes: Axes, part: pd.DataFrame, zero: float, look: Look) -> None:
    rows = part.sort_values("x")
    error = rows["error"].clip(lower=zero)
    points, *_ = axes.errorbar(
        error, MILLI * rows["median"],
        xerr=[error - rows["error_low"].clip(lower=zero), rows["error_high"].clip(lower=zero) - error],
        yerr=[MILLI * (rows["median"] - rows["low"]).clip(lower=0), MILLI * (rows["high"] - rows["median"])],
        color=look.colour, linestyle=look.dashes, marker=look.marker, linewidth=0.9, elinewidth=0.9, zorder=3,
        markerfacecolor=look.colour if look.dashes == "-" else "white",
    )  # fmt: skip
    tell(points, [_told(row) for row in rows.to_dict("records")])


def _told(row: Row) -> Told:
    """Say a point's error and time."""
    time, low, high = (number(MILLI * row[end]) for end in ("median", "low", "high"))
    return Told(run_label(str(row["series"]), row["x"]), f"{row['error']:.2g}", f"{time} [{low}, {high}]")


def _front(axes: Axes, part: pd.DataFrame, zero: float) -> list[Label]:
    """Draw the Pareto front behind the curves; return its points' substeps as labels, cheapest first."""
    rows = part[part["on_front"]].sort_values("error")
    x, y = rows["error"].clip(lower=zero), MILLI * rows["median"]
    axes.plot(x, y, color=lighten(FAINT, 0.6), linewidth=5, solid_capstyle="round", zorder=1)
    return [
        (f"{substeps:g}" if substeps else series, one, other)
        for one, other, substeps, series in zip(x, y, rows["substeps"], rows["series"], strict=True)
    ][::-1]


def _panel_name(scene: str, part: pd.DataFrame) -> str:
    fraction = f"area fraction {part['area_fraction'].iloc[0]:.2f}"
    return f"{scene}, {fraction}" if scene else fraction


def _settle_limits(axes: Axes, has_zero: bool, zero: float) -> None:
    """Leave room for what is written in the panels, which share their axes; errors of exactly 0 stand at the
    left edge, so named.
    """
    (low, high), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    powers = range(int(np.ceil(np.log10(low))), int(np.floor(np.log10(high))) + 1)
    every = max(1, -(-len(powers) // MOST_POWERS))
    ticks = [10.0**power for power in powers if power % every == 0 and not (has_zero and 10.0**power <= zero)]
    axes.set(xlim=(low * 0.7, high * 1.2), ylim=(bottom, top * 1.6))
    axes.set_xticks([zero, *ticks] if has_zero else ticks)
    logarithmic_ticks(axes.yaxis)
    plain_ticks(axes.xaxis)
    axes.xaxis.set_major_formatter(
        lambda value, _: "0" if has_zero and value <= zero else power_of_ten(value)
    )


def power_of_ten(value: float) -> str:
    """Return a power of ten as 0.01 or 10⁻⁶, whichever is shorter to read."""
    power = round(np.log10(value))
    if -3 <= power <= 3:
        return exact(value)
    return f"10{str(power).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}"


def _advice(points: pd.DataFrame, races: Mapping[str, Race], measure: Measure) -> Table:
    scenes = dict(list(points.groupby("scene_name", sort=False)))
    rows: list[list[Cell | str]] = [
        [power_of_ten(bound), *(_choice(choices[str(scene)]) for scene in scenes)]
        for bound, choices in accuracy.advice(points, races)
    ]
    columns = ["For an error below", *(_panel_name(str(scene), part) for scene, part in scenes.items())]
    title = (
        f"The cheapest choice by {measure.title} (bounds: {measure.label}), and what a unit of simulated "
        "time costs with it. All intervals of a scene, and all that was found slower, hold together in 95 % "
        "of studies, since the choice was made by looking:"
    )
    return table_of(title, columns, rows)


def _choice(choice: Choice | None) -> Cell:
    if choice is None:
        return Cell("none of those measured", "open")
    named = [run_label(series, x) for series, x in choice.others[:OTHERS]]
    if len(choice.others) > OTHERS:
        named.append(f"{len(choice.others) - OTHERS} more")
    said = f"; not found slower: {', '.join(named)}" if named else ""
    estimate, low, high = (number(MILLI * end) for end in choice.seconds)
    return Cell(f"{run_label(choice.series, choice.substeps)}: {estimate}{NO_BREAK}ms [{low}, {high}]{said}")


def run_label(series: str, substeps: float) -> str:
    """Return a series with its step, e.g. `row, dt = 1/8`; the series alone where there are no steps."""
    if substeps == 0:
        return series
    return f"{series}, dt{NO_BREAK}={NO_BREAK}{'1' if substeps == 1 else f'1/{substeps:g}'}"


def _orders(points: pd.DataFrame) -> Table:
    found = accuracy.orders(points)
    scenes = list(dict.fromkeys(found["scene_name"]))
    rows: list[list[Cell | str]] = []
    for series, part in found.groupby("series", sort=False):
        fitted = part.set_index("scene_name")["order"]
        rows.append([str(series), *(_order(fitted.get(scene)) for scene in scenes)])
    title = (
        f"Order of convergence: p in error = c dt^p, over the errors below {SMALL:g}, with its 95 % interval "
        "from the scatter about the line (an error at the level of rounding does not fall and pulls p down):"
    )
    return table_of(title, ["Series", *(scene or "order" for scene in scenes)], rows)


def _order(fitted: object) -> Cell | str:
    if not isinstance(fitted, Interval) or np.isnan(fitted.estimate):
        return Cell(f"fewer than three errors below {SMALL:g}", "open")
    return interval(fitted)


def _caption(table: pd.DataFrame, data: Data, experiment: str, subject: str, measure: Measure) -> str:
    opened = opening(data.study.times_of(experiment), f"{subject}: {measure.title}")
    certain = "A point's error is the same in every run, to the last bit, and has no interval; its time has."
    if (table["error_low"] != table["error_high"]).any():
        certain = "Bars across are the range of the errors."
    zeros = " Errors of exactly 0 stand at the left edge." if (table["error"] <= 0).any() else ""
    fronts = "; ".join(
        f"{_panel_name(str(scene), part)}: {front_in_words(part)}"
        for scene, part in table.groupby("scene_name", sort=False)
    )
    return (
        f"{opened} The error is {measure.meaning}; down and to the left is better. {certain}"
        f"{_exact_sentence(table)}{zeros} By the medians, no other choice has at most the error and at most "
        f"the time of one on the Pareto front (grey): {fronts}."
    )


def _exact_sentence(table: pd.DataFrame) -> str:
    """Say what the error of the event-driven simulation is against, which is the reference of all others."""
    names = table.loc[table["substeps"] == 0, "series"].unique()
    if len(names) == 0:
        return ""
    return (
        f" {' and '.join(names)}: without steps, the simulation that the others are "
        "compared with; its own error is against the same in long double, and so the rounding of double."
    )


def front_in_words(part: pd.DataFrame) -> str:
    """Say who is on the front, from the cheapest: `row with 1, 2 and 4 substeps, then track with 8`."""
    rows = part[part["on_front"]].sort_values("median")
    said = []
    for series, group in groupby(zip(rows["series"], rows["substeps"], strict=True), key=itemgetter(0)):
        *most, last = (f"{substeps:g}" for _, substeps in group)
        listed = f"{', '.join(most)} and {last}" if most else last
        noun = "substep" if listed == "1" else "substeps"
        said.append(str(series) if listed == "0" else f"{series} with {listed} {noun}")
    return ", then ".join(said)
