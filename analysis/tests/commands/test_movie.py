import os
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, QuadMesh
from matplotlib.image import imread
from PIL import Image, ImageSequence

from analysis.cli import main
from analysis.commands import movie
from analysis.commands.movie import FRAMES, MOVIE_DOTS, PICTURE_DOTS, moments
from analysis.commands.picture import ORDER, Moment, Picture, boxes_per_side
from analysis.figures.style import SETTINGS
from analysis.records.trajectory import Box, read_box, read_trajectory
from support.errors import InputError

ROOT = Path(__file__).parents[3]
STEPS = 4


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """Three discs in a box of three boxes a side, the last one fast."""
    path = tmp_path / "scene.in"
    path.write_text("3\n60\n5\n4\n0 10 10 1 0\n1 30 30 0 1\n2 50 50 -5 -5\n")
    return path


@pytest.fixture(autouse=True)
def few_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(movie, "FRAMES", 8)


@pytest.fixture
def trajectory(tmp_path: Path) -> Path:
    path = tmp_path / "trajectory"
    lines = [
        f"{step} 0 {10 + step} 10 1 0\n{step} 1 30 {30 + step} 0 1\n{step} 2 {back} {back} -5 -5\n"
        for step, back in enumerate(range(50, 50 - 5 * STEPS - 1, -5))
    ]
    path.write_text("".join(lines))
    return path


def test_a_movie_has_a_frame_for_each_moment(scene: Path, trajectory: Path, tmp_path: Path) -> None:
    target = movie.draw(scene, trajectory, tmp_path / "run.gif")
    with Image.open(target) as image:
        frames = [np.asarray(frame.convert("RGB"), dtype=int) for frame in ImageSequence.Iterator(image)]
    assert len(frames) == len(moments(STEPS, 8))
    assert (abs(frames[0] - frames[-1]).max(axis=2) > 60).sum() > 500, "the discs have moved"
    assert [path.name for path in tmp_path.iterdir() if "part" in path.name] == []


def test_a_picture_is_of_the_step_asked_for(scene: Path, trajectory: Path, tmp_path: Path) -> None:
    pictures = [
        imread(movie.draw(scene, trajectory, tmp_path / f"{step}.png", step)) for step in (None, 0, STEPS)
    ]
    assert np.array_equal(pictures[0], pictures[2]), "the last step, if none is given"
    assert not np.array_equal(pictures[0], pictures[1])


def test_moments_begin_at_the_start_and_end_at_the_end() -> None:
    for steps in (0, 1, 2, 7, FRAMES - 1, FRAMES, FRAMES + 1, 10 * FRAMES + 3):
        found = moments(steps, FRAMES)
        assert found[0] == Moment(0, 0.0)
        assert found[-1] == Moment(steps, 0.0)
        times = [moment.step + moment.fraction for moment in found]
        assert times == sorted(set(times))
        assert len(found) <= FRAMES + 1
    assert moments(3, 6) == [Moment(step, part) for step in range(3) for part in (0.0, 0.5)] + [
        Moment(3, 0.0)
    ]


def test_discs_fly_between_the_steps_and_are_coloured_by_speed(scene: Path, trajectory: Path) -> None:
    picture = Picture("scene.in", read_box(scene), read_trajectory(trajectory))
    picture.show(Moment(1, 0.5))
    (discs,) = (item for item in picture.figure.axes[0].collections if isinstance(item, EllipseCollection))
    offsets = np.asarray(discs.get_offsets())
    assert offsets.tolist() == [[11.5, 10.0], [30.0, 31.5], [42.5, 42.5]]
    assert np.asarray([discs.get_widths(), discs.get_heights()]).tolist() == [[10.0] * 3] * 2
    assert np.asarray(discs.get_array()) == pytest.approx([1.0, 1.0, np.hypot(5, 5)])


def test_boxes_of_one_colour_are_a_box_apart(scene: Path, trajectory: Path) -> None:
    picture = Picture("scene.in", read_box(scene), read_trajectory(trajectory))
    (legend,) = picture.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == list(ORDER)
    (boxes,) = (item for item in picture.figure.axes[0].collections if isinstance(item, QuadMesh))
    corners = np.array(boxes.get_coordinates())
    assert corners[0, :, 0].tolist() == corners[:, 0, 1].tolist() == [0, 21, 42, 60]
    assert np.asarray(boxes.get_array()).tolist() == [[0, 1, 0], [2, 3, 2], [0, 1, 0]]


