"""What is measured next: to the next look or not at all, the cheapest first, and in turns."""

import itertools
from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from experiments.run.next_blocks import MOST_SECONDS, Waiting, in_turns, next_blocks

WAITING = st.lists(
    st.builds(Waiting, st.just(""), st.integers(1, 40), st.floats(0.01, 20), st.floats(0, 1000)), max_size=12
).map(lambda several: [Waiting(str(at), *list(vars(one).values())[1:]) for at, one in enumerate(several)])


@given(WAITING, st.floats(-5, 3000), st.floats(0, 60))
def test_what_gets_blocks_comes_to_its_next_look_in_time(
    waiting: list[Waiting], seconds: float, least: float
) -> None:
    chosen = next_blocks(waiting, seconds, least)
    of_name = {one.name: one for one in waiting}
    assert all(of_name[name].lacking == blocks for name, blocks in chosen.items())
    assert sum(of_name[name].seconds_to_look for name in chosen) <= max(seconds, 0) + 1e-6


@given(WAITING, st.floats(0, 3000), st.floats(0, 60))
def test_something_is_measured_as_long_as_anything_fits(
    waiting: list[Waiting], seconds: float, least: float
) -> None:
    fits = [one for one in waiting if one.seconds_to_look <= seconds]
    assert bool(next_blocks(waiting, seconds, least)) == bool(fits)
    if fits:
        first = min(fits, key=lambda one: one.seconds_to_settle)
        assert next(iter(next_blocks(waiting, seconds, least))) == first.name


def test_one_that_does_not_reach_its_look_gives_way_to_one_that_does() -> None:
    far, near = Waiting("far", 20, 1.0, 1.0), Waiting("near", 3, 1.0, 90.0)
    assert next_blocks([far, near], 10.0, 5.0) == {"near": 3}
    assert next_blocks([far, near], 200.0, 5.0) == {"far": 20, "near": 3}


def test_a_share_of_the_time_is_planned_ahead() -> None:
    several = [Waiting(str(number), 5, 1.0, number) for number in range(10)]
    assert list(next_blocks(several, 80.0, 1.0)) == ["0", "1", "2", "3"]
    assert list(next_blocks(several, 80.0, 30.0)) == ["0", "1", "2", "3", "4", "5"], "a look must be worth it"
    assert list(next_blocks(several, 8.0, 1.0)) == ["0"]
    long = [Waiting(str(number), 5, MOST_SECONDS / 10, number) for number in range(10)]
    assert list(next_blocks(long, float("inf"), 1.0)) == ["0", "1"]


@given(st.dictionaries(st.text(max_size=3), st.integers(0, 30), max_size=6))
def test_blocks_are_spread_over_the_whole(blocks: dict[str, int]) -> None:
    order = in_turns(blocks)
    assert Counter(order) == Counter({name: count for name, count in blocks.items() if count})
    for name, count in blocks.items():
        places = [at for at, one in enumerate(order) if one == name]
        gaps = [second - first for first, second in itertools.pairwise(places)]
        assert all(abs(gap - len(order) / count) <= len(blocks) for gap in gaps)


def test_as_many_of_each_alternate() -> None:
    assert in_turns({"a": 3, "b": 3}) == ["a", "b"] * 3
    assert in_turns({"a": 4, "b": 2}) == ["a", "b", "a", "a", "b", "a"]
