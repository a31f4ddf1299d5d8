"""A figure laid out and drawn once, and written in several formats from what it drew; and the font of
figures, of which a PDF holds a part.
"""

from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary
from zlib import crc32

import matplotlib as mpl
from matplotlib import font_manager
from matplotlib.backend_bases import FigureCanvasBase, GraphicsContextBase, RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.path import Path as Outline
from matplotlib.transforms import Affine2D, Bbox, Transform, TransformedPath

from support.files import replacing

POINTS_PER_INCH = 72
"""What a figure is recorded in, and the unit of an SVG and a PDF."""

DOTS_PER_INCH = 200
"""Of a PNG."""

PNG_LEVEL = 3
"""How hard a PNG is compressed: it takes half the time of the usual level, and is a tenth larger."""

FONT = "DejaVu Sans"
SMALL_FONT = "DejaVu Sans of figures"
CHARACTERS = (
    (0x20, 0x7E), (0xA0, 0xFF), (0x3B1, 0x3C9), (0x2010, 0x2026), (0x2070, 0x208E), (0x2190, 0x2193),
    (0x2212, 0x2212), (0x221E, 0x221E), (0x2248, 0x2248), (0x2264, 0x2265), (0x25A0, 0x25A1),
    (0x25AC, 0x25AC), (0x25B2, 0x25B3), (0x25BC, 0x25C2), (0x25C6, 0x25CF), (0x2713, 0x271A),
)  # fmt: skip
"""Of the small font, from and to: Latin, Greek, punctuation, raised and lowered digits, arrows, signs."""

_WHEN_LAID_OUT: WeakKeyDictionary[Figure, list[Callable[[], object]]] = WeakKeyDictionary()

Call = tuple[str, GraphicsContextBase | None, tuple[Any, ...], dict[str, Any]]


def when_laid_out(figure: Figure, then: Callable[[], object]) -> None:
    """Call a function as soon as the places and limits of all axes are settled, before anything is drawn."""
    _WHEN_LAID_OUT.setdefault(figure, []).append(then)


def lay_out(figure: Figure) -> None:
    """Settle the layout for good and call what waits for it; nothing where that was done."""
    engine = figure.get_layout_engine()
    if engine is not None:
        if not isinstance(figure.canvas, _Canvas):
            _Canvas(figure)
        engine.execute(figure)
        figure.set_layout_engine("none")
    for then in _WHEN_LAID_OUT.pop(figure, []):
        then()


class Recording:
    """What a figure draws, taken down once."""

    def __init__(self, figure: Figure) -> None:
        lay_out(figure)
        renderer = _Canvas(figure).get_renderer()
        figure.draw(renderer)
        self._replay = _Replay(figure, renderer.calls)

    def write(self, path: Path, suffix: str) -> None:
        """Write the figure as `svg`, `png` or `pdf`."""
        if suffix == "svg":
            FigureCanvasSVG(self._replay).print_svg(path, metadata={"Date": None})
        elif suffix == "pdf":
            from matplotlib.backends.backend_pdf import FigureCanvasPdf  # takes a sixth of a second to load

            FigureCanvasPdf(self._replay).print_pdf(path, metadata={"CreationDate": None})
        else:
            self._replay.dpi = DOTS_PER_INCH
            FigureCanvasAgg(self._replay).print_png(path, pil_kwargs={"compress_level": PNG_LEVEL})


class _Canvas(FigureCanvasBase):
    """Lays a figure out with the renderer that records it, so that each text is measured once."""

    def __init__(self, figure: Figure) -> None:
        super().__init__(figure)
        figure.dpi = POINTS_PER_INCH
        width, height = figure.get_size_inches() * POINTS_PER_INCH
        self._renderer = _Recorder(float(width), float(height))

    def get_renderer(self) -> "_Recorder":
        return self._renderer


