"""What a point tells when the pointer rests on it: titles inside the SVG."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analysis.figures.layout import POINTS_PER_INCH

CLOSE = 1.0
"""Points within which a mark of the SVG is the one of a point."""


@dataclass(frozen=True)
class Told:
    """A point in words: its name, and its values along both axes, which the axes' labels name. An empty one
    is left out.
    """

    name: str = ""
    x: str = ""
    y: str = ""


_TOLD: WeakKeyDictionary[Line2D, Sequence[Told]] = WeakKeyDictionary()


def tell(line: Line2D, points: Iterable[Told]) -> None:
    """Give each point of a line, in their order, the words that it tells in the SVG."""
    _TOLD[line] = list(points)


def point(axes: Axes, x: float, y: float, mark: str, told: Told, **look: Any) -> None:  # noqa: ANN401
    """Draw a point that tells something."""
    (drawn,) = axes.plot(x, y, mark, **look)
    tell(drawn, [told])


def identify(figure: Figure) -> list[Line2D]:
    """Return the lines whose points tell something, each with an identifier that the SVG will have."""
    lines = [line for line in figure.findobj(Line2D) if isinstance(line, Line2D) and line in _TOLD]
    for number, line in enumerate(lines):
        line.set_gid(f"points-{number}")
    return lines


def with_titles(svg: str, figure: Figure, lines: Sequence[Line2D]) -> str:
    """Return the figure's SVG with a title in each mark of the lines that were identified."""
    for line in lines:
        begin = svg.index(f'<g id="{line.get_gid()}"')
        end = svg.find('<g id="', begin + 1)
        part = svg[begin:] if end < 0 else svg[begin:end]
        svg = svg[:begin] + _titled(part, _places(figure, line), _texts(line)) + svg[begin + len(part) :]
    return svg


def _places(figure: Figure, line: Line2D) -> np.ndarray:
    """Return where the points of a line are in the SVG, whose vertical axis points downwards."""
    places = line.get_transform().transform(line.get_xydata()) * (POINTS_PER_INCH / figure.dpi)
    places[:, 1] = POINTS_PER_INCH * figure.get_figheight() - places[:, 1]
    return places


def _texts(line: Line2D) -> list[str]:
    axes = line.axes
    labels = (_x_label(axes), axes.get_ylabel()) if axes is not None else ("", "")
    x, y = (" ".join(f"{label}: ".split()) + " " if label.strip() else "" for label in labels)
    values = ((told.name, told.x and f"{x}{told.x}", told.y and f"{y}{told.y}") for told in _TOLD[line])
    return ["\n".join(filter(None, one)) for one in values]


def _x_label(axes: Any) -> str:  # noqa: ANN401 - of a line, whose axes have no public type
    """Return what the horizontal axis is called, there or in a panel that shares it."""
    shared = axes.get_shared_x_axes().get_siblings(axes)
    return next(filter(None, (one.get_xlabel() for one in (axes, *shared))), "")


def _titled(part: str, places: np.ndarray, texts: Sequence[str]) -> str:
    """Put the text of the nearest point into each mark; matplotlib leaves out those outside of the figure."""

    def title(mark: re.Match[str]) -> str:
        distances = np.hypot(*(places - [float(mark[2]), float(mark[3])]).T)
        distances[np.isnan(distances)] = np.inf
        nearest = int(distances.argmin())
        if distances[nearest] > CLOSE:
            return mark[0]
        return f"{mark[1]}><title>{escape(texts[nearest], quote=False)}</title></use>"

    return re.sub(r'(<use [^>]*\bx="([-\d.]+)" y="([-\d.]+)"[^>]*?)/>', title, part)
