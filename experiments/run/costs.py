"""How long a point takes: from its own records, else from a probe of its variant and its scene's size.

What is foretold before anything is measured a first block of each question overrules. So the constants are
round: too high costs a few blocks, too low a little more than the budget.
"""

import json
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from experiments.plan.point import Point
from experiments.plan.scenes import AnyScene, HardCase, Scene
from experiments.run.host_lock import run_alone
from experiments.run.runner import ProcessResult
from support.files import read_json

PROBE = Scene(particles=10000, side=3162, radius=16, steps=10, min_velocity=2, max_velocity=5)

_SECONDS_PER_DISC_READ = 7e-7
"""Generating takes about twice as long."""
_SECONDS_OF_HARD_CASES = {"drift": 3.0}
_SECONDS_OF_ANOTHER_HARD_CASE = 0.01
_RUNS_BESIDES = 3
"""Runs of the steps in a profile, a check, or what measures errors."""
_SLOWED_BY_CACHEGRIND = 60
"""Between the 20 and the 100 times of Valgrind's manual."""
_UNKNOWN_PROGRAM = 1.0
"""Seconds of somebody else's program until it has run once: a guess."""

_PROBED = 3
"""Runs of a probe, of which the least counts: enough for one without a disturbance, and over in 0.1 s."""
_STARTING = 0.02
"""Seconds in which a process starts and ends, which no probe among others tells."""
SECONDS_PER_PROCESS, _MOST_BESIDE = 0.03, 0.3
"""What a process takes beside its own account of its time, until that was seen, and at most."""


@dataclass(frozen=True)
class Probe:
    """What one process of a variant took on the probe scene: seconds a step, and seconds beside the steps."""

    step: float
    process: float


_UNPROBED = Probe(0.01, 0.05)
"""Of a variant whose probe failed: several times what the published one takes."""


class Costs:
    """Estimates in seconds of wall time."""

    def __init__(
        self, probes: Mapping[str, Probe], measured: Mapping[str, Sequence[tuple[float, Sequence[float]]]]
    ) -> None:
        """`measured` has, by point, the seconds of each whole process and of its timed runs."""
        self._probes = dict(probes)
        self._measured = {point: list(processes) for point, processes in measured.items()}
        self._beside: dict[str, float] = {}
        self._ratios: dict[str, list[float]] = {}
        self._corrections: dict[str, float] = {}

    def point(self, point: Point, runs: int | None = None) -> float:
        """One process of a point, warm-up included; with so many timed runs, or as many as it has had."""
        if point.program.sha256 is None:
            return 0.0
        if runs is not None:
            return self.fixed(point) + runs * self.run(point)
        if measured := self._measured.get(point.id):
            return statistics.median(seconds for seconds, _ in measured) + self._beside_of(point)
        return self._modelled(point) * self._correction(point) + self._beside_of(point)

    def run(self, point: Point) -> float:
        """One timed run of a point."""
        if times := [time for _, runs in self._measured.get(point.id, ()) for time in runs]:
            return statistics.median(times)
        return self._modelled_run(point) * self._correction(point)

    def fixed(self, point: Point) -> float:
        """What a process of a point takes without its timed runs."""
        if measured := self._measured.get(point.id):
            # The least counts, since a first process comes with its check.
            spent = min(max(0.0, seconds - sum(runs)) for seconds, runs in measured)
            return spent + self._beside_of(point)
        return max(0.0, self.point(point) - point.repetitions * self.run(point))

    def check(self, point: Point) -> float:
        """The verification of every step of the point's variant on its scene."""
        if point.command is not None:
            return _UNKNOWN_PROGRAM if point.is_checked else 0.0
        return self._start(point) + _RUNS_BESIDES * self._modelled_run(point)

    def besides(self, point: Point) -> float:
        """What one of the point's processes does besides: measuring errors, counting under cachegrind."""
        run, scene = self._modelled_run(point), point.scene
        seconds = _RUNS_BESIDES * run if point.errors else 0.0
        if point.simulated:
            counted = min(point.simulated / scene.steps, 1.0) if isinstance(scene, Scene) else 1.0
            seconds += _SLOWED_BY_CACHEGRIND * (run * counted + self.scene(scene))
        return seconds

    def scene(self, scene: AnyScene) -> float:
        """Generating a scene."""
        return 2 * _reading(scene)

    def has_measured(self, point: Point) -> bool:
        """Whether a process of it has ended."""
        return point.id in self._measured

    def knows(self, point: Point) -> bool:
        """Whether it was measured, or its variant probed."""
        return self.has_measured(point) or probe_key(point) in self._probes

    def learn_group(self, points: Sequence[Point], ended: Sequence[ProcessResult], seconds: float) -> None:
        """Processes of a block of an experiment ended, measured in so many seconds in all."""
        own = [one.seconds for one in ended if one.seconds is not None]
        for point, one in zip(points, ended, strict=True):
            if one.seconds is not None:
                self.learn(point, one.seconds, one.runs)
        if own and len(own) == len(ended):
            self.learn_beside(points[0].experiment, max(0.0, seconds - sum(own)) / len(own))

    def learn(self, point: Point, seconds: float, runs: Sequence[float] = ()) -> None:
        """A process of the point took this long, of which its timed runs took these seconds. What more runs
        take than the one of a model says nothing of the model.
        """
        self._measured.setdefault(point.id, []).append((seconds, runs))
        ratios = self._ratios.setdefault(point.experiment, [])
        ratios.append((seconds - sum(runs[point.repetitions :])) / self._modelled(point))
        self._corrections[point.experiment] = statistics.median(ratios)

    def learn_beside(self, experiment: str, seconds: float) -> None:
        """A process of the experiment took this much longer than its own account, for each of its points."""
        # The least counts, since the first process of a variant comes with its check.
        self._beside[experiment] = min(seconds, self._beside.get(experiment, _MOST_BESIDE))

    def _beside_of(self, point: Point) -> float:
        return self._beside.get(point.experiment, SECONDS_PER_PROCESS)

    def _correction(self, point: Point) -> float:
        """Measured over modelled: of the point's experiment if it has any measurement, else of all others."""
        of_all = self._corrections.values() or [1.0]
        return self._corrections.get(point.experiment) or statistics.median(of_all)

    def _modelled(self, point: Point) -> float:
        runs = point.warm_up + (_RUNS_BESIDES if point.verb == "profile" else point.repetitions)
        return self._start(point) + runs * self._modelled_run(point)

    def _start(self, point: Point) -> float:
        """A process until its first run."""
        return 0.0 if point.command is not None else self._probe(point).process + _reading(point.scene)

    def _modelled_run(self, point: Point) -> float:
        """One run from the first step to the last."""
        if point.command is not None:
            return _UNKNOWN_PROGRAM
        match point.scene:
            case HardCase(case):
                return _SECONDS_OF_HARD_CASES.get(case, _SECONDS_OF_ANOTHER_HARD_CASE)
            case Scene() as scene:
                per_work = self._probe(point).step / _work(PROBE)
                return scene.steps * point.substeps * per_work * _work(scene)
        return 0.0

    def _probe(self, point: Point) -> Probe:
        return self._probes.get(probe_key(point), _UNPROBED)


