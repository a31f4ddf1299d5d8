"""The order within blocks: complete, balanced, and the same for the same seed."""

from collections import Counter
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from experiments.plan.blocks import orders

POINTS = st.integers(1, 25)
BLOCKS = st.integers(1, 30)
SEEDS = st.text(max_size=10)


@given(POINTS, BLOCKS, SEEDS)
def test_every_point_appears_once_in_every_block(points: int, blocks: int, seed: str) -> None:
    order = orders(points, blocks, seed)
    assert len(order) == blocks
    assert all(sorted(block) == list(range(points)) for block in order)


@given(POINTS, st.integers(1, 15), SEEDS)
def test_mean_positions_are_equal_over_any_even_number_of_blocks(points: int, pairs: int, seed: str) -> None:
    order = orders(points, 2 * pairs, seed)
    sums = {point: sum(block.index(point) for block in order) for point in range(points)}
    assert set(sums.values()) == {pairs * (points - 1)}


@given(POINTS, SEEDS)
def test_over_a_cycle_positions_and_neighbours_are_balanced(points: int, seed: str) -> None:
    order = orders(points, 2 * points if points % 2 else points, seed)
    positions = Counter((point, place) for block in order for place, point in enumerate(block))
    neighbours = Counter(pair for block in order for pair in pairwise(block))
    assert len(positions) == points**2
    assert len(set(positions.values())) == 1
    assert len(neighbours) == points * (points - 1)
    assert len(set(neighbours.values())) <= 1


@given(POINTS, BLOCKS, BLOCKS, SEEDS)
def test_more_blocks_leave_the_first_ones_alone(points: int, few: int, more: int, seed: str) -> None:
    assert orders(points, few + more, seed)[:few] == orders(points, few, seed)


def test_the_order_is_random_but_fixed_by_the_seed() -> None:
    assert orders(8, 4, "1 threads") == orders(8, 4, "1 threads")
    assert len({orders(8, 4, f"{seed} threads") for seed in range(20)}) == 20
    first = Counter(orders(4, 1, str(seed))[0][0] for seed in range(400))
    assert min(first.values()) > 60, "every point is first about as often"
