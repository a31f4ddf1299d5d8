"""One moment of a run as a picture: discs coloured by their speed, over the boxes of the grid in the four
colours in which the checkered order resolves them.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from matplotlib.text import Text

from analysis.figures.style import INK
from analysis.records.trajectory import Box, Trajectory

MOST_BOXES = 48
"""Boxes a side up to which they are drawn; more of them would be finer than the picture."""

COLOURS = ("#dceaf5", "#fbe6d4", "#ddf0e4", "#f3e3ee")
"""Of the boxes, pale: even and odd rows times even and odd columns."""

ORDER = ("first", "second", "third", "fourth")


@dataclass(frozen=True)
class Moment:
    """A point in time: `fraction` of a step after the state `step`."""

    step: int
    fraction: float


def boxes_per_side(box: Box) -> int:
    """Return how many boxes of the published side, 4r + 1, lie along a side of the box."""
    return max(1, math.ceil(box.side / (4 * box.radius + 1)))


class Picture:
    """A figure whose discs can be moved."""

    def __init__(self, name: str, box: Box, run: Trajectory) -> None:
        self.run = run
        self.box = box
        self._name = name
        self.figure = Figure(figsize=(6.4, 6.4))
        self.axes = self.figure.add_subplot()
        self.axes.set(xlim=_limits(box), ylim=_limits(box), aspect="equal", xticks=[], yticks=[])
        self.axes.spines[:].set_visible(False)
        self.title: Text = self.axes.set_title(" ", color=INK)
        self._name_boxes()
        self._settle_layout()
        _draw_boxes(self.axes, box)

    def show(self, moment: Moment) -> None:
        """Put the discs where they are at the moment, in the colours of their speeds: between two steps they
        fly freely.
        """
        velocities = self.run.velocities[moment.step]
        self.discs.set_offsets(self.run.positions[moment.step] + moment.fraction * velocities)
        self.discs.set_array(np.hypot(*velocities.T))
        self.title.set_text(f"{self._name}, step {moment.step} of {self.run.steps}")

    def _name_boxes(self) -> None:
        count = boxes_per_side(self.box)
        if count > MOST_BOXES:
            self.axes.set_xlabel(f"{count} x {count} boxes, too small to be drawn")
            return
        self.figure.legend(
            handles=[
                Patch(facecolor=colour, edgecolor=INK, linewidth=0.3, label=name)
                for name, colour in zip(ORDER, COLOURS, strict=True)
            ],
            title="Boxes of one colour are resolved in parallel: no disc is in reach of two of them.",
            loc="outside lower center", ncols=4, frameon=False,
        )  # fmt: skip

    def _settle_layout(self) -> None:
        """Add the discs and settle the layout, once: of an empty box, since nothing in it takes room."""
        self.discs = self._add_discs()
        self.discs.set_visible(False)
        self.figure.set_layout_engine("constrained", h_pad=0.1)
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")
        self.discs.set_visible(True)

    def _add_discs(self) -> EllipseCollection:
        width = np.full(self.run.positions.shape[1], 2 * self.box.radius)
        discs = EllipseCollection(
            width, width, np.zeros_like(width), units="xy", offsets=self.run.positions[0],
            offset_transform=self.axes.transData, cmap="viridis", edgecolor=INK, linewidth=0.3, alpha=0.9,
            zorder=3,
        )  # fmt: skip
        # The brightest colour is that of the fastest disc but one in a hundred.
        discs.set_clim(0, float(np.quantile(np.linalg.norm(self.run.velocities, axis=-1), 0.99)) or 1.0)
        self.axes.add_collection(discs)
        bar = self.figure.colorbar(discs, ax=self.axes, shrink=0.6, pad=0.02)
        bar.set_label("speed of a disc, lengths per unit of time")
        return discs


def _limits(box: Box) -> tuple[float, float]:
    """The box and a little beside it: discs may be outside for a while."""
    margin = min(2 * box.radius, 0.05 * box.side)
    return -margin, box.side + margin


def _draw_boxes(axes: Axes, box: Box) -> None:
    axes.add_patch(Rectangle((0, 0), box.side, box.side, fill=False, edgecolor=INK, linewidth=1, zorder=2))
    count = boxes_per_side(box)
    if count > MOST_BOXES:
        return
    side = max(4 * box.radius + 1, box.side / count)
    ends, odd = np.minimum(side * np.arange(count + 1), box.side), np.arange(count) % 2
    look: Any = {
        "cmap": ListedColormap(COLOURS),
        "edgecolors": "white",
        "linewidth": 0.5,
        "zorder": 1,
        "antialiased": True,
    }
    axes.pcolormesh(ends, ends, 2 * odd[:, np.newaxis] + odd, vmin=0, vmax=len(COLOURS) - 1, **look)
