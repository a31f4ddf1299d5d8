"""Draws a run as an animation, or one moment of it as a picture: discs coloured by their speed, over the
boxes of the grid in the four colours in which the checkered order resolves them.
"""

import logging
import math
import shutil
from dataclasses import dataclass
from pathlib import Path
from subprocess import CalledProcessError
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from matplotlib.text import Text

from analysis.figures.style import INK, SETTINGS
from analysis.records.reading import InputError
from analysis.records.trajectory import Box, Floats, Trajectory, read_box, read_trajectory
from analysis.support.files import replacing

FRAMES_PER_SECOND = 25
FRAMES = 150
"""About so many frames a movie has: a short run is shown slowly, of a long one only every k-th step."""

MOST_BOXES = 48
"""Boxes a side up to which they are drawn; more of them would be finer than the picture."""

COLOURS = ("#dceaf5", "#fbe6d4", "#ddf0e4", "#f3e3ee")
"""Of the boxes, pale: even and odd rows times even and odd columns."""

ORDER = ("first", "second", "third", "fourth")

SUFFIXES = (".mp4", ".gif", ".png")


@dataclass(frozen=True)
class Moment:
    """A point in time: `fraction` of a step after the state `step`."""

    step: int
    fraction: float


def draw(scene: Path, trajectory: Path, output: Path | None = None, step: int | None = None) -> Path:
    """Draw the run of a scene and return the file.

    A file *.mp4 needs ffmpeg, *.gif does not; *.png is the picture of one step, the last if none is given.
    Without an output it is results/movies/SCENE.mp4, or .gif where ffmpeg is missing. Raises InputError, and
    OSError where the file cannot be written.
    """
    target = output or Path("results", "movies", scene.stem).with_suffix(".mp4" if _has_ffmpeg() else ".gif")
    _require_format(target)
    box, run = read_box(scene), read_trajectory(trajectory)
    if step is not None and not 0 <= step <= run.steps:
        raise InputError(f"--step: found {step}, expected a step from 0 to {run.steps}")
    with mpl.rc_context(SETTINGS), replacing(target) as part:
        picture = Picture(scene.name, box, run)
        if target.suffix == ".png":
            picture.show(Moment(run.steps if step is None else step, 0.0))
            picture.figure.savefig(part, dpi=150)
        else:
            _animate(picture, run, part)
    return target


def moments(steps: int, frames: int) -> list[Moment]:
    """Return when the frames of a run of so many steps are, from its start to its end.

    Between two steps discs fly freely, so that any moment there is exact.
    """
    if steps >= frames:
        every = math.ceil(steps / frames)
        return [Moment(step, 0.0) for step in (*range(0, steps, every), steps)]
    parts = frames // max(1, steps)
    return [Moment(step, part / parts) for step in range(steps) for part in range(parts)] + [
        Moment(steps, 0.0)
    ]


def boxes_per_side(box: Box) -> int:
    """Return how many boxes of the published side, 4r + 1, lie along a side of the box."""
    return max(1, math.ceil(box.side / (4 * box.radius + 1)))


def _has_ffmpeg() -> bool:
    return shutil.which("ffmpeg") is not None


def _require_format(target: Path) -> None:
    if target.suffix not in SUFFIXES:
        raise InputError(
            f"{target}: found the suffix '{target.suffix}', expected one of {', '.join(SUFFIXES)}"
        )
    if target.suffix == ".mp4" and not _has_ffmpeg():
        raise InputError(f"{target}: needs ffmpeg, which is not here; install it, or choose a name *.gif")


def _animate(picture: "Picture", run: Trajectory, target: Path) -> None:
    animation = FuncAnimation(
        picture.figure, picture.show, moments(run.steps, FRAMES), blit=False, cache_frame_data=False
    )
    writer: Any = FFMpegWriter if target.suffix == ".mp4" else PillowWriter
    # It would print all that ffmpeg says; one line of it is told below.
    logging.getLogger("matplotlib.animation").setLevel(logging.CRITICAL)
    try:
        animation.save(target, writer=writer(fps=FRAMES_PER_SECOND), dpi=100)
    except (CalledProcessError, BrokenPipeError) as error:
        said = str(getattr(error, "stderr", "")).strip().splitlines() or ["it broke off without a word"]
        raise InputError(f"ffmpeg: {said[-1]}; a name *.gif needs no ffmpeg") from error


class Picture:
    """A figure whose discs can be moved."""

    def __init__(self, name: str, box: Box, run: Trajectory) -> None:
        self._run = run
        self._name = name
        self.figure = Figure(figsize=(6.4, 6.4))
        axes = self.figure.add_subplot()
        axes.set(xlim=_limits(box), ylim=_limits(box), aspect="equal", xticks=[], yticks=[])
        axes.spines[:].set_visible(False)
        _draw_boxes(axes, box)
        self._title: Text = axes.set_title("", color=INK)
        self._discs = self._add_discs(axes, box)
        self.figure.set_layout_engine("constrained", h_pad=0.1)
        # The layout is settled once, not once a frame.
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")

    def show(self, moment: Moment) -> list[Any]:
        """Put the discs where they are at the moment."""
        velocities = self._run.velocities[moment.step]
        self._discs.set_offsets(self._run.positions[moment.step] + moment.fraction * velocities)
        self._discs.set_array(np.hypot(*velocities.T))
        self._title.set_text(f"{self._name}, step {moment.step} of {self._run.steps}")
        return [self._discs, self._title]

    def _add_discs(self, axes: Axes, box: Box) -> EllipseCollection:
        width = np.full(self._run.positions.shape[1], 2 * box.radius)
        discs = EllipseCollection(
            width, width, np.zeros_like(width), units="xy", offsets=self._run.positions[0],
            offset_transform=axes.transData, cmap="viridis", edgecolor=INK, linewidth=0.3, alpha=0.9,
            zorder=3,
        )  # fmt: skip
        discs.set_clim(0, _fast(np.linalg.norm(self._run.velocities, axis=-1)))
        axes.add_collection(discs)
        bar = self.figure.colorbar(discs, ax=axes, shrink=0.6, pad=0.02)
        bar.set_label("speed, lengths per unit of time")
        return discs


def _limits(box: Box) -> tuple[float, float]:
    """The box and a little beside it: discs may be outside for a while."""
    margin = min(2 * box.radius, 0.05 * box.side)
    return -margin, box.side + margin


def _fast(speeds: Floats) -> float:
    """The speed of the brightest colour: that of the fastest but one in a hundred."""
    return float(np.quantile(speeds, 0.99)) or 1.0


def _draw_boxes(axes: Axes, box: Box) -> None:
    axes.add_patch(Rectangle((0, 0), box.side, box.side, fill=False, edgecolor=INK, linewidth=1, zorder=2))
    count = boxes_per_side(box)
    if count > MOST_BOXES:
        axes.set_xlabel(f"{count} x {count} boxes, too small to be drawn")
        return
    side = max(4 * box.radius + 1, box.side / count)
    for row in range(count):
        for column in range(count):
            corner = column * side, row * side
            width, height = (min(side, box.side - start) for start in corner)
            colour = COLOURS[row % 2 * 2 + column % 2]
            axes.add_patch(
                Rectangle(corner, width, height, facecolor=colour, edgecolor="white", linewidth=0.5)
            )
    axes.legend(
        handles=[Patch(facecolor=colour, label=name) for name, colour in zip(ORDER, COLOURS, strict=True)],
        loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=4, frameon=False,
        title="Boxes of one colour are resolved in parallel: no disc is in reach of two of them.",
    )  # fmt: skip
