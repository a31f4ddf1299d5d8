"""Names written at the ends of curves, moved apart where they would overlap."""

from collections.abc import Sequence

from matplotlib.axes import Axes

LINE_POINTS = 9.0


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
