"""Which blocks of an experiment count, and what is still to be run of each.

What is compared is measured together: a block counts if one session measured all of it. One that was begun by
an earlier session and lacks something (a program was changed, a series is new, a run was killed) would be
finished in vain. It is left as it is, and one more block takes its place. Nothing is compared across a
question's named scenes, so that each of them has blocks of its own.
"""

from collections.abc import Collection
from functools import cached_property
from itertools import count, islice

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Found, Key
from experiments.run.given import Given
from experiments.run.runner import is_drawn

Place = tuple[str, int]
"""The name of a scene and the number of a block."""


class WholeBlocks:
    """The blocks of one experiment, as its records stand."""

    def __init__(
        self,
        experiment: Experiment,
        given: Given,
        found: Found,
        session: str,
        given_up: Collection[str] = (),
        busy: Collection[int] = (),
    ) -> None:
        """`session` is the one under way: what it began it goes on with. `given_up` are the points that
        failed in it. The blocks that are `busy` somebody else is measuring: they count, whatever they hold.

        A point that failed in an earlier session is left out of the account until it has been tried again,
        which is done where it failed: as long as it fails, the blocks of the others are whole without it.
        """
        self._experiment = experiment
        self._given = given
        self._found = found
        self._session = session
        self._given_up = frozenset(given_up)
        # No block that counts lies beyond that, whatever a file in the folder is called.
        most = given.blocks + len({block for _, block in found.seconds})
        self._failed = {key for key in found.failures if key[1] < most}
        self._left_out = self._given_up | {point for point, _ in self._failed}
        self._busy = frozenset(busy)
        self._scenes: dict[str, list[Point]] = {}
        for point in experiment.points:
            self._scenes.setdefault(_scene(point), []).append(point)

    @cached_property
    def numbers(self) -> dict[str, list[int]]:
        """The numbers of the blocks that count, by scene: as many as were given."""
        return {
            scene: list(
                islice((block for block in count() if self._counts((scene, block))), self._given.blocks)
            )
            for scene in self._scenes
        }

    @cached_property
    def _counting(self) -> dict[int, list[str]]:
        """The scenes of which a block counts, by its number."""
        scenes: dict[int, list[str]] = {}
        for scene, numbers in self.numbers.items():
            for block in numbers:
                scenes.setdefault(block, []).append(scene)
        return scenes

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
        places = {(scene, block) for scene, points in self._scenes.items() for block in self._begun(points)}
        return sorted(place for place in places if not self._counts(place))

    @property
    def whole(self) -> int:
        """How many blocks that hold a record count, of the scene that has the most."""
        return max(
            sum(self._counts((scene, block)) for block in self._begun(points))
            for scene, points in self._scenes.items()
        )

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
        return sum(len(self._scenes[scene]) for scene in self._counting.get(block, ()))

    def missing(self, block: int) -> list[tuple[int, Point]]:
        """Position and point of what is still to be run in one block, in the block's order."""
        return self._missing(block, self._counting.get(block, ()))

    def following(self, block: int, most: int | None = None) -> int | None:
        """The next block after this one in which something is missing, and from the first on after the last;
        None if nothing is. What had failed and now does not lets an earlier block count no more, so that one
        between may count in its place.
        """
        end = self.end(most)
        after = min(block + 1, end)
        return next((one for one in (*range(after, end), *range(after)) if self.missing(one)), None)

    def missing_if_given(self, block: int) -> list[tuple[int, Point]]:
        """The same of a block that somebody was told to measure, whether or not it counts."""
        return self._missing(block, list(self._scenes))

    def cut_off(self, block: int) -> bool:
        """Whether the block was begun, of some scene, and lacks what did not fail."""
        return any(place[1] == block and self._lacking(place) for place in self.broken)

    def lost(self) -> list[str]:
        """The series of which blocks that do not count lack a record made with the rest."""
        return list(dict.fromkeys(point.series for place in self.broken for point in self._lacking(place)))

    def _missing(self, block: int, counting: Collection[str]) -> list[tuple[int, Point]]:
        if not self._may_lack(block, counting):
            return []
        return [
            (position, point)
            for position, point in enumerate(self._experiment.block(block))
            if self._is_missing(point, block, counting)
        ]

    def _may_lack(self, block: int, counting: Collection[str]) -> bool:
        """Whether a look at each of its points is worth while."""
        return bool(counting) or block == 0 or any(block == at for _, at in self._failed)

    def _is_missing(self, point: Point, block: int, counting: Collection[str]) -> bool:
        key, place = (point.id, block), (_scene(point), block)
        if key in self._found.seconds or point.id in self._given_up:
            return False
        if place[0] in counting and (block in self._busy or not self._is_old(place)):
            return True
        # What is done in the first block alone is done there all the same.
        return key in self._failed or (self._is_old(place) and _does_more(point, block))

    def _counts(self, place: Place) -> bool:
        """Whether the block is of one session, or still can be."""
        if place[1] in self._busy or not self._is_old(place):
            return True
        asked = [point for point in self._scenes[place[0]] if point.id not in self._left_out]
        sessions = {self._found.sessions.get((point.id, place[1])) for point in asked}
        return len(sessions) <= 1 and None not in sessions

    def _lacking(self, place: Place) -> list[Point]:
        points = self._scenes[place[0]]
        return [
            point
            for point in points
            if point.id not in self._left_out and (point.id, place[1]) not in self._found.seconds
        ]

    def _is_old(self, place: Place) -> bool:
        """Whether an earlier session measured some of it."""
        return place in self._old

    @cached_property
    def _old(self) -> set[Place]:
        scenes = {point.id: _scene(point) for point in self._experiment.points}
        return {
            (scenes[point], block)
            for (point, block), session in self._found.sessions.items()
            if session != self._session
        }

    def _begun(self, points: Collection[Point]) -> set[int]:
        ids = {point.id for point in points}
        return {block for point, block in self._found.seconds if point in ids}


def _scene(point: Point) -> str:
    return point.scene_name or ""


def _does_more(point: Point, block: int) -> bool:
    """Whether the process of that block does something besides that no other one does."""
    return bool(point.besides(block)) or is_drawn(point, block)
