"""Which points of a block are measured together: side by side in one process, some steps of each in turn.

A machine that changes its speed from one second to the next disturbs those alike that take turns of some
milliseconds, and not those that run one after the other. What turns would distort keeps a process of its own.
Of whole processes those of most programs are sliced: all but one are stopped. Google Benchmarks are not, but
each is many short processes, which alternate in random order; nor are more programs than memory holds.
"""

import os
from collections import Counter
from collections.abc import Sequence

from experiments.plan.plan import Experiment
from experiments.plan.point import PROCESS, Point
from experiments.plan.scenes import Scene
from support.vocabulary import COUNTS, PAUSES

Position = tuple[int, Point]

_SHARE_OF_MEMORY = 0.25
_BYTES_PER_DISC = 400
"""Of the published layout, the largest: a disc 32, its list's header 24, and what the lists hold."""
_BYTES_PER_BOX = 60
"""The header of a box's list, and the memory of the lists that have ever held a disc."""
_PROGRAMS_TOGETHER = 8
"""So many programs of others at once, each of which may take a thirty-second part of the memory."""


def together(experiment: Experiment, block: int, missing: Sequence[Position]) -> list[list[Position]]:
    """The points that are still to be run of one block, in groups that one process measures."""
    if experiment.question.kind == COUNTS:
        return _counted(block, missing)
    if not _may_take_turns(experiment, block):
        return [[one] for one in missing]
    groups: dict[object, list[Position]] = {}
    for position, point in missing:
        groups.setdefault(_process(point), []).append((position, point))
    return [part for group in groups.values() for part in _fitting(experiment, group)]


def is_left_open(point: Point) -> bool:
    """Whether nobody said of a whole process if it is stopped now and then while others run. Who times itself
    never is: it would count the pauses.
    """
    said = point.command is not None and (point.command.turns is not None or point.command.times_itself)
    return point.verb == PROCESS and not point.apart and not said


def is_alike(point: Point) -> bool:
    """Whether a whole process is stopped only if all such are that it is compared with. A question about
    pauses compares both ways.
    """
    return is_left_open(point) and point.kind != PAUSES


def have_room(experiment: Experiment, point: Point) -> bool:
    """Whether all whole processes that are compared with the point, and measured alike, have room in memory
    at once. If not, none of them is stopped.
    """
    beside = [one for one in experiment.points if is_alike(one) and _process(one) == _process(point)]
    return len(beside) < 2 or sum(map(_bytes, beside)) <= _memory()


def _counted(block: int, missing: Sequence[Position]) -> list[list[Position]]:
    """What is only counted follows one another in one process, one in memory at a time, and those of one
    scene next to each other, which is read once. A point whose process does something besides is alone.
    """
    groups: dict[object, list[Position]] = {}
    for position, point in missing:
        alone = point.verb != "bench" or point.besides(block)
        key = point.id if alone else (point.program.path, point.openmp, point.threads)
        groups.setdefault(key, []).append((position, point))
    return [sorted(group, key=lambda one: (str(one[1].scene), one[0])) for group in groups.values()]


def _process(point: Point) -> tuple[object, ...]:
    """Which process it can be in.

    Nothing is compared across a question's named scenes. And as many threads for all: a pool of threads that
    shrinks and grows between turns would be timed too. Whole processes keep their pools to themselves; what
    is compared of them is at the same place of the sweep. Who times itself is never stopped, since it would
    count that as its own time, but alternates with the others as a whole.
    """
    if point.apart:
        return (point.id,)
    if point.verb == PROCESS:
        return point.scene_name, point.x
    return point.scene_name, point.program.path, point.openmp, point.threads


def _may_take_turns(experiment: Experiment, block: int) -> bool:
    """Whether those compared are measured alike: no point of the block does anything but run once, and of one
    scene as many take turns in each process, since a turn among many finds colder caches. Whole processes do
    nothing else.
    """
    points = [point for point in experiment.points if not point.apart]
    if all(point.verb == PROCESS for point in points):
        return experiment.question.turns
    once = all(
        point.verb == "bench" and point.repetitions == 1 and not point.besides(block) for point in points
    )
    processes = Counter(map(_process, points))
    alike = {(process[0], number) for process, number in processes.items()}
    return experiment.question.turns and once and len(alike) == len({point.scene_name for point in points})


def _fitting(experiment: Experiment, group: Sequence[Position]) -> list[list[Position]]:
    """The group in as few parts as the machine's memory allows, since all of a part are in it at once. Of
    whole processes none of which is stopped one is.
    """
    most = _memory()
    all_have_room = have_room(experiment, group[0][1])
    parts: list[list[Position]] = [[]]
    used = 0.0
    for one in group:
        needed = _bytes(one[1]) if all_have_room or not is_alike(one[1]) else 0.0
        if parts[-1] and used + needed > most:
            parts.append([])
            used = 0.0
        parts[-1].append(one)
        used += needed
    return parts


def _memory() -> float:
    """What may be used, in bytes."""
    return _SHARE_OF_MEMORY * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def _bytes(point: Point) -> float:
    """About how much memory a simulation of the point takes; a hard case takes little. What another program
    takes is not known: several have room together.
    """
    scene = point.scene
    if point.command is not None:
        if point.command.times_itself or point.command.turns is False:
            return 0.0  # it is over before the next one begins
        return _memory() / _PROGRAMS_TOGETHER
    if not isinstance(scene, Scene):
        return 0.0
    boxes = max(scene.side / (4 * scene.radius + 1), scene.particles**0.5) ** 2
    return scene.particles * _BYTES_PER_DISC + boxes * _BYTES_PER_BOX
