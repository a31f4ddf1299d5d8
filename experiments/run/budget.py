"""How many blocks each experiment gets, so that the whole study fits in its time."""

from collections.abc import Sequence
from dataclasses import dataclass

RESERVE = 0.1
"""The part of the budget that is left for the report and for estimates that are too low."""


@dataclass(frozen=True)
class Load:
    """What an experiment still costs: seconds a block, seconds once (scenes and checks, less the blocks that
    are done), and its limits.
    """

    name: str
    block_seconds: float
    once_seconds: float
    minimum: int
    wanted: int

    def seconds(self, blocks: int) -> float:
        """The wall time that the experiment still takes to have so many blocks."""
        return self.once_seconds + blocks * self.block_seconds


def allocate(loads: Sequence[Load], budget_seconds: float) -> dict[str, int]:
    """Blocks for each experiment: its minimum whatever the budget, then more while they fit.

    Blocks are added two at a time, since an even number is balanced in position exactly, and to the
    experiment that is furthest from what it wants.
    """
    blocks = {load.name: load.minimum for load in loads}
    left = budget_seconds * (1 - RESERVE) - sum(load.seconds(load.minimum) for load in loads)
    growing = [load for load in loads if load.wanted > load.minimum]
    while growing:
        load = min(growing, key=lambda one: (blocks[one.name] - one.minimum) / (one.wanted - one.minimum))
        more = min(2, load.wanted - blocks[load.name])
        if more == 0 or more * load.block_seconds > left:
            growing.remove(load)
            continue
        blocks[load.name] += more
        left -= more * load.block_seconds
    return blocks
