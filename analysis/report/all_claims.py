"""The figure of all claims: of each the published effect and the measured interval, on one axis."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from analysis import claims
from analysis.claims.entry import Evidence, evidence_of
from analysis.claims.summary import colour_of, mark
from analysis.figures.kinds import arrow, span
from analysis.figures.style import (
    BAND,
    BLUE,
    FAINT,
    INK,
    SKY,
    VERMILLION,
    WIDTH,
    Drawing,
    lighten,
    save,
    styled,
)
from analysis.records.reading import load
from analysis.report.words import tell
from analysis.statistics.verdicts import Ratio

NAME = "claims"
LOOK = {
    "holds": (BLUE, "o", "measured, 95 % interval: holds"),
    "in_direction": (SKY, "o", "holds in direction, maybe by little"),
    "fails": (VERMILLION, "s", "does not hold"),
    "open": ("#b4b4b4", "o", "not decided"),
}
"""Colour and mark of a verdict, and what the key says of it; of one that is open the mark is hollow."""
PUBLISHED_LOOK: Any = {"markerfacecolor": "none", "markersize": 4.6, "markeredgewidth": 0.8}
PALE_INK = "#6e6e6e"
"""Of the names of what is open: pale, and still to be read."""

LINEAR = 10
"""Per cent up to which the axis is linear; it is logarithmic beyond."""
LOWEST, HIGHEST = (-90, -50, -20, -10), (10, 20, 50, 100, 200, 600)
"""Where the axis may end."""
TICKS = (-50, -20, -10, -5, 0, 5, 10, 20, 50, 100, 500)
FEWER_TICKS = (-50, -10, 0, 10, 50, 200)


@dataclass(frozen=True)
class Layout:
    """Where things stand, in inches: on a screen and on paper, or on a telephone."""

    width: float
    left: float
    row: float
    gap: float
    below: float
    ticks: Sequence[int]
    is_narrow: bool


WIDE = Layout(WIDTH, 3.55, 0.125, 0.05, 0.62, TICKS, is_narrow=False)
NARROW = Layout(3.2, 1.24, 0.14, 0.2, 0.74, FEWER_TICKS, is_narrow=True)
ABOVE, RIGHT = 0.2, 0.12
"""Inches beside the axes."""
LETTERS = 7
"""The size of names, in points."""


def all_claims(table: pd.DataFrame, layout: Layout = WIDE) -> Drawing | None:
    """Draw the `table` of a study's claims; None if no claim has an effect.

    Each row is a link to its claim in the report beside the folder of figures.
    """
    rows = table.to_dict("records")
    if not any(one.is_measured for row in rows for one in row["effects"]):
        return None
    height = sum(layout.gap + layout.row * max(1, len(row["effects"])) for row in rows)
    figure = Figure(figsize=(layout.width, height + ABOVE + layout.below))
    figure.set_layout_engine("none")
    whole = figure.get_figheight()
    width = 1 - (layout.left + RIGHT) / layout.width
    axes = figure.add_axes((layout.left / layout.width, layout.below / whole, width, height / whole))
    _axis(axes, rows, layout, height)
    top = 0.0
    for row in rows:
        bottom = top + layout.gap + layout.row * max(1, len(row["effects"]))
        _claim(axes, row, top, layout)
        _link(figure, row["id"], ((whole - ABOVE - bottom) / whole, (bottom - top) / whole))
        top = bottom
    _key(figure, layout)
    elsewhere = any(mark(row).startswith("(") for row in rows)
    return Drawing(figure, tell("all_claims", linear=LINEAR, elsewhere=elsewhere))


def _axis(axes: Axes, rows: Sequence[Mapping[Any, Any]], layout: Layout, height: float) -> None:
    effects = [one for row in rows for one in row["effects"]]
    known = [_per_cent(value) for one in effects for value in (one.ratio, one.published) if isfinite(value)]
    # Estimates alone stretch the axis: an interval that does not fit ends in an arrow.
    low = max((end for end in LOWEST if end <= min([*known, -LINEAR])), default=LOWEST[0])
    high = min((end for end in HIGHEST if end >= max([*known, LINEAR])), default=HIGHEST[-1])
    axes.set_xscale("symlog", linthresh=LINEAR, linscale=0.8)
    axes.set(xlim=(low, high), ylim=(height, 0), yticks=[])
    shown = [tick for tick in layout.ticks if low <= tick <= high]
    axes.set_xticks(shown, [f"{tick:+d}".replace("-", "−") if tick else "0" for tick in shown])
    axes.minorticks_off()
    axes.tick_params(labelsize=6, labeltop=True, top=True, length=2, pad=1.5)
    beyond = "" if layout.is_narrow else f" (linear up to {LINEAR} %, logarithmic beyond)"
    axes.set_xlabel(f"change of time, %{beyond}", fontsize=6.5, labelpad=2)
    axes.axvline(0, color=FAINT, linewidth=0.7, zorder=1)
    axes.spines["left"].set_visible(False)


def _per_cent(ratio: float) -> float:
    return 100 * (ratio - 1)


def _claim(axes: Axes, row: Mapping[Any, Any], top: float, layout: Layout) -> None:
    """Draw the rows of a claim below `top`, with its name and those of its effects."""
    look = colour_of(row)
    ink = {"open": PALE_INK, "fails": VERMILLION}.get(look, INK)
    first = top + layout.gap + layout.row / 2
    name = f"{mark(row)} {row['name']}"
    place = axes.get_yaxis_transform()
    in_figure = -layout.left / (layout.width - layout.left - RIGHT)
    look_of_name: Any = {"transform": place, "size": LETTERS, "color": ink, "va": "center"}
    if layout.is_narrow:
        # On white, since the line of no difference runs below it.
        look_of_name["bbox"] = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
        axes.text(in_figure + 0.02, top + layout.gap * 0.55, name, **look_of_name)
    else:
        axes.text(in_figure + 0.015, first, name, **look_of_name)
        axes.axhline(top + layout.gap / 2, color=BAND, linewidth=0.5, zorder=0)
    for number, effect in enumerate(row["effects"]):
        height = first + number * layout.row
        low, high = map(_per_cent, effect.within)
        corner = low, height - layout.row / 2
        axes.add_patch(Rectangle(corner, high - low, layout.row, color=BAND, linewidth=0, zorder=0))
        if len(row["effects"]) > 1 or effect.is_exponent or layout.is_narrow:
            beside: Any = {"transform": place, "size": LETTERS - 1, "color": PALE_INK, "va": "center"}
            axes.text(-0.02, height, effect.what, ha="right", **beside)
        _effect(axes, effect, height, look)


def _effect(axes: Axes, effect: Ratio, height: float, look: str) -> None:
    colour, shape, _ = LOOK[look]
    is_open = look == "open"
    if effect.has_interval:
        span(axes, _per_cent(effect.low), _per_cent(effect.high), height, colour, 2.2)
    ours: Any = {"mfc": "white" if is_open else colour, "markersize": 4.2, "zorder": 4}
    theirs: Any = {**PUBLISHED_LOOK, "zorder": 5}
    grey = lighten(INK, 0.5) if is_open else INK
    for ratio, marker, ink, drawn in (
        (effect.ratio, shape, colour, ours), (effect.published, "D", grey, theirs),
    ):  # fmt: skip
        if isfinite(ratio) and not arrow(axes, _per_cent(ratio), height, ink):
            axes.plot(_per_cent(ratio), height, marker, color=ink, clip_on=False, **drawn)


def _link(figure: Figure, name: str, place: tuple[float, float]) -> None:
    """Make the whole row a link. It is next to transparent: what is wholly so cannot be clicked."""
    link = Rectangle((0, place[0]), 1, place[1], transform=figure.transFigure, linewidth=0)
    link.set(facecolor=(1, 1, 1, 0.01), zorder=20, url=f"../report.html#claim-{name}")
    figure.add_artist(link)


def _key(figure: Figure, layout: Layout) -> None:
    entries: list[tuple[Any, str]] = []
    for look, (colour, shape, text) in LOOK.items():
        face = "white" if look == "open" else colour
        drawn = Line2D([], [], color=colour, marker=shape, markersize=4.2, linewidth=2.2, mfc=face)
        entries.append((drawn, text))
    published = Line2D([], [], color=INK, marker="D", linestyle="", **PUBLISHED_LOOK)
    entries += [(published, "published"), (Patch(color=BAND), "no difference that matters")]
    figure.legend(
        *zip(*entries, strict=True), loc="lower left", ncols=2 if layout.is_narrow else 3, fontsize=6,
        frameon=False, handlelength=2.2, columnspacing=1.2, labelspacing=0.3, borderaxespad=0.2,
    )  # fmt: skip


def draw(data: Evidence, table: pd.DataFrame | None = None, *, pdf: bool = False) -> tuple[str, list[Path]]:
    """Write the figure into the folder of figures, wide and narrow as SVG, wide as `pdf` as well if wanted.

    The claims are evaluated unless their `table` is given. Return the figure's caption and files, none where
    there is nothing to draw.
    """
    if table is None:
        table = claims.evaluate(data)
    files: list[Path] = []
    caption = ""
    for name, layout in ((f"{data.prefix}{NAME}", WIDE), (f"{data.prefix}{NAME}-narrow", NARROW)):
        with styled(name):
            drawing = all_claims(table, layout)
        if drawing is None:
            return "", []
        caption = drawing.caption
        files += save(drawing, data.folder / "figures", name, pdf=pdf and layout is WIDE)
    return caption, files


def draw_all_claims(results: Path) -> list[Path]:
    """Draw the claims of every study of a results folder as SVG and PDF; return the first file of each.

    What cannot be read is told by whoever draws the other figures of the folder.
    """
    records = load(results, lambda _: None)
    drawn = [draw(data, pdf=True)[1] for data in evidence_of(results, records)]
    return [files[0] for files in drawn if files]
