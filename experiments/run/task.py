"""A point that is to be measured in a block: what is checked of it before, and what its record remembers."""

from dataclasses import dataclass, replace
from functools import cached_property

from experiments.plan.plan import Experiment
from experiments.plan.point import Point, Tags
from experiments.plan.scenes import Scene, SceneFile
from experiments.run.together import have_room, is_alike, is_left_open


@dataclass(frozen=True)
class Task:
    """A point in one block of its experiment; planned are so many `blocks`, and `points` in this one."""

    experiment: Experiment
    point: Point
    block: int
    position: int
    blocks: int
    points: int
    runs: int = 1
    """Timed runs of each point in the process, where several points take turns in it."""

    def tags(self, session: str) -> Tags:
        """Everything that the record remembers of the plan."""
        return {
            **self.point.tags,
            "title": self.experiment.question.title,
            "block": self.block,
            "position": self.position,
            "session": session,
            "order_seed": self.experiment.order_seed,
            "points_planned": self.points,
            "blocks_planned": self.blocks,
        }

    @cached_property
    def checked(self) -> Point:
        """What of the point's variant or program is checked before it is timed."""
        return representative(self.experiment, self.point)

    @property
    def scope(self) -> str:
        """What the point's record says of how it was checked; empty if it was not."""
        command, scene = self.checked.command, self.checked.scene
        if command is None:
            return "every-step"
        if command.writes_trajectory:
            return "its own output"
        if not command.trajectory:
            return ""
        if command.another:
            return f"trajectory of another command: {command.another}"
        steps = f", steps 0 to {scene.steps}" if isinstance(scene, Scene) else ""
        return f"trajectory of its own program{steps}"

    @cached_property
    def is_crowded(self) -> bool:
        """Whether it takes no turns only because more are compared than memory holds at once."""
        may_turn = self.experiment.question.turns and is_alike(self.point)
        return may_turn and not have_room(self.experiment, self.point)

    @property
    def turns(self) -> bool | None:
        """Whether a whole process takes turns with others, if that is not left to be found out."""
        if not self.experiment.question.turns or self.point.apart or self.is_crowded:
            return False
        if is_left_open(self.point):
            return None
        return self.point.command is not None and bool(self.point.command.turns)

    @property
    def is_alike(self) -> bool:
        """Whether it is stopped only if all such are that it is measured with."""
        return self.turns is None and is_alike(self.point)


Ready = tuple[Task, SceneFile | None]
"""A task whose point may be measured, and its scene's file."""


def representative(experiment: Experiment, point: Point) -> Point:
    """What the variant is checked on: the beginning of the first scene with that variant and scene's name.

    Checking a step costs as much as several, so neither every scene of a sweep nor every step is checked; the
    program checks the last step of each timed run besides.
    """
    first = next(other for other in experiment.points if _checked_alike(other) == _checked_alike(point))
    return replace(first, scene=first.scene.beginning) if isinstance(first.scene, Scene) else first


def _checked_alike(point: Point) -> tuple[object, ...]:
    """One check is enough for all of which this is the same; of other programs the series, since their words
    may make them different things.
    """
    own = point.series if point.command is not None else None
    return point.program, point.variant, own, point.scene_name
