"""Errors: time against error, a figure an error measure, a panel a scene; and the hard cases, how far each
variant stays from the bound of each, with the table of all verdicts.
"""

import re
from collections.abc import Iterable, Sequence
from textwrap import fill
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from analysis.claims.entry import Evidence
from analysis.derived import accuracy
from analysis.derived import hard_cases as cases
from analysis.derived.accuracy import SMALL, Measure
from analysis.derived.hard_cases import AT_CONTACT, COLUMNS, FAILS, HOLDS, LIMIT, UNMEASURED
from analysis.figures.captions import caption, opening
from analysis.figures.kinds import mark
from analysis.figures.labels import (
    HOLLOW_SIGNS,
    SIGNS,
    key,
    label_points,
    logarithmic_ticks,
    name_rows,
    power_of_ten,
)
from analysis.figures.style import (
    BLUE,
    FAINT,
    INK,
    VERMILLION,
    Drawing,
    Look,
    lighten,
    looks,
    new_figure,
    new_grid,
)
from analysis.support.values import Interval, Table
from analysis.support.wording import NO_BREAK, interval

MOST_POWERS = 5
"""Of ten that have room below a panel."""

MILLI = 1e3
COLOURS = {"double": BLUE, "float": VERMILLION}
IN_ORDER = [HOLDS, LIMIT, FAILS, UNMEASURED]
LABEL_WIDTH = 30
"""Letters in a line of what a row measures."""

WIDEST = 6
"""Variants side by side in one table, so that it fits a printed page."""


def speed_against_error(data: Evidence, experiment: str, subject: str, measure: Measure) -> Drawing | None:
    """Draw the time of a unit of simulated time over one error measure, a line a series, a panel a scene.

    None without records, and where the measure is 0 everywhere.
    """
    table = accuracy.points(data.study, experiment, measure)
    if table.empty or not (table["error"] > 0).any():
        return None
    scenes = dict(list(table.groupby("scene_name", sort=False)))
    figure, [panels] = new_grid(3.0, 1, len(scenes), sharex=True, sharey=True)
    shown = _looks(table)
    zero = _zero(table["error"])
    for axes, (scene, part) in zip(panels, scenes.items(), strict=True):
        for series, line in part.groupby("series"):
            _line(axes, line, zero, shown[str(series)])
        axes.set(xscale="log", yscale="log")
        corner: Any = {"xycoords": "axes fraction", "ha": "right", "va": "top"}
        axes.annotate(_panel_name(str(scene), part), (1, 1), fontsize=7, color=INK, **corner)
    _settle_limits(panels[0], (table["error"] <= 0).any(), zero)
    for axes, part in zip(panels, scenes.values(), strict=True):
        _front(axes, part, zero)
    panels[0].set_ylabel("time per unit of simulated time, ms")
    figure.supxlabel(measure.label, fontsize=8, color=INK)
    entries = [
        (f"{(SIGNS if look.dashes == '-' else HOLLOW_SIGNS)[look.marker]} {series}", look.colour)
        for series, look in shown.items()
    ]
    key(figure, [*entries, ("▬ Pareto front (substeps)", FAINT)])
    names = {str(scene): _panel_name(str(scene), part) for scene, part in scenes.items()}
    bounds = accuracy.advice(table, accuracy.races(data.study, experiment))
    tables: list[Table] = [("advice", {"bounds": bounds, "scenes": names, "measure": measure})]
    if measure.converges:
        fitted = accuracy.orders(table)
        found = {
            str(series): dict(zip(part["scene_name"], part["order"], strict=True))
            for series, part in fitted.groupby("series", sort=False)
        }
        named = {scene: scene or "order" for scene in dict.fromkeys(fitted["scene_name"])}
        tables.append(("orders", {"found": found, "scenes": named, "small": f"{SMALL:g}"}))
    return Drawing(figure, _caption(table, data, experiment, subject, measure), tables=tables)


def _zero(values: pd.Series) -> float:
    """Return where 0 stands on a logarithmic axis: a power of ten below all values above 0."""
    positive = values[values > 0]
    return float(10.0 ** (np.floor(np.log10(positive.min())) - 1)) if len(positive) else 1e-16


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
    errors = rows[["error", "error_low", "error_high"]].clip(lower=zero).to_numpy()
    times = MILLI * rows[["median", "low", "high"]].to_numpy()
    axes.plot(errors[:, 0], times[:, 0], color=look.colour, linestyle=look.dashes, linewidth=0.9, zorder=3)
    for row, (x, *across), (y, *up) in zip(rows.itertuples(), errors, times, strict=True):
        told = run_label(str(row.series), row.x), f"{row.error:.2g}", interval(Interval(y, *up))
        ends: Any = {"across": across, "up": up, "hollow": look.dashes != "-", "width": 0.9}
        mark(axes, (x, y), look, *told, **ends)


def _front(axes: Axes, part: pd.DataFrame, zero: float) -> None:
    """Draw the Pareto front behind the curves, on axes that are settled; beside its points stand their
    substeps, the cheapest first.
    """
    rows = part[part["on_front"]].sort_values("error")
    x, y = rows["error"].clip(lower=zero), MILLI * rows["median"]
    axes.plot(x, y, color=lighten(FAINT, 0.6), linewidth=5, solid_capstyle="round", zorder=1)
    names = (f"{row.substeps:g}" if row.substeps else row.series for row in rows.itertuples())
    label_points(axes, list(zip(names, x, y, strict=True))[::-1], INK)


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
    _error_ticks(axes, zero, ticks, has_zero=has_zero)
    logarithmic_ticks(axes.yaxis)