def test_the_boxes_are_the_published_ones() -> None:
    assert boxes_per_side(Box(10_000, 16)) == 154
    assert boxes_per_side(Box(65, 16)) == 1
    assert boxes_per_side(Box(66, 16)) == 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--output", "run.avi"], "run.avi: found the suffix '.avi', expected one of .mp4, .gif, .png"),
        (["--output", "run.png", "--step", "5"], "--step: found 5, expected a step from 0 to 4"),
        (
            ["--output", "absent/run.png"],
            "absent/run.png: found no folder absent, expected one that is there",
        ),
        (
            ["--output", "run.gif", "--step", "1"],
            "run.gif: found a step beside a movie, expected a name *.png",
        ),
    ],
)
def test_what_cannot_be_drawn_is_one_line(
    scene: Path,
    trajectory: Path,
    arguments: list[str],
    said: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(scene.parent)
    there = sorted(scene.parent.iterdir())
    for run in ([str(trajectory)], []):
        assert main(["movie", str(scene), *run, *arguments]) == 1, "also before the run is there"
        (line,) = capsys.readouterr().err.splitlines()
        assert line.startswith(f"carom: {said}")
    assert sorted(scene.parent.iterdir()) == there


@pytest.mark.parametrize(
    ("does", "code", "output", "error"),
    [
        ('echo "$1 $4"; cp {run} "$6"', 0, "run nine\n{target}\n", ""),
        ("echo wrong >&2; exit 2", 2, "", "wrong\n"),
    ],
)
def test_without_a_run_it_is_simulated_by_the_program(
    scene: Path,
    trajectory: Path,
    capfd: pytest.CaptureFixture[str],
    does: str,
    code: int,
    output: str,
    error: str,
) -> None:
    program, target = scene.with_name("program"), scene.with_name("run.png")
    program.write_text(f"#!/bin/sh\n{does.format(run=trajectory)}\n")
    program.chmod(0o755)
    words = ["movie", str(scene), "--variant", "nine", "--output", str(target), "--program", str(program)]
    assert main(words) == code
    assert capfd.readouterr() == (output.format(target=target), error)
    assert target.exists() == (code == 0)


def test_a_movie_needs_a_run_or_the_program(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["movie", str(scene)]) == 1
    assert capsys.readouterr().err.startswith("carom: TRAJECTORY: missing, expected")


def test_the_legends_lie_inside_the_picture(scene: Path, trajectory: Path) -> None:
    for dots in (PICTURE_DOTS, MOVIE_DOTS):
        with mpl.rc_context(SETTINGS):
            picture = Picture("scene.in", read_box(scene), read_trajectory(trajectory))
            picture.figure.set_dpi(dots)
            picture.figure.draw_without_rendering()
        inside = picture.figure.bbox
        (legend,) = picture.figure.legends
        for artist in (legend, picture.figure.axes[1].yaxis.label):
            box = artist.get_window_extent()
            assert inside.x0 <= box.x0 <= box.x1 <= inside.x1
            assert inside.y0 <= box.y0 <= box.y1 <= inside.y1


def test_a_movie_of_many_discs_is_small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(movie, "FRAMES", 10)
    generator = np.random.default_rng(1)
    places, speeds = generator.uniform(0, 1000, (2000, 2)), generator.uniform(-2, 2, (2000, 2))
    states = np.hstack([places, speeds])
    (tmp_path / "scene.in").write_text("2000\n1000\n8\n10\n")
    lines = (
        f"{step} {disc} {' '.join(map(str, state + step * np.array([*state[2:], 0, 0])))}\n"
        for step in range(11)
        for disc, state in enumerate(states)
    )
    (tmp_path / "trajectory").write_text("".join(lines))
    target = movie.draw(tmp_path / "scene.in", tmp_path / "trajectory", tmp_path / "run.gif")
    assert target.stat().st_size < 11 * 22_000


def test_an_ffmpeg_that_fails_is_one_line(
    scene: Path, trajectory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = scene.parent
    (folder / "ffmpeg").write_text("#!/bin/sh\ncat >/dev/null\necho 'Unknown encoder h264' >&2\nexit 8\n")
    (folder / "ffmpeg").chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
    monkeypatch.chdir(folder)
    command = [sys.executable, "-m", "analysis", "movie", str(scene), str(trajectory), "--output", "run.mp4"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr == "carom: ffmpeg: Unknown encoder h264; a name *.gif needs no ffmpeg\n"
    assert not list(folder.glob("*run*"))


def test_without_ffmpeg_there_is_a_gif_and_a_remedy(
    scene: Path, trajectory: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.chdir(tmp_path)
    assert movie.draw(scene, trajectory) == Path("results/movies/scene.gif")
    with pytest.raises(InputError, match="needs ffmpeg"):
        movie.draw(scene, trajectory, tmp_path / "run.mp4")


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not here")
def test_with_ffmpeg_there_is_an_mp4(scene: Path, trajectory: Path, tmp_path: Path) -> None:
    target = movie.draw(scene, trajectory, tmp_path / "run.mp4")
    assert target.read_bytes()[4:8] == b"ftyp"


def test_a_scene_of_many_boxes_and_one_of_none_that_moves_are_drawn(tmp_path: Path) -> None:
    scene, run = tmp_path / "scene.in", tmp_path / "trajectory"
    scene.write_text("1\n10000\n5\n1\n0 10 10 0 0\n")
    run.write_text("0 0 10 10 0 0\n1 0 10 10 0 0\n")
    assert movie.draw(scene, run, tmp_path / "still.png").stat().st_size > 0


def test_drawing_leaves_no_window_behind(scene: Path, trajectory: Path, tmp_path: Path) -> None:
    code = "import sys; from analysis.cli import main; code = main(sys.argv[1:]); import matplotlib; "
    code += "assert 'matplotlib.pyplot' not in sys.modules; sys.exit(code)"
    words = ["movie", str(scene), str(trajectory), "--output", str(tmp_path / "run.png")]
    subprocess.run([sys.executable, "-c", code, *words], check=True)
