"""How long a point takes: from its own records, else from a probe of its variant and its scene's size."""

import json
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.point import Point
from experiments.plan.scenes import AnyScene, HardCase, Scene
from experiments.run.host_lock import run_alone
from support.files import read_json

PROBE = Scene(particles=10000, side=3162, radius=16, steps=10, min_velocity=2, max_velocity=5)

# These foretell, before anything is measured, how long the study takes; a first block of each question then
# overrules them. So they are round: too high costs a few blocks, too low a little more than the budget.

# Fitted to the published variant: on two cores, and to the study's series in analysis/records/published.toml.
_BOX_PER_DISC = 0.1
"""Of a disc's time, over the side length: 0.07, and 0.11 in the study's series."""
_PER_UNIT_OF_VELOCITY = 0.025
"""Of the time of discs at rest, for each unit of the mean component: 0.024 and 0.026 in the study's."""
_CROWDING = 30
_CROWDING_POWER = 16
"""More time by area fraction: 0.1 of it at 0.71 (measured 0.2), 0.9 at 0.80 (0.6), 3.4 at 0.87 (3.4)."""
_GROWTH_BEYOND_CACHES = 0.2
"""Power of the discs: from 10 000 to a million 0.24 for the published variant, 0.05 for the fastest."""
_SECONDS_PER_DISC_READ = 7e-7
"""Measured, the same for 10 000 discs and for a million. Generating takes about twice as long."""

# What the program does, in runs of the steps.
_RUNS_OF_A_PROFILE = 3
"""A bare one, the profiled one, and one in which events are counted."""
_RUNS_OF_A_CHECK = 3
_RUNS_FOR_ERRORS = 3
"""A guess, not measured: to check a step, or to follow the exact paths beside it, takes as long as two."""
_SLOWED_BY_CACHEGRIND = 60
"""Between the 20 and the 100 times of Valgrind's manual."""

_SECONDS_PER_HARD_CASE = 0.01
_SECONDS_OF_LONG_CASES = {"drift": 3.0}
"""Most have few discs and steps; `drift` has 100 discs for 100 000 steps, at 0.3 us a disc and step."""

_PROBED = 3
"""Runs of a probe, of which the least counts: enough for one without a disturbance, and over in 0.1 s."""
_STARTING = 0.02
"""Seconds in which a process starts and ends, which no probe among others tells."""
_UNPROBED_STEP, _UNPROBED_PROCESS = 0.01, 0.05
"""Seconds of a variant whose probe failed: several times what the published one takes."""
_UNKNOWN_PROGRAM = 1.0
"""Seconds of somebody else's program until it has run once: a guess."""

SECONDS_PER_PROCESS = 0.03
"""What a process takes beside its own account of its time, until that was seen: its start, its end, the look
at its record.
"""

_MOST_BESIDE = 0.3
"""The most that this is taken to be: the first process of an experiment checks variants besides."""

Measured = tuple[float, Sequence[float]]
"""Seconds of a whole process, and of each of its timed runs."""


@dataclass(frozen=True)
class Probe:
    """What one process of a variant took on the probe scene: seconds a step, and seconds beside the steps."""

    step: float
    process: float


def kept_probes(kept: object) -> dict[str, Probe]:
    """The probes that were kept; of anything else that stands in their place nothing."""
    probes = {}
    for key, value in kept.items() if isinstance(kept, dict) else ():
        match value:
            case {"step": float(step), "process": float(seconds)} if step > 0 and seconds >= 0:
                probes[str(key)] = Probe(step, seconds)
    return probes


class Costs:
    """Estimates in seconds of wall time."""

    def __init__(self, probes: Mapping[str, Probe], measured: Mapping[str, Sequence[Measured]]) -> None:
        self._probes = dict(probes)
        self._measured = {point: list(processes) for point, processes in measured.items()}
        self._models: dict[str, float] = {}
        self._beside: dict[str, list[float]] = {}
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
        return self._modelled(point) * self._correction(point.experiment) + self._beside_of(point)

    def run(self, point: Point) -> float:
        """One timed run of a point."""
        if times := [time for _, runs in self._measured.get(point.id, ()) for time in runs]:
            return statistics.median(times)
        if point.command is not None:
            return _UNKNOWN_PROGRAM
        return _run(point, self._probe(point)) * self._correction(point.experiment)

    def fixed(self, point: Point) -> float:
        """What a process of a point takes without its timed runs."""
        if measured := self._measured.get(point.id):
            spent = statistics.median(max(0.0, seconds - sum(runs)) for seconds, runs in measured)
            return spent + self._beside_of(point)
        return max(0.0, self.point(point) - point.repetitions * self.run(point))

    def check(self, point: Point) -> float:
        """The verification of every step of the point's variant on its scene."""
        if point.program.sha256 is None:
            return 0.0
        if point.command is not None:
            return _UNKNOWN_PROGRAM if point.is_checked else 0.0
        probe = self._probe(point)
        return probe.process + _reading(point.scene) + _RUNS_OF_A_CHECK * _run(point, probe)

    def besides(self, point: Point) -> float:
        """What one of the point's processes does besides: measuring errors, counting under cachegrind."""
        if point.program.sha256 is None:
            return 0.0
        probe = self._probe(point)
        seconds = _RUNS_FOR_ERRORS * _run(point, probe) if point.errors else 0.0
        if point.simulated:
            scene = point.scene
            share = min(point.simulated / scene.steps, 1.0) if isinstance(scene, Scene) else 1.0
            seconds += _SLOWED_BY_CACHEGRIND * (_run(point, probe) * share + 2 * _reading(point.scene))
        return seconds

    def scene(self, scene: AnyScene) -> float:
        """Generating a scene."""
        return 2 * _reading(scene)

    def learn(self, point: Point, seconds: float, runs: Sequence[float] = ()) -> None:
        """A process of the point took this long, of which its timed runs took these seconds. What more runs
        take than the one of a model says nothing of the model.
        """
        self._measured.setdefault(point.id, []).append((seconds, runs))
        of_one = seconds - sum(runs[point.repetitions :])
        self._ratios.setdefault(point.experiment, []).append(of_one / self._modelled(point))
        self._corrections.clear()

    def learn_beside(self, experiment: str, seconds: float) -> None:
        """A process of the experiment took this much longer than its own account, for each of its points."""
        self._beside.setdefault(experiment, []).append(seconds)

    def _beside_of(self, point: Point) -> float:
        # The least, since the first process of a variant comes with its check.
        return min([*self._beside.get(point.experiment, [SECONDS_PER_PROCESS]), _MOST_BESIDE])

    def _correction(self, experiment: str) -> float:
        """Measured over modelled: of this experiment if it has any measurement, else of all of them."""
        if experiment not in self._corrections:
            own = self._ratios.get(experiment)
            ratios = own or [ratio for some in self._ratios.values() for ratio in some]
            self._corrections[experiment] = statistics.median(ratios) if ratios else 1.0
        return self._corrections[experiment]

    def _modelled(self, point: Point) -> float:
        if point.command is not None:
            return _UNKNOWN_PROGRAM * (1 + point.warm_up)
        if point.id not in self._models:
            probe = self._probe(point)
            seconds = probe.process + _reading(point.scene) + _runs(point) * _run(point, probe)
            self._models[point.id] = seconds
        return self._models[point.id]

    def _probe(self, point: Point) -> Probe:
        return self._probes.get(probe_key(point), Probe(_UNPROBED_STEP, _UNPROBED_PROCESS))


