"""The order of points within blocks: randomised, and balanced over position and neighbour.

The rows come from Williams' design (E. J. Williams, "Experimental designs balanced for the estimation of
residual effects of treatments", Australian Journal of Scientific Research A 2, 1949): over a whole cycle
every point takes every position, and follows every other point, equally often. A row is followed by its
mirror image, which the design contains too, so that already over the blocks 0 and 1, 2 and 3 ... a linear
drift hits all points alike.
"""

import random
from functools import lru_cache


@lru_cache(maxsize=4096)
def orders(points: int, blocks: int, seed: str) -> tuple[tuple[int, ...], ...]:
    """For each block, the order in which the points 0 .. points - 1 are run.

    A prefix of a longer plan: with the same seed, more blocks leave the first ones as they are. `seed` may be
    any text; the same one gives the same orders on every platform.
    """
    generator = random.Random(f"order {seed}")
    names = list(range(points))
    generator.shuffle(names)
    rows: list[tuple[int, ...]] = []
    while len(rows) < blocks:
        # With an even number of points the mirror image of row i is row i + points / 2.
        shifts = list(range(points if points % 2 else max(1, points // 2)))
        generator.shuffle(shifts)
        for shift in shifts:
            row = tuple(names[(number + shift) % points] for number in _zigzag(points))
            pair = [row, row[::-1]]
            generator.shuffle(pair)
            rows.extend(pair)
    return tuple(rows[:blocks])


def _zigzag(points: int) -> list[int]:
    """0, n - 1, 1, n - 2, ...: neighbours differ by every number once."""
    return [number // 2 if number % 2 == 0 else points - 1 - number // 2 for number in range(points)]
