"""Which blocks of an experiment count, and what is still to be run of each.

What is compared is measured together: a block counts if one session measured all of it. One that was begun by
an earlier session and lacks something (a program was changed, a series is new, a run was killed) would be
finished in vain. It is left as it is, and one more block takes its place. Nothing is compared across a
question's named scenes, so that each of them has blocks of its own.
"""

from collections import Counter
from collections.abc import Collection
from functools import cached_property
from itertools import count, islice

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Found, Key
from experiments.run.runner import is_drawn

Place = tuple[str, int]
"""The name of a scene and the number of a block."""


class WholeBlocks:
    """The blocks of one experiment, as its records stand."""

    def __init__(
        self,
        experiment: Experiment,
        given: int,
        found: Found,
        session: str,
        given_up: Collection[str] = (),
        busy: Collection[int] = (),
    ) -> None:
        """So many blocks are `given`. `session` is the one under way: what it began it goes on with, and the
        points `given_up` failed in it. The blocks that are `busy` somebody else is measuring: they count,
        whatever they hold.

        A point that failed in an earlier session is left out of the account until it has been tried again,
        which is done where it failed: as long as it fails, the blocks of the others are whole without it.
        """
        self._experiment = experiment
        self._given = given
        self._found = found
        self._given_up = frozenset(given_up)
        # No block that counts lies beyond that, whatever a file in the folder is called.
        most = given + len({block for _, block in found.seconds})
        self._failed = {key for key in found.failures if key[1] < most}
        self._left_out = self._given_up | {point for point, _ in self._failed}
        self._busy = frozenset(busy)
        self._scenes: dict[str, list[Point]] = {}
        for point in experiment.points:
            self._scenes.setdefault(_scene(point), []).append(point)
        scene_of = {point.id: _scene(point) for point in experiment.points}
        self._begun = {(scene_of[point], block) for point, block in found.seconds if point in scene_of}
        # What an earlier session measured some of.
        earlier = (key for key, by in found.sessions.items() if by != session)
        self._old = {(scene_of[point], block) for point, block in earlier}

    @cached_property
    def numbers(self) -> dict[str, list[int]]:
        """The numbers of the blocks that count, by scene: as many as were given."""
        return {
            scene: list(islice((block for block in count() if self._counts((scene, block))), self._given))
            for scene in self._scenes
        }

    @cached_property
    def keys(self) -> list[Key]:
        """Point id and block of every process of these blocks."""
        return [
            (point.id, block)
            for scene, points in self._scenes.items()
            for point in points
            for block in self.numbers[scene]
        ]

    @cached_property
    def broken(self) -> list[Place]:
        """The blocks that do not count, of those that hold a record."""
        return sorted(place for place in self._begun if not self._counts(place))

    @property
    def whole(self) -> int:
        """How many blocks that hold a record count, of the scene that has the most."""
        return max(Counter(scene for scene, _ in self._begun - {*self.broken}).values(), default=0)

    def end(self, most: int | None = None) -> int:
        """One more than the number of the last block in which something may be missing; of the first so many
        alone.
        """
        last = [block for numbers in self.numbers.values() for block in numbers[:most]]
        again = [block for point, block in self._failed if point not in self._given_up]
        return 1 + max([*last, *again], default=-1)

    def ordinal(self, block: int) -> int:
        """Which of those that count the block is, from 1 on; its own number if it is none."""
        places = [numbers.index(block) for numbers in self.numbers.values() if block in numbers]
        return 1 + max(places, default=block)

    def size(self, block: int) -> int:
        """How many points the block has, of the scenes of which it counts."""
        return sum(len(self._scenes[scene]) for scene in self._counting(block))

    @cached_property
    def lacking(self) -> dict[int, list[tuple[int, Point]]]:
        """The blocks in which something is still to be run, and what is `missing` of each."""
        return {block: missing for block in range(self.end()) if (missing := self.missing(block))}

    def missing(self, block: int) -> list[tuple[int, Point]]:
        """Position and point of what is still to be run in one block, in the block's order."""
        return self._missing(block, self._counting(block))

    def missing_if_given(self, block: int) -> list[tuple[int, Point]]:
        """The same of a block that somebody was told to measure, whether or not it counts."""
        return self._missing(block, self._scenes)

    def next(self, most: int | None = None) -> int | None:
        """The first block in which something is missing, or of the first so many alone; None if none is."""
        block = next(iter(self.lacking), None)
        return block if block is not None and block < self.end(most) else None

    def lost(self) -> list[str]:
        """The series of which blocks that do not count lack a record made with the rest."""
        return list(dict.fromkeys(point.series for place in self.broken for point in self._lost(place)))

    def _counting(self, block: int) -> list[str]:
        """The scenes of which a block counts."""
        return [scene for scene, numbers in self.numbers.items() if block in numbers]

    def _missing(self, block: int, counting: Collection[str]) -> list[tuple[int, Point]]:
        old = {scene for scene, at in self._old if at == block}
        open_ = {scene for scene in counting if block in self._busy or scene not in old}
        if not open_ and block > 0 and all(at != block for _, at in self._failed):
            return []  # what is done in the first block alone is done there all the same
        return [
            (position, point)
            for position, point in enumerate(self._experiment.block(block))
            if (point.id, block) not in self._found.seconds and point.id not in self._given_up
            if _scene(point) in open_
            or (point.id, block) in self._failed
            or (_scene(point) in old and _does_more(point, block))
        ]

    def _counts(self, place: Place) -> bool:
        """Whether the block is of one session, or still can be."""
        scene, block = place
        if block in self._busy or place not in self._old:
            return True
        asked = [point.id for point in self._scenes[scene] if point.id not in self._left_out]
        sessions = {self._found.sessions.get((point, block)) for point in asked}
        return len(sessions) <= 1 and None not in sessions

    def _lost(self, place: Place) -> list[Point]:
        """What a block lacks and did not fail."""
        scene, block = place
        hopeful = (point for point in self._scenes[scene] if point.id not in self._left_out)
        return [point for point in hopeful if (point.id, block) not in self._found.seconds]


def _scene(point: Point) -> str:
    return point.scene_name or ""


def _does_more(point: Point, block: int) -> bool:
    """Whether the process of that block does something besides that no other one does."""
    return bool(point.besides(block)) or is_drawn(point, block)
