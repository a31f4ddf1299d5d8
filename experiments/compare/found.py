"""What one call has measured and found, ready to be told."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from experiments.compare.answer import Answer, Difference
from experiments.compare.blocks import Key, Runs
from experiments.compare.options import Asked


@dataclass(frozen=True)
class Look:
    """What was known after so many blocks and seconds: the seconds at which all would be settled, None where
    that was not in sight.
    """

    blocks: int
    seconds: float
    foretold_seconds: float | None


@dataclass(frozen=True)
class Found:
    """Everything that a result is told from. `before` of the blocks are of earlier calls; the seconds are
    this call's.
    """

    asked: Asked
    answer: Answer
    runs: Mapping[Key, Runs]
    blocks: int
    before: int
    seconds: float
    seconds_each: float
    """What a block of this call took."""
    machine: str
    others: float | None = None
    """How many processors other programs kept busy meanwhile, None where the system does not tell."""
    looks: tuple[Look, ...] = ()
    by_wall: tuple[Difference, ...] = ()
    """All differences of all time that passes, where that is not judged."""
    remarks: tuple[str, ...] = field(default=())
    """Lines on how it was measured."""
