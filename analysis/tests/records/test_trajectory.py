import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.records.trajectory import Trajectory, read_box, read_trajectory
from analysis.tests.fuzzing import for_a_while, in_a_file
from support.errors import InputError

GOOD = "0 0 1 2 0.5 0\n0 1 3 4 0 -1e-3\n1 0 1.5 2 0.5 0\n1 1 3 3.999 0 -1e-3\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", ":1: found the end of the file, expected step 0, disc 0"),
        ("0 0 1 2 0.5\n", ":1: found '0 0 1 2 0.5', expected six numbers `step i x y vx vy`"),
        ("0 0 1 2 0.5 zero\n", ":1: found 'zero', expected a finite number"),
        ("0 0 1 2 0.5 nan\n", ":1: found 'nan', expected a finite number"),
        ("0 0 1 2 0.5 1_0\n", ":1: found '1_0', expected a finite number"),
        ("0 0 1 2 0,5 1\n", ":1: found '0,5', expected a finite number"),
        ("0 1 1 2 0.5 1\n", ":1: found '0 1 1 2 0.5 1', expected step 0, disc 0"),
        (GOOD[: GOOD.rindex("1 1")], ":4: found the end of the file, expected disc 1"),
        (GOOD + "3 0 0 0 0 0\n", ":5: found '3 0 0 0 0 0', expected step 2, disc 0"),
        (GOOD + "\n", ":5: found an empty line, expected six numbers"),
        ("0 0 1 2 0.5 1\xff\n", ":1: found '1?', expected a finite number"),
    ],
)
def test_a_bad_line_is_named(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "trajectory"
    path.write_text(text, encoding="latin-1")
    with pytest.raises(InputError) as refused:
        read_trajectory(path)
    assert str(refused.value).startswith(f"{path}{said}")


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    for name, said in (("absent", "No such file"), ("", "Is a directory")):
        with pytest.raises(InputError, match=said):
            read_trajectory(tmp_path / name)


def test_the_box_of_a_scene(tmp_path: Path) -> None:
    path = tmp_path / "scene.in"
    path.write_text("0\n10.5\n1\n25\n")
    assert (read_box(path).side, read_box(path).radius) == (10.5, 1)
    for text, said in (
        ("0\n", ":2: found an empty line, expected the side of the box L"),
        ("0\n10\nx\n", ":3: found 'x', expected the radius r"),
        ("0\n1\n1\n", ":2: found a side of 1 and a radius of 1, expected L >= 2r > 0"),
    ):
        path.write_text(text)
        with pytest.raises(InputError) as refused:
            read_box(path)
        assert str(refused.value) == f"{path}{said}"


finite = st.floats(allow_nan=False, allow_infinity=False)
states = st.integers(1, 4).flatmap(
    lambda discs: st.lists(
        st.lists(st.tuples(finite, finite, finite, finite), min_size=discs, max_size=discs),
        min_size=1,
        max_size=4,
    )
)


@given(states)
def test_what_is_written_is_read_back_to_the_last_bit(states: list[list[tuple[float, ...]]]) -> None:
    text = "".join(
        f"{step} {disc} {' '.join(map(repr, state))}\n"
        for step, discs in enumerate(states)
        for disc, state in enumerate(discs)
    )
    with in_a_file(text.encode()) as path:
        found = read_trajectory(path)
    expected = np.array(states)
    assert np.array_equal(found.positions, expected[..., :2])
    assert np.array_equal(found.velocities, expected[..., 2:])


words = st.sampled_from(
    ["0", "1", "2", "-1", "0.5", "1e400", "nan", "1_0", "x", "\t", "\n", "\r\n", " ", "\0", "é"]
)
near_texts = st.lists(st.one_of(words, st.sampled_from(GOOD.splitlines(keepends=True)))).map(" ".join)
damaged = st.tuples(st.integers(0, len(GOOD)), st.binary(max_size=3), st.integers(0, 3)).map(
    lambda cut: GOOD.encode()[: cut[0]] + cut[1] + GOOD.encode()[cut[0] + cut[2] :]
)
anything = st.one_of(st.binary(), near_texts.map(str.encode), damaged)


def is_read_or_refused_in_one_line(content: bytes) -> None:
    with in_a_file(content) as path:
        try:
            found = read_trajectory(path)
        except InputError as error:
            said = str(error)
        else:
            is_a_trajectory(found)
            return
        assert re.match(rf"{re.escape(str(path))}:\d+: found .*, expected ", said)
        assert said.isprintable()


def is_a_trajectory(found: Trajectory) -> None:
    assert found.positions.shape == found.velocities.shape
    assert found.positions.shape[2] == 2
    assert found.positions.size > 0
    assert np.isfinite(found.positions).all()
    assert np.isfinite(found.velocities).all()


@given(anything)
@settings(max_examples=300)
def test_anything_is_read_or_refused_in_one_line(content: bytes) -> None:
    is_read_or_refused_in_one_line(content)


@pytest.mark.fuzz
def test_anything_for_a_while() -> None:
    for_a_while(given(anything)(is_read_or_refused_in_one_line))
