"""The frames of a movie: discs moved over a background that is drawn once, in one palette of few colours.

A frame is an array of indices into the palette. Discs are whole pixels without soft edges, so that equal
discs have equal pixels, which is what the formats of movies compress.
"""

from collections.abc import Iterator, Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.font_manager import findfont
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from analysis.commands.picture import Moment, Picture
from analysis.figures.style import INK

Bytes = NDArray[np.uint8]
Integers = NDArray[np.int64]

GREYS, SPEEDS, COLOURS = 4, 10, 64
"""Colours of the palette: from white to ink for the title, of the discs, and with the background's in all."""

TRANSPARENT = COLOURS - 1
"""The last one, which no frame has: for a format that says what has changed."""

RIM_FROM = 4.0
"""Pixels of radius from which a disc has a rim in ink; a smaller one would be nothing else."""


class Canvas:
    """A picture as pixels: its `palette`, a row of red, green and blue a colour, and its frames."""

    def __init__(self, picture: Picture, dots_per_inch: int) -> None:
        self._picture = picture
        figure = picture.figure
        figure.set_dpi(dots_per_inch)
        picture.title.set_text(picture.words(Moment(0, 0.0)))
        title = picture.title.get_window_extent()
        for artist in (picture.discs, picture.title):
            artist.set_visible(False)
        drawn = FigureCanvasAgg(figure)
        drawn.draw()
        pixels = np.asarray(drawn.buffer_rgba())[:, :, :3]
        self.background, colours = _few(pixels, TRANSPARENT - GREYS - SPEEDS)
        self.background += GREYS + SPEEDS
        self.palette: Bytes = np.vstack([_greys(), _shades(), colours, _greys()[:1]])
        height = len(pixels)
        self._at = round(title.x0), round(height - title.y1)
        size = float(picture.title.get_fontsize()) * dots_per_inch / 72
        self._font = ImageFont.truetype(findfont("DejaVu Sans"), size)
        box = picture.axes.get_window_extent()
        self._within = (round(height - box.y1), round(height - box.y0), round(box.x0), round(box.x1))
        scale = picture.axes.transData.get_matrix()[0, 0]
        self._disc = _disc(float(scale) * picture.box.radius)
        self._fastest = float(picture.discs.get_clim()[1])

    def frames(self, moments: Sequence[Moment]) -> Iterator[Bytes]:
        """Yield the picture at each moment."""
        for moment in moments:
            frame = self.background.copy()
            self._draw_discs(frame, moment)
            self._draw_title(frame, self._picture.words(moment))
            yield frame

    def _draw_discs(self, frame: Bytes, moment: Moment) -> None:
        down, right, rim = self._disc
        places = self._picture.axes.transData.transform(self._picture.positions(moment))
        rows = np.rint(len(frame) - places[:, 1]).astype(int)[:, np.newaxis] + down
        columns = np.rint(places[:, 0]).astype(int)[:, np.newaxis] + right
        shares = np.clip(self._picture.speeds(moment) / self._fastest, 0, 1)
        shades = GREYS + np.minimum((shares * SPEEDS).astype(int), SPEEDS - 1)
        values = np.where(rim, GREYS - 1, shades[:, np.newaxis]).astype(np.uint8)
        top, bottom, left, end = self._within
        seen = (rows >= top) & (rows < bottom) & (columns >= left) & (columns < end)
        frame[rows[seen], columns[seen]] = values[seen]

    def _draw_title(self, frame: Bytes, words: str) -> None:
        left, top = self._at
        _, _, width, height = (round(end) for end in self._font.getbbox(words))
        text = Image.new("L", (width, height))
        ImageDraw.Draw(text).text((0, 0), words, fill=255, font=self._font)
        place = frame[top : top + height, left : left + width]
        inked = np.asarray(text)[: place.shape[0], : place.shape[1]]
        place[:] = np.where(inked > 0, np.rint(inked / 255 * (GREYS - 1)).astype(np.uint8), place)


def _few(pixels: NDArray[np.uint8], colours: int) -> tuple[Bytes, Bytes]:
    """Return the picture as indices into so many colours, and these."""
    image = Image.fromarray(np.ascontiguousarray(pixels)).quantize(colours, dither=Image.Dither.NONE)
    palette = np.asarray(image.getpalette() or [], dtype=np.uint8).reshape(-1, 3)[:colours]
    missing = colours - len(palette)
    return np.array(image, dtype=np.uint8), np.vstack([palette, np.zeros((missing, 3), dtype=np.uint8)])


def _greys() -> Bytes:
    """From white to ink."""
    share = np.linspace(0, 1, GREYS)[:, np.newaxis]
    return np.rint(255 * ((1 - share) + share * np.array(to_rgb(INK)))).astype(np.uint8)


def _shades() -> Bytes:
    """From the slowest to the fastest."""
    middles = (np.arange(SPEEDS) + 0.5) / SPEEDS
    return np.rint(255 * mpl.colormaps["viridis"](middles)[:, :3]).astype(np.uint8)


def _disc(radius: float) -> tuple[Integers, Integers, NDArray[np.bool_]]:
    """Return the pixels of a disc, down and right of its centre, and which of them are its rim."""
    reach = int(np.ceil(radius))
    down, right = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    distance = np.hypot(down, right)
    inside = distance <= max(radius, 0.5)
    rim = distance > radius - 1 if radius >= RIM_FROM else np.zeros_like(inside)
    return down[inside], right[inside], rim[inside]