class _Recorder(RendererBase):
    def __init__(self, width: float, height: float) -> None:
        super().__init__()
        self._size = width, height
        self.calls: list[Call] = []

    def get_canvas_width_height(self) -> tuple[float, float]:
        return self._size

    def _take(self, name: str, gc: GraphicsContextBase | None, *values: Any, **named: Any) -> None:  # noqa: ANN401
        if gc is not None:
            kept = GraphicsContextBase()
            kept.copy_properties(gc)
            gc = kept
        frozen = (value.frozen() if isinstance(value, Transform) else value for value in values)
        self.calls.append((name, gc, tuple(frozen), named))

    def open_group(self, s: str, gid: str | None = None) -> None:
        self._take("open_group", None, s, gid)

    def close_group(self, s: str) -> None:
        self._take("close_group", None, s)

    def draw_path(self, gc: Any, path: Any, transform: Any, rgbFace: Any = None) -> None:  # noqa: ANN401
        self._take("draw_path", gc, path, transform, rgbFace)

    def draw_markers(self, gc: Any, *values: Any, **named: Any) -> None:  # noqa: ANN401
        self._take("draw_markers", gc, *values, **named)

    def draw_path_collection(self, gc: Any, *values: Any, **named: Any) -> None:  # noqa: ANN401
        self._take("draw_path_collection", gc, *values, **named)

    def draw_text(self, gc: Any, *values: Any, **named: Any) -> None:  # noqa: ANN401
        self._take("draw_text", gc, *values, **named)


class _Replay(Figure):
    """A figure that draws what was recorded of another one, in as many dots per inch as it has."""

    def __init__(self, figure: Figure, calls: list[Call]) -> None:
        super().__init__(figsize=tuple(figure.get_size_inches()), dpi=POINTS_PER_INCH, layout=None)
        self._calls = calls

    def draw(self, renderer: RendererBase) -> None:
        scale = Affine2D().scale(self.dpi / POINTS_PER_INCH)
        for name, recorded, values, named in self._calls:
            if recorded is None:
                getattr(renderer, name)(*values)
                continue
            gc = renderer.new_gc()
            gc.copy_properties(recorded)
            _scale_clip(gc, scale)
            if name == "draw_text":
                x, y, *rest = values
                x, y = scale.transform((x, y))
                height = self.get_figheight() * self.dpi
                values = (x, y if renderer.flipy() else height - y, *rest)
            else:
                values = tuple(one + scale if isinstance(one, Transform) else one for one in values)
            getattr(renderer, name)(gc, *values, **named)
            gc.restore()


def _scale_clip(gc: GraphicsContextBase, scale: Affine2D) -> None:
    rectangle, (outline, transform) = gc.get_clip_rectangle(), gc.get_clip_path()
    if rectangle is not None:
        gc.set_clip_rectangle(Bbox(scale.transform(rectangle.get_points())))
    if isinstance(outline, Outline):
        gc.set_clip_path(TransformedPath(outline, transform + scale))


@cache
def families() -> tuple[str, ...]:
    """Return the font families of figures, the first for what it has: the part of DejaVu Sans that figures
    use, from which a PDF takes its letters five times as fast as from the whole. It is made once and kept
    in matplotlib's cache.
    """
    try:
        for weight in ("normal", "bold"):
            kept = (
                Path(mpl.get_cachedir())
                / f"carom-{mpl.__version__}-{crc32(repr(CHARACTERS).encode()):x}-{weight}.ttf"
            )
            if not kept.exists():
                with replacing(kept) as part:
                    _write_small_font(part, weight)
            font_manager.fontManager.addfont(kept)
    except (ImportError, OSError):
        return (FONT,)
    return SMALL_FONT, FONT


def _write_small_font(target: Path, weight: str) -> None:
    # A package without types, which matplotlib brings.
    subset, fonts = import_module("fontTools.subset"), import_module("fontTools.ttLib")
    whole = fonts.TTFont(font_manager.findfont(font_manager.FontProperties(FONT, weight=weight)))
    options = subset.Options(layout_features=["kern", "liga"], glyph_names=True, notdef_outline=True)
    options.drop_tables += ["FFTM", "MATH"]
    chosen = subset.Subsetter(options)
    chosen.populate(unicodes=[code for first, last in CHARACTERS for code in range(first, last + 1)])
    chosen.subset(whole)
    for number, name in ((1, SMALL_FONT), (4, SMALL_FONT), (6, SMALL_FONT.replace(" ", "-"))):
        whole["name"].setName(name, number, 3, 1, 0x409)
        whole["name"].removeNames(nameID=number, platformID=1)
    whole.save(target)
