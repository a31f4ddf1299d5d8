"""What is measured next: one function from what is known of open questions to blocks, in their order.

Blocks of a question between two looks settle nothing, so that it is brought to its next look or gets none.
What disturbs a machine for seconds would hit several successive blocks of one comparison: the blocks of
several questions take turns.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

SHARE = 0.25
"""Of the time left, what the blocks up to the next look may take, if they are of more than one question."""

MOST_SECONDS = 300.0
"""The longest for which that is planned ahead."""


@dataclass(frozen=True)
class Waiting:
    """A question in which something is open: how many blocks it lacks to its next look, what a block takes,
    and what settling the first thing in it costs, blocks that it had beyond its least included; whether that
    look is its first.
    """

    name: str
    lacking: int
    block_seconds: float
    seconds_to_settle: float
    is_first: bool = False

    @property
    def seconds_to_look(self) -> float:
        """What it takes until it can be looked at."""
        return self.lacking * self.block_seconds


def next_blocks(waiting: Sequence[Waiting], seconds_left: float, least_seconds: float) -> dict[str, int]:
    """The questions to be brought to their next looks before anything is looked at again, with the blocks
    that each of them lacks; none if there is time for none.

    First looks come first, the cheapest before the others, then what is settled at the least expense, as far
    as it fits in a share of the time left. A look is worth while from `least_seconds` on.
    """
    most = min(seconds_left, max(least_seconds, min(SHARE * seconds_left, MOST_SECONDS)))
    chosen: dict[str, int] = {}
    used = 0.0
    for one in sorted(waiting, key=lambda one: (not one.is_first, one.seconds_to_settle)):
        if used + one.seconds_to_look <= (most if chosen else seconds_left):
            chosen[one.name] = one.lacking
            used += one.seconds_to_look
    return chosen


def in_turns(blocks: Mapping[str, int]) -> list[str]:
    """A name for each block: those of every name are spread evenly over the whole."""
    places = [
        ((number + 0.5) / count, order, name)
        for order, (name, count) in enumerate(blocks.items())
        for number in range(count)
    ]
    return [name for _, _, name in sorted(places)]
