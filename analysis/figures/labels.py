"""What is written in a figure: keys, ticks, and names at the ends of curves and beside points, so that none
lies on another.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.offsetbox import AnchoredOffsetbox, HPacker, TextArea, VPacker
from matplotlib.textpath import TextPath
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator
from matplotlib.transforms import ScaledTranslation
from scipy.optimize import isotonic_regression

from analysis.figures.layout import POINTS_PER_INCH, when_laid_out
from analysis.figures.style import WIDTH
from analysis.support.wording import exact

KEY_SIZE, KEY_GAP, KEY_WIDTH = 7, 9, 72 * WIDTH - 50
"""In points: of the letters of a key, between its entries, and the most of a line, beside an axis."""

SIGNS = {"o": "●", "s": "■", "^": "▲", "D": "◆", "v": "▼", "P": "✚"}
HOLLOW_SIGNS = {"o": "○", "s": "□", "^": "△", "D": "◇", "v": "▽", "P": "✚"}
"""How a key writes the marks of curves."""

STEPS = (
    tuple(1 + part / 20 for part in range(180)), tuple(1 + part / 10 for part in range(90)),
    (1, 1.2, 1.4, 1.6, 2, 2.5, 3, 4, 5, 6, 8), (1, 1.5, 2, 3, 5, 7), (1, 2, 5), (1, 3), (1,), (),
)  # fmt: skip
"""Round numbers of one power of ten, ever fewer."""

LINE_POINTS = 9.0

DIGIT_WIDTH, DIGIT_HEIGHT = 0.66, 1.0
"""Of a label beside a point, in sizes of its font."""

CORNERS = ((-1, -1), (1, -1), (-1, 1), (1, 1))
"""Where a label may stand beside its point, the best place first."""

BESIDE = 3.0
"""Points between a point and its label."""


def key(axes: Axes, entries: Sequence[tuple[str, str]], raised: float = 4) -> None:
    """Name the curves above the axes, each in its own colour, in as many lines as it takes; `entries` are
    text and colour, `raised` is in points.
    """
    lines: list[Artist] = [
        HPacker(
            children=[TextArea(text, textprops={"color": to, "fontsize": KEY_SIZE}) for text, to in line],
            pad=0,
            sep=KEY_GAP,
            align="baseline",
        )
        for line in _lines_of_key(entries)
    ]
    figure = axes.figure.get_figure(root=True)
    anchored = AnchoredOffsetbox(
        "lower left", child=VPacker(children=lines, pad=0, sep=3, align="left"), pad=0, borderpad=0,
        frameon=False, bbox_to_anchor=(0, 1),
        bbox_transform=axes.transAxes + ScaledTranslation(0, raised / 72, figure.dpi_scale_trans),
    )  # fmt: skip
    # Wide keys run on over the neighbouring axes: only their height may count in the layout.
    anchored.set_in_layout(False)
    axes.set_title("\n".join(" " for _ in lines), pad=raised)
    axes.add_artist(anchored)


def _lines_of_key(entries: Sequence[tuple[str, str]]) -> list[list[tuple[str, str]]]:
    """Share the entries out to lines that end before the figure does."""
    lines: list[list[tuple[str, str]]] = [[]]
    left = KEY_WIDTH
    for text, colour in entries:
        width = TextPath((0, 0), text, size=KEY_SIZE).get_extents().width + KEY_GAP
        if width > left and lines[-1]:
            lines.append([])
            left = KEY_WIDTH
        lines[-1].append((text, colour))
        left -= width
    return lines


def name_rows(axes: Axes, names: Sequence[str], heights: Sequence[float] | None = None) -> None:
    """Name the rows of a panel, without ticks: from below, one at each whole number if not at `heights`."""
    axes.set_yticks(range(len(names)) if heights is None else heights, names)
    axes.tick_params(axis="y", length=0)


def note(axes: Axes, text: str, at: tuple[float, float], by: tuple[float, float], **look: Any) -> None:  # noqa: ANN401
    """Write a text so many points to the right of a place and above it."""
    axes.annotate(text, at, xytext=by, textcoords="offset points", **look)


def plain_ticks(axis: Axis, values: Sequence[float] | None = None) -> None:
    """Write the ticks as plain numbers, thousands grouped, also on a logarithmic axis."""
    if values is not None:
        axis.set_ticks(list(values))
    axis.set_major_formatter(FuncFormatter(lambda value, _: exact(value)))
    # Each is costly, also one without a number.
    axis.set_minor_locator(NullLocator())


def percent_ticks(axis: Axis) -> None:
    """Put whole changes in per cent on an axis of ratios. Call it when its limits are settled."""
    low, high = (100 * (end - 1) for end in axis.get_view_interval())
    ticks = np.asarray(MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    axis.set_major_locator(FixedLocator(list(1 + ticks / 100)))
    said = FuncFormatter(lambda value, _: exact(round(100 * (value - 1), 6)).replace("-", "−"))
    axis.set_major_formatter(said)


def logarithmic_ticks(axis: Axis, most: int = 7) -> None:
    """Put plain numbers on a logarithmic axis, as many as have room. Call it when its limits are settled."""
    ticks = steps_within(*axis.get_view_interval(), most)
    if ticks:
        axis.set_major_locator(FixedLocator(ticks))
    plain_ticks(axis)


def steps_within(low: float, high: float, most: int) -> list[float]:
    """Return round numbers on a logarithmic axis, the densest at most `most` that lie far enough apart."""
    gap = np.log(high / low) / (most + 1)
    for steps in STEPS:
        powers = range(math.floor(math.log10(low)), math.floor(math.log10(high)) + 1)
        ticks = [float(f"{step * 10.0**power:.6g}") for power in powers for step in steps]
        ticks = [tick for tick in ticks if low <= tick <= high]
        if len(ticks) <= most and (len(ticks) < 2 or np.diff(np.log(ticks)).min() >= gap):
            return ticks
    return []


def from_zero(axes: Axes) -> None:
    """Let the vertical axis begin at zero, with room above the highest point."""
    axes.set_ylim(0, axes.get_ylim()[1] * 1.02)


def label_ends(axes: Axes, labels: Sequence[tuple[str, float, str]], size: float = 7) -> None:
    """Write each label (text, height in data units, colour) right of the axes, none on another."""
    lines = max((text.count("\n") + 1 for text, _, _ in labels), default=1)
    figure = axes.figure.get_figure(root=True)
    beside: Any = {"xycoords": ("axes fraction", "data"), "textcoords": "offset points", "va": "center"}
    written = [
        axes.annotate(text, (1, y), xytext=(4, 0), color=colour, fontsize=size, **beside)
        for text, y, colour in labels
    ]

    def move_apart() -> None:
        points = POINTS_PER_INCH / figure.dpi
        wanted = [axes.transData.transform((axes.get_xlim()[1], y))[1] * points for _, y, _ in labels]
        for text, height, place in zip(written, spread(wanted, lines * LINE_POINTS), wanted, strict=True):
            text.set_position((4, height - place))

    when_laid_out(figure, move_apart)


def label_points(axes: Axes, labels: Sequence[tuple[str, float, float]], colour: str, size: float = 6) -> int:
    """Write each label (text, x, y) into a corner of its point where it lies on no other and beside no axes;
    leave out one that has no room. Return how many were written.

    Call it when the figure is laid out: it needs the final limits and layout.
    """
    figure = axes.figure.get_figure(root=True)
    window = axes.get_window_extent()
    first, last = (end * 72 / figure.dpi for end in (window.x0, window.x1))
    taken: list[tuple[float, float, float, float]] = []
    for text, x, y in labels:
        at = axes.transData.transform((x, y)) * 72 / figure.dpi
        width, height = DIGIT_WIDTH * size * len(text), DIGIT_HEIGHT * size
        for right, up in CORNERS:
            left = at[0] + (BESIDE if right > 0 else -BESIDE - width)
            bottom = at[1] + (BESIDE if up > 0 else -BESIDE - height)
            box = (left, bottom, left + width, bottom + height)
            inside = first <= left and left + width <= last
            if inside and not any(
                box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
                for other in taken
            ):
                taken.append(box)
                align = {"ha": "left" if right > 0 else "right", "va": "bottom" if up > 0 else "top"}
                offset = right * BESIDE, up * BESIDE
                note(axes, text, (x, y), offset, fontsize=size, color=colour, zorder=4, **align)
                break
    return len(taken)


def spread(positions: Sequence[float], gap: float) -> list[float]:
    """Return the positions moved as little as needed to lie at least `gap` apart, in the same order."""
    if not positions:
        return []
    order = np.argsort(positions, kind="stable")
    gaps = gap * np.arange(len(order))
    moved = np.empty(len(order))
    moved[order] = isotonic_regression(np.asarray(positions)[order] - gaps).x + gaps
    return [float(position) for position in moved]