def probe_key(point: Point) -> str:
    """What a probe depends on."""
    return f"{str(point.program.sha256)[:12]} {point.variant} {point.threads}"


def kept_probes(kept: object) -> dict[str, Probe]:
    """The probes that were kept; of anything else that stands in their place nothing."""
    probes = {}
    for key, value in kept.items() if isinstance(kept, dict) else ():
        match value:
            case {"step": float(step), "process": float(seconds)} if step > 0 and seconds >= 0:
                probes[str(key)] = Probe(step, seconds)
    return probes


def to_probe(points: Iterable[Point], known: Mapping[str, object]) -> list[Point]:
    """One point for each probe that is still to be made."""
    can = (point for point in points if point.program.sha256 is not None and point.command is None)
    wanted = {probe_key(point): point for point in can}
    return [point for key, point in wanted.items() if key not in known]


def probe(points: Sequence[Point], scene: Path, folder: Path, time_limit: float) -> dict[str, Probe]:
    """Time short runs of the points' variants, of those that have a program and threads in common in one
    process. What it leaves no record of is left out: the run proper explains why.
    """
    records = [[folder / f"{at}-{run}.json" for run in range(_PROBED)] for at in range(len(points))]
    groups: dict[object, list[tuple[Point, Path]]] = {}
    for point, several in zip(points, records, strict=True):
        group = groups.setdefault((point.program.path, point.openmp, point.threads), [])
        group += [(point, record) for record in several]
    for group in groups.values():
        words = [
            [str(scene), "--variant", one.variant, "--threads", str(one.threads), "--record", str(record)]
            for one, record in group
        ]
        contenders, first = folder / "contenders.json", group[0][0]
        contenders.write_text(json.dumps(words), encoding="utf-8")
        command = [str(first.program.path), "turns", str(contenders), "--counts"]
        run_alone(command, first.openmp, time_limit)
    probes = {}
    for point, several in zip(points, records, strict=True):
        contents = [read_json(record) for record in several]
        if all(contents):
            # The least of them: a probe is short, and whatever else runs can only lengthen it.
            steps = min(float(one["repetitions"][0]["steps_seconds"]) for one in contents)
            beside = min(float(one["process_seconds"]) for one in contents) - steps
            probes[probe_key(point)] = Probe(steps / PROBE.steps, _STARTING + max(0.0, beside))
    return probes


def _reading(scene: AnyScene) -> float:
    return scene.particles * _SECONDS_PER_DISC_READ if isinstance(scene, Scene) else 0.0


@cache
def _work(scene: Scene) -> float:
    """A step's work in discs, fitted to the published variant on two cores: empty boxes are looked at too,
    dense discs resolved again and again (at 0.71, 0.80 and 0.87 of the area 0.1, 0.9 and 3.4 more; measured
    0.2, 0.6 and 3.4), and what outgrows the caches costs more each time (a power from 0.05 to 0.24).
    """
    boxes = (scene.side / (4 * scene.radius + 1)) ** 2
    crowding = 1 + 30 * scene.area_fraction**16
    speed = 1 + 0.025 * (scene.min_velocity + scene.max_velocity) / 2
    beyond = max(1.0, scene.particles / PROBE.particles) ** 0.2
    return (scene.particles * crowding * speed + 0.1 * boxes) * beyond
