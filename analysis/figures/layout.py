"""When a figure is laid out: once, before it is written in any format."""

from collections.abc import Callable
from weakref import WeakKeyDictionary

from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

POINTS_PER_INCH = 72
"""The unit of an SVG and a PDF that matplotlib writes."""

_WHEN_LAID_OUT: WeakKeyDictionary[Figure, list[Callable[[], object]]] = WeakKeyDictionary()


def when_laid_out(figure: Figure, then: Callable[[], object]) -> None:
    """Call a function as soon as the places and limits of all axes are settled, before anything is drawn."""
    _WHEN_LAID_OUT.setdefault(figure, []).append(then)


def lay_out(figure: Figure) -> None:
    """Settle the layout for good and call what waits for it; nothing where that was done."""
    engine = figure.get_layout_engine()
    if engine is not None:
        FigureCanvasSVG(figure)  # which measures texts as they are written
        figure.dpi = POINTS_PER_INCH
        engine.execute(figure)
        figure.set_layout_engine("none")
    for then in _WHEN_LAID_OUT.pop(figure, []):
        then()
