"""How long a point takes: the median of what was measured; until then a guess by the size of its scene.

A first block of each question overrules the guess. So the constants are round: too high costs a few blocks,
too low a little more than the budget.
"""

import statistics
from collections.abc import Mapping, Sequence

from experiments.plan.point import PROCESS, Point
from experiments.plan.scenes import Scene
from experiments.run.runner import ProcessResult
from support.vocabulary import COUNTS

_SECONDS_PER_DISC, _SECONDS_BESIDE = 1.5e-7, 0.01
"""Of a step, and of a process that reads no discs: about what two threads of the published variant take."""
_SECONDS_PER_DISC_READ = 7e-7
_RUNS_OF_A_PROFILE = 3
_HARD_CASE = 0.1
"""Seconds of one on average: most take none, and one takes three."""
_UNKNOWN_PROGRAM = 1.0
"""Seconds of somebody else's program until it has run once: a guess."""

SECONDS_PER_PROCESS, _MOST_BESIDE = 0.03, 0.3
"""What a process takes beside its own account of its time, until that was seen, and at most: the first one of
a variant comes with its check.
"""

IN_THE_CLOCK = 3.0
"""Seconds of timed runs for each second that a process takes besides. The rounds of turns are the data, and a
process is one draw of where its memory lies: with turns of a few steps its ratio is hardly any better from
some hundred rounds on."""

MOST_RUNS = 30
"""In a process: more would tell of one process alone."""

FIRST_RUNS = 3
"""At most in a first block, before which what a process takes besides is a guess."""

MOST_SECONDS = 3.0
"""Of the runs of a process, unless one lasts longer: a study looks at its time between processes."""

Measured = tuple[float, Sequence[float]]
"""Seconds of a whole process, and of its timed runs."""


class Costs:
    """Estimates in seconds of wall time."""

    def __init__(self, measured: Mapping[str, Sequence[Measured]] | None = None) -> None:
        """`measured` has by point what its processes took, by their own account."""
        self._measured = {
            point: [(seconds + SECONDS_PER_PROCESS, runs) for seconds, runs in processes]
            for point, processes in (measured or {}).items()
        }
        self._ratios: dict[str, float] = {}
        self._correction = 1.0
        """Measured over foretold, in the middle of all points of this session."""

    def point(self, point: Point, runs: int | None = None) -> float:
        """One process of a point, warm-up included; with so many timed runs, or as many as it has had."""
        if point.program.sha256 is None:
            return 0.0
        if runs is not None:
            return self.fixed(point) + runs * self.run(point)
        if measured := self._measured.get(point.id):
            return statistics.median(seconds for seconds, _ in measured)
        return self._foretold(point) * self._correction + SECONDS_PER_PROCESS

    def run(self, point: Point) -> float:
        """One timed run of a point."""
        if times := [time for _, runs in self._measured.get(point.id, ()) for time in runs]:
            return statistics.median(times)
        return self._foretold_run(point) * self._correction

    def fixed(self, point: Point) -> float:
        """What a process of a point takes without its timed runs."""
        if measured := self._measured.get(point.id):
            # The least counts, since a first process comes with its check.
            return min(max(0.0, seconds - sum(runs)) for seconds, runs in measured)
        return max(0.0, self.point(point) - point.repetitions * self.run(point))

    def runs(self, group: Sequence[Point]) -> int:
        """How many timed runs the next process of these points makes, by what is known of their times."""
        if len(group) < 2 or group[0].verb == PROCESS or group[0].kind == COUNTS:
            return 1
        runs = choose_runs(sum(map(self.fixed, group)), sum(map(self.run, group)))
        return runs if all(one.id in self._measured for one in group) else min(runs, FIRST_RUNS)

    def learn(self, points: Sequence[Point], ended: Sequence[ProcessResult], seconds: float) -> None:
        """Processes of a block ended, measured in so many seconds in all. What more runs take than were
        foretold says nothing of what was foretold.
        """
        own = [one.seconds for one in ended if one.seconds is not None]
        beside = min(_MOST_BESIDE, max(0.0, seconds - sum(own)) / max(1, len(own)))
        for point, one in zip(points, ended, strict=True):
            if one.seconds is not None:
                is_whole = len(own) == len(ended)
                spent = one.seconds + (beside if is_whole else SECONDS_PER_PROCESS)
                self._measured.setdefault(point.id, []).append((spent, one.runs))
                as_foretold = one.seconds - sum(one.runs[point.repetitions :])
                self._ratios[point.id] = as_foretold / self._foretold(point)
        if self._ratios:
            self._correction = statistics.median(self._ratios.values())

    def _foretold(self, point: Point) -> float:
        runs = point.warm_up + (_RUNS_OF_A_PROFILE if point.verb == "profile" else point.repetitions)
        seconds = runs * self._foretold_run(point)
        if point.command is None:
            seconds += _SECONDS_BESIDE
            if isinstance(point.scene, Scene):
                seconds += point.scene.particles * _SECONDS_PER_DISC_READ
        return seconds

    def _foretold_run(self, point: Point) -> float:
        """One run from the first step to the last."""
        if point.command is not None:
            return _UNKNOWN_PROGRAM
        if not isinstance(point.scene, Scene):
            return _HARD_CASE
        return _SECONDS_PER_DISC * point.scene.steps * point.substeps * _work(point.scene)


def choose_runs(fixed_seconds: float, run_seconds: float) -> int:
    """How many runs a process makes, so that most of its time is in the clock; one of them takes so many
    seconds for all contenders together.
    """
    one = max(run_seconds, 1e-9)
    return max(1, round(min(IN_THE_CLOCK * fixed_seconds / one, MOST_RUNS, MOST_SECONDS / one)))


def _work(scene: Scene) -> float:
    """A step's work in discs: what is crowded is resolved again and again (at 0.71, 0.80 and 0.87 of the area
    0.1, 0.9 and 3.4 more; measured 0.2, 0.6 and 3.4 of the published variant), and empty cells are looked at.
    """
    cells = (scene.side / (4 * scene.radius + 1)) ** 2
    return scene.particles * (1 + 30 * scene.area_fraction**16) + 0.1 * cells
