"""What is still to be run of the blocks of an experiment.

What is compared is measured together: a block counts if one session measured all of it. What an earlier one
left unfinished is measured anew, and so is a block in which something failed. Nothing is compared across a
question's named scenes, so that each of them has blocks of its own.
"""

from collections.abc import Collection

from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.results.store import Found
from experiments.run.together import Position


def missing(
    experiment: Experiment, found: Found, block: int, session: str, given_up: Collection[str] = ()
) -> list[Position]:
    """Position and point of what is still to be run in a block, in the block's order.

    `session` is the one under way: what it began it goes on with, and the points `given_up` failed in it. As
    long as a point fails, the blocks of the others are whole without it.
    """
    failed = {point for point, _ in found.failures}
    scenes: dict[str | None, list[Position]] = {}
    for position, point in enumerate(experiment.block(block)):
        if point.id not in given_up:
            scenes.setdefault(point.scene_name, []).append((position, point))
    return sorted(
        (position, point)
        for scene in scenes.values()
        if not _is_whole([point for _, point in scene], found, block, failed)
        for position, point in scene
        if found.sessions.get((point.id, block)) != session
    )


def _is_whole(points: list[Point], found: Found, block: int, failed: Collection[str]) -> bool:
    """Whether one session measured all that does not fail; a failure is tried again where it was seen, unless
    the program is still not built.
    """
    if any((one.id, block) in found.failures and one.program.sha256 is not None for one in points):
        return False
    keys = [(one.id, block) for one in points if one.id not in failed]
    return all(key in found.seconds for key in keys) and len({found.sessions[key] for key in keys}) <= 1
