"""Reads what `carom run --trajectory` writes, and the size of the box from the scene file beside it."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from analysis.support.values import Floats
from support.errors import InputError

COLUMNS = "step i x y vx vy"


@dataclass(frozen=True)
class Box:
    """What a scene file says of its box, the side L and the discs' radius r, and of the number of steps S."""

    side: float
    radius: float
    steps: int = 0


@dataclass(frozen=True)
class Trajectory:
    """The state at each unit of time, from 0: `positions` and `velocities` as states x discs x 2."""

    positions: Floats
    velocities: Floats

    @property
    def steps(self) -> int:
        """How many steps were made from the first state to the last."""
        return len(self.positions) - 1


def read_box(path: Path) -> Box:
    """Read the first lines of a scene file, N, L, r and S. Raises InputError with the file and the line."""
    lines = _lines(path)
    next(lines, "")
    side, radius = (
        _number(next(lines, ""), f"{path}:{line}", what)
        for line, what in ((2, "the side of the box L"), (3, "the radius r"))
    )
    if not (radius > 0 and side >= 2 * radius):
        raise InputError(
            f"{path}:2: found a side of {side:g} and a radius of {radius:g}, expected L >= 2r > 0"
        )
    steps = next(lines, "").strip()
    if not (steps.isascii() and steps.isdigit() and len(steps) < 19):
        raise InputError(f"{path}:4: found {_shown(steps)}, expected the number of steps S")
    return Box(side, radius, int(steps))


def read_trajectory(path: Path) -> Trajectory:
    """Read a trajectory: for each step from 0, each disc from 0, a line `step i x y vx vy`.

    Raises InputError with the file, the line, what was found and what was expected.
    """
    states: list[tuple[float, ...]] = []
    count: int | None = None
    for number, line in enumerate(_lines(path), 1):
        where = f"{path}:{number}"
        fields = line.split()
        if len(fields) != 6:
            raise InputError(f"{where}: found {_shown(line)}, expected six numbers `{COLUMNS}`")
        if count is None and fields[:2] == ["1", "0"]:
            count = number - 1
        step, disc = (0, number - 1) if count is None else divmod(number - 1, max(1, count))
        if fields[:2] != [str(step), str(disc)]:
            raise InputError(f"{where}: found {_shown(line)}, expected step {step}, disc {disc}")
        states.append(_numbers(line, fields[2:], where))
    discs = count or len(states)
    if not states or len(states) % discs:
        missing = f"disc {len(states) % discs}" if states else "step 0, disc 0"
        raise InputError(f"{path}:{len(states) + 1}: found the end of the file, expected {missing}")
    table = np.array(states).reshape(-1, discs, 4)
    return Trajectory(table[..., :2], table[..., 2:])


def _lines(path: Path) -> Iterator[str]:
    try:
        # A byte that is no ASCII text becomes a letter that no number has, and is told with its line.
        with path.open(encoding="ascii", errors="surrogateescape", newline="\n") as file:
            yield from file
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error


def _numbers(line: str, fields: Sequence[str], where: str) -> tuple[float, ...]:
    """Return the numbers; one by one only where together they are none, which tells what is wrong."""
    try:
        numbers = tuple(map(float, fields))
    except ValueError:
        numbers = (math.nan,)
    if "_" in line or not math.isfinite(sum(numbers)):
        return tuple(_number(field, where, "a finite number") for field in fields)
    return numbers


def _number(text: str, where: str, expected: str) -> float:
    """Return the number; what Python takes besides (underscores, nan, inf) is none."""
    try:
        number = math.nan if "_" in text else float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{where}: found {_shown(text)}, expected {expected}")
    return number


def _shown(text: str) -> str:
    """Return the beginning of a text as one line of printable letters."""
    plain = "".join(letter if " " <= letter <= "~" else "?" for letter in text.rstrip("\n"))
    if not plain:
        return "an empty line"
    return f"'{plain}'" if len(plain) <= 40 else f"'{plain[:40]}...'"
