"""What the analysis says of the commands so far."""

import importlib
import time
from collections.abc import Collection
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from experiments.support.interrupts import signals_held
from support.vocabulary import WALL


@dataclass(frozen=True)
class Difference:
    """A command against the reference: the ratio of their times with its interval, None where it has no end;
    the blocks that it rests on, and those `needed` to settle it, None where that is not in sight.
    """

    name: str
    ratio: float
    low: float | None
    high: float | None
    verdict: str
    blocks: int
    differs: bool
    low_of_all: float | None = None
    """The lower end of the interval that holds together with those of all others, in all calls."""
    totals: float | None = None
    """The ratio of all their time, in which rare slow runs count in full; None where it is not known."""
    start: float | None = None
    """By how much the ratio differs from one block to the next, beyond what its runs explain: a standard
    deviation of the logarithm."""
    round: float | None = None
    """The same from one run to the next."""
    case: int = 0
    needed: int | None = None

    @property
    def is_settled(self) -> bool:
        """Whether there is a verdict."""
        return self.verdict != "inconclusive"


@dataclass(frozen=True)
class Place:
    """The places that a command may have among all; those with a letter in common cannot be told apart."""

    name: str
    first: int
    last: int
    bracket: str


@dataclass(frozen=True)
class Answer:
    """All differences, those of the reference from itself, the places of many commands, and the number of
    blocks of the next look.
    """

    commands: tuple[Difference, ...] = ()
    controls: tuple[Difference, ...] = ()
    places: tuple[Place, ...] = ()
    effects: tuple[Difference, ...] = ()
    """What the values of lists change, by themselves and together."""
    next: int = 0
    looked_at: int = 0
    clock: str = WALL
    """Which time is judged (`support.vocabulary`)."""

    def without(self, left_out: Collection[str]) -> "Answer":
        """What it says of all others than these commands, or numbers of cases."""

        def kept(rows: tuple[Difference, ...]) -> tuple[Difference, ...]:
            return tuple(one for one in rows if not {one.name, str(one.case)} & {*left_out})

        places = tuple(one for one in self.places if one.name not in left_out)
        return replace(self, commands=kept(self.commands), controls=kept(self.controls), places=places)

    @property
    def is_settled(self) -> bool:
        """Whether there is nothing left to be settled."""
        return bool(self.commands) and all(one.is_settled for one in self.commands)

    def is_slower(self, margin: float) -> bool:
        """Whether any is established to be slower by more than the margin, of however many."""
        return any(one.low_of_all is not None and one.low_of_all > 1 + margin for one in self.commands)

    def is_not_slower(self, margin: float) -> bool:
        """Whether each is established not to be slower by more than the margin, which takes fewer blocks than
        to know that they are equivalent.
        """
        return bool(self.commands) and all(
            one.high is not None and one.high < 1 + margin for one in self.commands
        )

    def is_enough(self, margin: float, *, one_sided: bool) -> bool:
        """Whether what is asked is known: a verdict on each; or only whether one is slower by more than the
        margin, or none is.
        """
        if one_sided:
            return self.is_not_slower(margin) or self.is_slower(margin)
        return self.is_settled

    @property
    def is_withdrawn(self) -> bool:
        """Whether the reference differs from itself, so that no verdict stands."""
        return any(one.differs for one in self.controls)

    @property
    def needed(self) -> int | None:
        """The blocks that settle all of it; None where that is not in sight."""
        of_open = [one.needed for one in self.commands if not one.is_settled]
        known = [one for one in of_open if one is not None]
        return max(known, default=None) if len(known) == len(of_open) else None


def load() -> float:
    """Load what judges, before it is asked; returns the seconds that this took."""
    began = time.monotonic()
    with signals_held():
        importlib.import_module("analysis.commands.programs_compared")
    return time.monotonic() - began


def ask(results: Path, many: int = 1, clock: str = WALL) -> Answer:
    """Judge what a folder of results holds, `many` being the calls that share the error of a gate. Raises
    InputError.
    """
    from analysis.commands.programs_compared import programs_compared

    told = programs_compared(results, many, clock)
    rows, controls, effects = (
        tuple(map(_difference, told[key])) for key in ("commands", "controls", "effects")
    )
    places = tuple(Place(one["series"], one["first"], one["last"], one["bracket"]) for one in told["places"])
    blocks = max((one.blocks for one in rows), default=0)
    return Answer(rows, controls, places, effects, told["next"], blocks, clock)


def _difference(row: dict[str, Any]) -> Difference:
    told = {one.name: row[one.name] for one in fields(Difference) if one.name in row}
    return Difference(name=row["series"], case=row["x"], **told)
