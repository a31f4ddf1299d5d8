"""Names written at the ends of curves, and beside points, so that none lies on another."""

from collections.abc import Sequence

from matplotlib.axes import Axes

LINE_POINTS = 9.0

DIGIT_WIDTH, DIGIT_HEIGHT = 0.66, 1.0
"""Of a label beside a point, in sizes of its font."""

CORNERS = ((-1, -1), (1, -1), (-1, 1), (1, 1))
"""Where a label may stand beside its point, the best place first."""

BESIDE = 3.0
"""Points between a point and its label."""


def label_ends(axes: Axes, labels: Sequence[tuple[str, float, str]], size: float = 7) -> None:
    """Write each label (text, height in data units, colour) right of the axes, at least one line apart.

    Call it last: it needs the final limits and layout of the axes.
    """
    figure = axes.figure.get_figure(root=True)
    figure.draw_without_rendering()
    points = 72 / figure.dpi
    bottom, top = (axes.transAxes.transform((0, end))[1] * points for end in (0, 1))
    wanted = [axes.transData.transform((axes.get_xlim()[1], y))[1] * points for _, y, _ in labels]
    for (text, _, colour), height in zip(labels, spread(wanted, LINE_POINTS), strict=True):
        axes.annotate(
            text,
            (1.0, (height - bottom) / (top - bottom)),
            xycoords="axes fraction",
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            color=colour,
            fontsize=size,
        )


def label_points(axes: Axes, labels: Sequence[tuple[str, float, float]], colour: str, size: float = 6) -> int:
    """Write each label (text, x, y) into a corner of its point where it lies on no other and beside no axes;
    leave out one that has no room. Return how many were written.

    Call it last, after the figure's `draw_without_rendering`: it needs the final limits and layout.
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
            if inside and not any(_overlap(box, other) for other in taken):
                taken.append(box)
                axes.annotate(
                    text, (x, y), xytext=(right * BESIDE, up * BESIDE), textcoords="offset points",
                    ha="left" if right > 0 else "right", va="bottom" if up > 0 else "top",
                    fontsize=size, color=colour, zorder=4,
                )  # fmt: skip
                break
    return len(taken)


def _overlap(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def spread(positions: Sequence[float], gap: float) -> list[float]:
    """Return the positions moved as little as needed to lie at least `gap` apart, in the same order.

    Neighbours that are too close form a group around their mean (pool adjacent violators).
    """
    order = sorted(range(len(positions)), key=lambda index: positions[index])
    groups: list[list[int]] = []
    for index in order:
        groups.append([index])
        while len(groups) > 1 and _too_close(groups[-2], groups[-1], positions, gap):
            groups[-2:] = [groups[-2] + groups[-1]]
    moved = [0.0] * len(positions)
    for group in groups:
        start = _first(group, positions, gap)
        for rank, index in enumerate(group):
            moved[index] = start + rank * gap
    return moved


def _first(group: list[int], positions: Sequence[float], gap: float) -> float:
    mean = sum(positions[index] for index in group) / len(group)
    return mean - gap * (len(group) - 1) / 2


def _too_close(lower: list[int], upper: list[int], positions: Sequence[float], gap: float) -> bool:
    last = _first(lower, positions, gap) + gap * (len(lower) - 1)
    return _first(upper, positions, gap) - last < gap
