"""Which file a movie goes to, and whether it could be drawn at all: before anything is simulated."""

import shutil
from pathlib import Path

from analysis.records.trajectory import read_box
from support.errors import InputError

FOLDER = Path("results", "movies")
SUFFIXES = (".mp4", ".gif", ".png")


def target_of(scene: Path, output: Path | None = None, step: int | None = None) -> Path:
    """Return the file that `draw` would write: without an output results/movies/SCENE.mp4, .gif where ffmpeg
    is missing, .png for a step. Raises InputError for a scene, an output or a step with which it could not.
    """
    box = read_box(scene)
    suffix = ".png" if step is not None else ".mp4" if _has_ffmpeg() else ".gif"
    target = output or (FOLDER / scene.stem).with_suffix(suffix)
    if target.suffix not in SUFFIXES:
        expected = f"expected one of {', '.join(SUFFIXES)}"
        raise InputError(f"{target}: found the suffix '{target.suffix}', {expected}")
    if target.suffix == ".mp4" and not _has_ffmpeg():
        raise InputError(f"{target}: needs ffmpeg, which is not here; install it, or choose a name *.gif")
    if output is not None and not target.parent.is_dir():
        raise InputError(f"{target}: found no folder {target.parent}, expected one that is there")
    if step is not None and target.suffix != ".png":
        raise InputError(f"{target}: found a step beside a movie, expected a name *.png for a single step")
    if step is not None and not 0 <= step <= box.steps:
        raise InputError(f"--step: found {step}, expected a step from 0 to {box.steps}")
    return target


def _has_ffmpeg() -> bool:
    return shutil.which("ffmpeg") is not None
