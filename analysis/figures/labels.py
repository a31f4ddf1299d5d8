"""What is written in a figure: keys, ticks, names of rows, and names at the ends of curves and beside points,
so that none lies on another.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator
from matplotlib.transforms import Bbox
from scipy.optimize import isotonic_regression

from analysis.support.wording import exact

KEY_LETTERS = 105
"""Letters that a line of a key has room for."""

SIGNS = {"o": "●", "s": "■", "^": "▲", "D": "◆", "v": "▼", "P": "✚"}
HOLLOW_SIGNS = {"o": "○", "s": "□", "^": "△", "D": "◇", "v": "▽", "P": "✚"}
"""How a key writes the marks of curves."""

STEPS = (1, 2, 5)
"""Round numbers of one power of ten."""

LINE_POINTS = 9.0
"""Of a name at the end of a curve."""


def key(figure: Figure, entries: Sequence[tuple[str, str]]) -> None:
    """Name what is drawn above the panels, each text in its colour."""
    texts, colours = zip(*entries, strict=True)
    columns = max(1, min(len(texts), KEY_LETTERS // (max(map(len, texts)) + 3)))
    figure.legend(
        [Line2D([], [], linestyle="") for _ in texts], texts, loc="outside upper left", ncols=columns,
        labelcolor=list(colours), fontsize=7, frameon=False, handlelength=0, handletextpad=0, borderpad=0.2,
        columnspacing=1.3, labelspacing=0.3,
    )  # fmt: skip


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
    low, high = axis.get_view_interval()
    ticks = np.concatenate([10.0**power * np.array(STEPS) for power in range(-12, 13)])
    ticks = ticks[(ticks >= low) & (ticks <= high)]
    if len(ticks) < 3:
        ticks = np.asarray(MaxNLocator(most // 2 + 1, steps=[1, 2, 5, 10]).tick_values(low, high))
        ticks = ticks[ticks > 0]
    elif len(ticks) > most:
        ticks = ticks[np.isclose(np.log10(ticks) % 1, 0)]
    axis.set_major_locator(FixedLocator([float(f"{tick:.6g}") for tick in ticks]))
    plain_ticks(axis)


def power_of_ten(value: float) -> str:
    """Return a power of ten as 0.01 or 10⁻⁶, whichever is shorter to read."""
    power = round(np.log10(value))
    if -3 <= power <= 3:
        return exact(value)
    return f"10{str(power).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}"


def from_zero(axes: Axes) -> None:
    """Let the vertical axis begin at zero, with room above the highest point."""
    axes.set_ylim(0, axes.get_ylim()[1] * 1.02)


def _points(axes: Axes, x: float, y: float) -> tuple[float, float]:
    """Return, nearly, where a place of a panel will be, in points from its corner."""
    figure = axes.figure.get_figure(root=True)
    place = axes.transAxes.inverted().transform(axes.transData.transform((x, y)))
    across, up = place * axes.get_position().size * figure.get_size_inches() * 72
    return float(across), float(up)


def label_ends(axes: Axes, labels: Sequence[tuple[str, float, str]], size: float = 7) -> None:
    """Write each label (text, height in data units, colour) right of the axes, none on another. Call it when
    the limits are settled.
    """
    gap = LINE_POINTS * max((text.count("\n") + 1 for text, _, _ in labels), default=1)
    at = [_points(axes, axes.get_xlim()[1], y)[1] for _, y, _ in labels]
    beside: Any = {"xycoords": ("axes fraction", "data"), "va": "center", "fontsize": size}
    for (text, y, colour), wanted, place in zip(labels, at, spread(at, gap), strict=True):
        note(axes, text, (1, y), (4, place - wanted), color=colour, **beside)


def label_points(
    axes: Axes, labels: Sequence[tuple[str, float, float]], colour: str, size: float = 6
) -> None:
    """Write each label (text, x, y) below and left of its point; leave out one that would lie on another.
    Call it when the limits are settled.
    """
    taken: list[Bbox] = []
    for text, x, y in labels:
        right, up = _points(axes, x, y)
        box = Bbox.from_extents(right - 0.66 * size * len(text), up - size, right, up)
        if box.x0 > 0 and not box.count_overlaps(taken):
            taken.append(box)
            note(axes, text, (x, y), (-3, -3), fontsize=size, color=colour, zorder=4, ha="right", va="top")


def spread(positions: Sequence[float], gap: float) -> list[float]:
    """Return the positions moved as little as needed to lie at least `gap` apart, in the same order."""
    if not positions:
        return []
    order = np.argsort(positions, kind="stable")
    gaps = gap * np.arange(len(order))
    moved = np.empty(len(order))
    moved[order] = isotonic_regression(np.asarray(positions)[order] - gaps).x + gaps
    return [float(position) for position in moved]