def probe_key(point: Point) -> str:
    """What a probe depends on."""
    return f"{str(point.program.sha256)[:12]} {point.variant} {point.threads}"


def probe(points: Sequence[Point], scene: Path, folder: Path, time_limit: float) -> dict[str, Probe]:
    """Time short runs of the points' variants: of those that have a program and threads in common in one
    process. What fails in it is tried alone, and left out if it fails again, which the run proper explains.
    """
    groups: dict[object, list[Point]] = {}
    for point in points:
        groups.setdefault((point.program.path, point.openmp, point.threads), []).append(point)
    probes: dict[str, Probe] = {}
    for group in groups.values():
        found = _probe(group, scene, folder, time_limit)
        if not found and len(group) > 1:
            for one in group:
                found |= _probe([one], scene, folder, time_limit)
        probes |= found
    return probes


def _probe(points: Sequence[Point], scene: Path, folder: Path, time_limit: float) -> dict[str, Probe]:
    records = [[folder / f"{number}-{run}.json" for run in range(_PROBED)] for number in range(len(points))]
    words = [
        [
            str(scene),
            "--variant",
            str(point.variant),
            "--threads",
            str(point.threads),
            "--record",
            str(record),
        ]
        for point, several in zip(points, records, strict=True)
        for record in several
    ]
    contenders = folder / "contenders.json"
    contenders.write_text(json.dumps(words), encoding="utf-8")
    command = [str(points[0].program.path), "turns", str(contenders), "--counts"]
    if run_alone(command, points[0].openmp, time_limit).exit_code != 0:
        return {}
    probes = {}
    for point, several in zip(points, records, strict=True):
        contents = [read_json(record) for record in several]
        if all(contents):
            # The least of them: a probe is short, and whatever else runs can only lengthen it.
            steps = min(float(one["repetitions"][0]["steps_seconds"]) for one in contents)
            beside = min(float(one["process_seconds"]) for one in contents) - steps
            probes[probe_key(point)] = Probe(steps / PROBE.steps, _STARTING + max(0.0, beside))
    return probes


def to_probe(points: Iterable[Point], known: Mapping[str, object]) -> list[Point]:
    """One point for each probe that is still to be made."""
    wanted = {
        probe_key(point): point
        for point in points
        if point.program.sha256 is not None and point.command is None
    }
    return [point for key, point in wanted.items() if key not in known]


def _runs(point: Point) -> int:
    return point.warm_up + (_RUNS_OF_A_PROFILE if point.verb == "profile" else point.repetitions)


def _run(point: Point, probe: Probe) -> float:
    """Seconds of one run from the first step to the last."""
    if isinstance(point.scene, HardCase):
        return _SECONDS_OF_LONG_CASES.get(point.scene.case, _SECONDS_PER_HARD_CASE)
    scene = point.scene
    if not isinstance(scene, Scene):
        return 0.0
    return scene.steps * point.substeps * probe.step * _work(scene) / _work(PROBE)


def _reading(scene: AnyScene) -> float:
    return scene.particles * _SECONDS_PER_DISC_READ if isinstance(scene, Scene) else 0.0


def _work(scene: Scene) -> float:
    """A step's work in discs: empty boxes are looked at too, dense discs resolved again and again, and what
    outgrows the caches costs more each time.
    """
    boxes = (scene.side / (4 * scene.radius + 1)) ** 2
    crowding = 1 + _CROWDING * scene.area_fraction**_CROWDING_POWER
    speed = 1 + _PER_UNIT_OF_VELOCITY * (scene.min_velocity + scene.max_velocity) / 2
    beyond = max(1.0, scene.particles / PROBE.particles) ** _GROWTH_BEYOND_CACHES
    return (scene.particles * crowding * speed + _BOX_PER_DISC * boxes) * beyond
