"""Draws a run as an animation, or one step of it as a picture."""

import math
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import matplotlib as mpl
import numpy as np
from PIL import Image

from analysis.commands.frames import TRANSPARENT, Bytes, Canvas
from analysis.commands.movie_file import target_of
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
            canvas = Canvas(picture, MOVIE_DOTS)
            frames = canvas.frames(moments(run.steps, FRAMES))
            (_write_mp4 if target.suffix == ".mp4" else _write_gif)(canvas, frames, part)
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


def _write_gif(canvas: Canvas, frames: Iterator[Bytes], target: Path) -> None:
    """Write what changes from frame to frame: all else is transparent, and stays as it was."""
    palette = canvas.palette.tobytes()

    def images() -> Iterator[Image.Image]:
        before = None
        for frame in frames:
            changed = frame if before is None else np.where(frame == before, TRANSPARENT, frame)
            before = frame
            image = Image.frombytes("P", frame.shape[::-1], changed.astype(np.uint8).tobytes())
            image.putpalette(palette)
            yield image

    drawn = images()
    first = next(drawn)
    first.save(
        target, save_all=True, append_images=drawn, palette=palette, optimize=False, loop=0, disposal=1,
        transparency=TRANSPARENT, duration=1000 // FRAMES_PER_SECOND,
    )  # fmt: skip


def _write_mp4(canvas: Canvas, frames: Iterator[Bytes], target: Path) -> None:
    height, width = canvas.background.shape
    source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(FRAMES_PER_SECOND)]
    result = ["-an", "-vcodec", "h264", "-pix_fmt", "yuv420p", str(target)]
    with tempfile.TemporaryFile("w+", errors="replace") as errors:
        command = ["ffmpeg", "-loglevel", "error", "-y", *source, "-i", "-", *result]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=errors) as child:
            try:
                assert child.stdin is not None
                for frame in frames:
                    child.stdin.write(canvas.palette[frame].tobytes())
                child.stdin.close()
            except BrokenPipeError:
                pass  # what it says is told below
        if child.returncode != 0:
            errors.seek(0)
            said = errors.read().strip().splitlines() or ["it broke off without a word"]
            raise InputError(f"ffmpeg: {said[-1]}; a name *.gif needs no ffmpeg")
