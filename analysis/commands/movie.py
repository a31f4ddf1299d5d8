"""Draws a run as an animation, or one step of it as a picture."""

import logging
import math
import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path

import matplotlib as mpl
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from PIL import Image

from analysis.commands.picture import Moment, Picture
from analysis.figures.style import SETTINGS
from analysis.records.trajectory import read_box, read_trajectory
from support.errors import InputError
from support.files import replacing

FRAMES_PER_SECOND = 25
FRAMES = 150
"""About so many frames a movie has; a short run is shown slowly, of a long one only every k-th step."""

PICTURE_DOTS, MOVIE_DOTS = 150, 64
"""Dots per inch."""
COLOURS = 64
"""Of a GIF: few, so that it is small."""

FOLDER = Path("results", "movies")
SUFFIXES = (".mp4", ".gif", ".png")


def draw(scene: Path, trajectory: Path, output: Path | None = None, step: int | None = None) -> Path:
    """Draw the run of a scene and return the file.

    A file *.mp4 needs ffmpeg, *.gif does not; *.png is the picture of one step, the last if none is given.
    Raises InputError as `target_of`, and OSError where the file cannot be written.
    """
    target = target_of(scene, output, step)
    box, run = read_box(scene), read_trajectory(trajectory)
    if step is not None and step > run.steps:
        raise InputError(f"--step: found {step}, expected a step from 0 to {run.steps}")
    with mpl.rc_context(SETTINGS), replacing(target) as part:
        picture = Picture(scene.name, box, run)
        if target.suffix == ".png":
            picture.show(Moment(run.steps if step is None else step, 0.0))
            picture.figure.savefig(part, dpi=PICTURE_DOTS)
        else:
            picture.discs.set(antialiased=False, alpha=1)  # equal discs have equal pixels, which are small
            if target.suffix == ".mp4":
                writer: AbstractMovieWriter = FFMpegWriter(fps=FRAMES_PER_SECOND, codec="h264")
            else:
                writer = _SmallGif(fps=FRAMES_PER_SECOND)
            _write_movie(picture, moments(run.steps, FRAMES), part, writer)
    return target


def target_of(scene: Path, output: Path | None = None, step: int | None = None) -> Path:
    """Return the file that `draw` would write: without an output results/movies/SCENE.mp4, .gif where ffmpeg
    is missing, .png for a step. Raises InputError for a scene, an output or a step with which it could not.
    """
    box, has_ffmpeg = read_box(scene), shutil.which("ffmpeg") is not None
    suffix = ".png" if step is not None else ".mp4" if has_ffmpeg else ".gif"
    target = output or (FOLDER / scene.stem).with_suffix(suffix)
    if target.suffix not in SUFFIXES:
        expected = f"expected one of {', '.join(SUFFIXES)}"
        raise InputError(f"{target}: found the suffix '{target.suffix}', {expected}")
    if target.suffix == ".mp4" and not has_ffmpeg:
        raise InputError(f"{target}: needs ffmpeg, which is not here; install it, or choose a name *.gif")
    if output is not None and not target.parent.is_dir():
        raise InputError(f"{target}: found no folder {target.parent}, expected one that is there")
    if step is not None and target.suffix != ".png":
        raise InputError(f"{target}: found a step beside a movie, expected a name *.png for a single step")
    if step is not None and not 0 <= step <= box.steps:
        raise InputError(f"--step: found {step}, expected a step from 0 to {box.steps}")
    return target


def simulate(program: Path, scene: Path, variant: str, trajectory: Path) -> int:
    """Write the trajectory of a variant on a scene; return the program's exit code. What it says goes where
    this program's output goes.
    """
    words = [program, "run", scene, "--variant", variant, "--trajectory", trajectory]
    code = subprocess.call([str(word) for word in words])
    return code if code >= 0 else 128 - code


def moments(steps: int, frames: int) -> list[Moment]:
    """Return when the frames of a run of so many steps are, from its start to its end.

    Between two steps discs fly freely, so that any moment there is exact.
    """
    if steps >= frames:
        every = math.ceil(steps / frames)
        return [Moment(step, 0.0) for step in (*range(0, steps, every), steps)]
    parts = frames // max(1, steps)
    between = [Moment(step, part / parts) for step in range(steps) for part in range(parts)]
    return [*between, Moment(steps, 0.0)]


class _SmallGif(PillowWriter):
    """All frames have the few colours of the first."""

    _frames: list[Image.Image]

    def finish(self) -> None:
        """Write the file."""
        first = self._frames[0].quantize(COLOURS, dither=Image.Dither.NONE)
        others = (one.quantize(COLOURS, palette=first, dither=Image.Dither.NONE) for one in self._frames[1:])
        self._frames = [first, *others]
        super().finish()


def _write_movie(
    picture: Picture, shown: Iterable[Moment], target: Path, writer: AbstractMovieWriter
) -> None:
    logging.getLogger("matplotlib.animation").setLevel(logging.ERROR)  # which would tell it in many lines
    try:
        with writer.saving(picture.figure, str(target), MOVIE_DOTS):
            for moment in shown:
                picture.show(moment)
                writer.grab_frame()
    except subprocess.CalledProcessError as failed:
        lines = (failed.stderr or "").strip().splitlines()
        said = lines[-1] if lines else "it broke off without a word"
        raise InputError(f"ffmpeg: {said}; a name *.gif needs no ffmpeg") from failed