def _error_ticks(axes: Axes, zero: float, ticks: Sequence[float], *, has_zero: bool = True) -> None:
    """Put powers of ten on the axis of the errors, at whose left edge 0 stands."""
    axes.set_xticks([zero, *ticks] if has_zero else ticks)
    axes.minorticks_off()
    axes.xaxis.set_major_formatter(
        lambda value, _: "0" if has_zero and value <= zero else power_of_ten(value)
    )


def run_label(series: str, substeps: float) -> str:
    """Return a series with its step, e.g. `row, dt = 1/8`; the series alone where there are no steps."""
    if substeps == 0:
        return series
    return f"{series}, dt{NO_BREAK}={NO_BREAK}{'1' if substeps == 1 else f'1/{substeps:g}'}"


def _caption(table: pd.DataFrame, data: Evidence, experiment: str, subject: str, measure: Measure) -> str:
    # What the error of the event-driven simulation is against is the reference of all others.
    exact_ones = list(table.loc[table["substeps"] == 0, "series"].unique())
    fronts = [
        (_panel_name(str(scene), part), front_of(part))
        for scene, part in table.groupby("scene_name", sort=False)
    ]
    told = caption(
        "error", measure=measure, exact_ones=exact_ones, fronts=fronts, has_zero=(table["error"] <= 0).any(),
        has_range=(table["error_low"] != table["error_high"]).any(),
    )  # fmt: skip
    return f"{opening(data.study.times_of(experiment), f'{subject}: {measure.title}')} {told}"


def front_of(part: pd.DataFrame) -> list[tuple[str, list[str]]]:
    """Return who is on the front, from the cheapest: series, each with its substeps side by side."""
    rows = part[part["on_front"]].sort_values("median")
    return [
        (str(series), [f"{substeps:g}" for substeps in group["substeps"]])
        for _, group in rows.groupby((rows["series"] != rows["series"].shift()).cumsum())
        for series in group["series"].unique()
    ]


def hard_cases(data: Evidence, experiment: str, subject: str) -> Drawing | None:
    """Draw the measure of every case and variant against its bound, with the table of verdicts, if any."""
    table = cases.evaluate(data.study, experiment)
    if table.empty or (table["verdict"] == UNMEASURED).all():
        return None
    shown = table[table["value"].notna()]
    labels = shown.drop_duplicates("title")["label"]
    figure, (axes,) = new_figure(0.9 + 0.22 * max(1, len(labels)))
    _dots(axes, shown)
    _name_measures(axes, labels)
    present = [precision for precision in COLOURS if (table["precision"] == precision).any()]
    key(figure, [*((f"● {one}", COLOURS[one]) for one in present), ("| bound", INK)])
    told = caption(
        "hard_cases", subject=subject, cases=table["case"].nunique(), variants=table["series"].nunique(),
        cells=len(table), counts=table["verdict"].value_counts().reindex(IN_ORDER).dropna().astype(int),
    )  # fmt: skip
    return Drawing(figure, told, tables=list(_tables(table)))


def _dots(axes: Axes, shown: pd.DataFrame) -> None:
    zero = _zero(pd.concat([shown["value"], shown["bound"].dropna()]))
    heights = {title: -number for number, title in enumerate(shown["title"].unique())}
    for row in shown.itertuples():
        colour = COLOURS.get(row.precision, INK)
        height = heights[row.title] - (0.14 if row.precision == "float" else -0.14)
        bound = "" if pd.isna(row.bound) else f" (bound {row.bound:.1e})"
        told = f"{row.case}, {row.series}: {row.verdict}", f"{row.value:.1e}{bound}"
        mark(axes, (max(row.value, zero), height), Look(colour), *told, hollow=row.verdict == LIMIT)
        if bound:
            axes.plot([max(row.bound, zero)] * 2, [height - 0.14, height + 0.14], color=INK, linewidth=1.1)
    axes.set_xscale("log")
    name_rows(axes, [title.replace("_", " ") for title in heights], list(heights.values()))
    axes.set_xlabel("what stands to the right of each case; relative where it has no unit")
    powers = range(round(np.log10(zero)) + 1, int(np.floor(np.log10(axes.get_xlim()[1]))) + 1)
    _error_ticks(axes, zero, [10.0**power for power in powers if power % 2 == 0])
    for height in heights.values():
        axes.axhline(height - 0.5, color=FAINT, linewidth=0.3, zorder=1)


def _name_measures(axes: Axes, labels: Iterable[str]) -> None:
    """Write to the right of each row what its axis measures."""
    right = axes.twinx()
    right.set_ylim(axes.get_ylim())
    lines = [fill(label, LABEL_WIDTH) for label in labels]
    right.set_yticks([-float(line) for line in range(len(lines))], lines, fontsize=6, color=FAINT)
    right.tick_params(axis="y", length=0)
    right.set_zorder(axes.get_zorder() - 1)
    axes.patch.set_visible(False)


def _tables(verdicts: pd.DataFrame) -> Iterable[Table]:
    """Yield a table for at most `WIDEST` variants of one precision and one time of impact: a row a case, a
    cell a verdict and a number.
    """
    known = verdicts.fillna({"precision": ""})
    for (precision, at_contact), alike in known.groupby(["precision", known["impact"] == AT_CONTACT]):
        series = list(dict.fromkeys(alike["series"]))
        for first in range(0, len(series), WIDEST):
            chosen = series[first : first + WIDEST]
            part = alike[alike["series"].isin(chosen)]
            rows = [
                (case, expects, label, group[["verdict", "value", "reason"]].to_dict("records"))
                for (case, _, expects, label), group in part.groupby(COLUMNS[:4], sort=False)
            ]
            about = {"precision": precision, "at_contact": at_contact}
            yield "hard_cases", {**about, "series": chosen, "rows": rows}
