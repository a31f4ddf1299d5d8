"""Every experiment at its published points, with effects like the published ones."""

import math
from collections.abc import Callable
from typing import Any

from analysis.tests.synthetic import Point, measured_errors


def _threads() -> list[Point]:
    def seconds(n: int) -> float:
        return {1: 6.2, 2: 3.4}.get(n, 3.3) * (1 + 0.15 * max(0, n - 4))

    return [_at("threads", n, seconds(n), axes={"threads": n}) for n in (1, 2, 3, 4, 5, 6, 7, 8)]


def _oversubscription() -> list[Point]:
    return [_at("threads", n, 1.7 + 0.1 * (n - 4), axes={"threads": n}) for n in (4, 8, 12, 16, 32)]


def _at(x_name: str, x: float, seconds: float, series: str = "checkered", **more: Any) -> Point:  # noqa: ANN401
    return Point(series, x, seconds, x_name, **more)


def _particles() -> list[Point]:
    counts = range(10_000, 100_001, 10_000)
    return [_at("particles", n, 0.1 + 9e-6 * n, scene={"particles": n, "radius": 15.0}) for n in counts]


def _grid_length() -> list[Point]:
    """The published series falls and rises, `sorted` is flat; at the smallest side both are dense."""
    return [
        _at("grid_length", side, seconds + dense * (side == 9_000), series, axes=axes, scene={"side": side})
        for side in (9_000, *range(10_000, 100_001, 10_000))
        for series, seconds, dense, axes in (
            ("checkered", 0.35 + 3.2e-5 * side, 2.2, {}),
            ("sorted", 0.1, 0.2, {"variant": "sorted"}),
        )
    ]


def _radius() -> list[Point]:
    def seconds(r: int) -> float:
        return 0.14 * math.exp(0.5 * abs(math.log(r / 35)) * (1 if r < 35 else 3))

    return [_at("radius", r, seconds(r), scene={"radius": r}) for r in range(5, 51, 5)]


def _steps() -> list[Point]:
    return [_at("steps", count, 0.008 * count, scene={"steps": count}) for count in range(20, 201, 20)]


def _velocity(name: str) -> Callable[[], list[Point]]:
    return lambda: [_at(name, v, 1.1 + 0.007 * v) for v in (1, *range(5, 51, 5))]


def _density() -> list[Point]:
    fractions = [tenth / 10 for tenth in range(1, 10)]
    return [
        _at("area_fraction", f, 0.5 + f**3, scene={"side": math.sqrt(1e5 * math.pi * 256 / f)},
            pair_resolves=int(2e7 * f**2))
        for f in fractions
    ]  # fmt: skip


def _pair(axis: str, values: dict[str, float], order: str = "checkered") -> Callable[[], list[Point]]:
    return lambda: [
        Point(value, 0, seconds, axes={axis: value, "variant": value, "order": order})
        for value, seconds in values.items()
    ]


def _reverse() -> list[Point]:
    return [
        _at("seed", seed, seconds, direction, axes={"direction": direction, "variant": variant},
            pair_resolves=resolves + 1000 * seed, pair_attempts=attempts + 9000 * seed**2)
        for seed in (1, 2, 3, 4, 5, 6)
        for direction, variant, seconds, resolves, attempts in (
            ("reverse", "published", 1.10, 12_000_000, 30_000_000),
            ("forward", "forward", 1.18, 13_100_000, 35_000_000),
        )
    ]  # fmt: skip


def _phases() -> list[Point]:
    """Without early resolves the search, whose share is the same, takes a tenth less."""
    return [
        Point(series, 0, seconds, axes={"variant": variant, "order": order, "self_contained": early})
        for series, seconds, variant, order, early in (
            ("checkered", 1.1, "published", "checkered", "on"),
            ("row", 1.05, "row-resolve_dynamic", "row", "on"),
            ("self_contained_off", 1.0, "self_contained_off", "checkered", "off"),
        )
    ]


def _compiler() -> list[Point]:
    return [Point("g++ with libomp", 0, 1.1), Point("clang++ with libomp", 0, 1.06, compiler="Clang 14.0.6")]


def _schedule(phase: str, chunks: dict[str, list[int]], best: tuple[str, int]) -> Callable[[], list[Point]]:
    def seconds(kind: str, chunk: int) -> float:
        offset = 0.06 if (kind, chunk) != best else 0.0
        return 0.72 + offset + {"guided": 0.004, "dynamic": 0.001, "static": 0.001}[kind] * chunk

    return lambda: [
        _at("chunk", chunk, seconds(kind, chunk), kind,
            axes={f"{phase}_schedule": f"{kind}_chunk", f"{phase}_chunk": chunk, "threads": 4})
        for kind, values in chunks.items()
        for chunk in values
    ]  # fmt: skip


def _row() -> list[Point]:
    sizes = (1_000, 10_000, 50_000, 100_000, 200_000)
    return [
        _at("particles", n, 1.1e-5 * n * factor, order, axes={"order": order}, scene={"particles": n})
        for n in sizes
        for order, factor in (("checkered", 1), ("row", 1.1 - 0.08 * math.log10(n / 1000)))
    ]  # fmt: skip


SCENES = {"dilute": 0.1, "medium": 0.4, "dense": 0.65}
SUBSTEPS = (1, 2, 4, 8, 16, 32, 64)


def _speed_against_error() -> list[Point]:
    """Errors are c dt; float takes half the time and has a floor; row is checkered, slower."""

    def point(scene: str, series: str, substeps: int) -> Point:
        fraction, single = SCENES[scene], series == "float"
        path = max(0.2 * fraction / substeps, 1e-3 if single else 0.0)
        seconds = 16 * 1e-3 * substeps * (1 + fraction) * {"checkered": 1, "row": 1.2, "float": 0.5}[series]
        return Point(
            series, substeps, seconds, "substeps", scene_name=scene,
            axes={"variant": {"checkered": "published"}.get(series, series), "substeps": substeps,
                  "precision": "float" if single else "double"},
            scene={"particles": 5000, "steps": 16, "side": math.sqrt(5000 * math.pi * 256 / fraction)},
            errors=measured_errors(
                path, 2 if substeps < 8 else 4, (1, 2, 4, 8, 16), energy_drift=1e-6 if single else 2e-14,
                penetration_worst=0.3 / substeps, penetration_mean=0.1 / substeps,
                collision_rate=0.4 * (1 - 0.05 / substeps), pressure=0.02 * (1 + 0.02 / substeps),
            ),
        )  # fmt: skip

    return [
        point(scene, series, substeps)
        for scene in SCENES
        for series in ("checkered", "row", "float")
        for substeps in SUBSTEPS
    ]


def _hard_cases() -> list[Point]:
    return [
        Point(
            series, 0, 0.01, scene_name=case, scene={"particles": 5, "steps": 10},
            axes={"variant": series, "precision": "float" if series == "float" else "double"},
            errors=measured_errors(1e-9, None, (1, 2, 4, 8, 10)),
        )
        for series in ("published", "row", "float")
        for case in ("cradle", "fast", "at_rest", "scaled_down", "scaled_up", "drift")
    ]  # fmt: skip


def _control() -> list[Point]:
    return [Point(label, 0, 1.1, label=label) for label in ("A", "A-again")]


LADDER: dict[str, tuple[float, dict[str, str | None]]] = {
    "published": (1.0, {}),
    "sorted": (1.25, {"storage": "sorted"}),
    "strips-sorted": (1.0, {"storage": "sorted", "order": "strips"}),
    "strips-sorted-contacts": (
        2.0,
        {"storage": "sorted", "order": "strips", "overlaps": "contacts", "direction": None},
    ),
}
"""Each rung with the factor by which it is faster than the one before, and its policies."""

DENSE = {"particles": 10_000, "radius": 53.0}


def _ladder() -> list[Point]:
    points = []
    for scene, change, seconds in (("sparse", {}, 1.0), ("dense", DENSE, 0.3)):
        for number, (name, (factor, policies)) in enumerate(LADDER.items(), start=1):
            seconds /= factor
            tags: dict[str, str | float] = {"series_number": number}
            axes: dict[str, Any] = {"variant": name, **policies}
            points.append(Point(name, 0, seconds, axes=axes, scene=change, scene_name=scene, tags=tags))
    return points


def _limits() -> list[Point]:
    variants = list(enumerate((("published", 1.0), ("strips-sorted-contacts", 0.4)), start=1))
    return [
        Point(name, 0, seconds, axes={"variant": name}, scene=change, scene_name=scene,
              tags={"series_number": number})
        for scene, change in (("sparse", {}), ("dense", DENSE))
        for number, (name, seconds) in variants
    ]  # fmt: skip


TRUE_BIAS = 0.01
"""How much longer a pair's other one takes by turns than in a process of its own."""


def _ways() -> list[Point]:
    def point(scene: str, number: int, series: str, seconds: float, *, in_turns: bool) -> Point:
        longer = TRUE_BIAS if in_turns and number > 1 else 0
        return Point(
            series, 0, seconds * (1 + longer), axes={"variant": series}, scene_name=scene,
            tags={"series_number": number}, in_turns=in_turns,
        )  # fmt: skip

    return [
        point(scene, number, series, seconds, in_turns=in_turns)
        for scene, both in (
            ("large", {"published": 1.0, "nine": 1.1}),
            ("small", {"published": 0.1, "row": 0.1}),
        )
        for number, (series, seconds) in enumerate(both.items(), start=1)
        for in_turns in (True, False)
    ]


SEQUENTIAL = {"track": 2.3, "repeat": 3.7, "once": 3.3}
FIND = {"guided": [2, 3, 4, 5, 7], "dynamic": [5, 10, 20, 30, 40, 50], "static": [10, 15, 20, 25, 30, 40, 80]}
RESOLVE = {"guided": [3, 4, 5, 6, 10], "dynamic": [5, 10, 20, 30, 40, 50, 51, 52, 53, 55, 60, 100]}
ROW = {"guided": [1, 2, 3, 4, 5, 6, 10], "dynamic": [1, 2, 3, 4, 5, 6, 10]}
EXPERIMENTS: dict[str, Callable[[], list[Point]]] = {
    "threads": _threads,
    "particles": _particles,
    "grid_length": _grid_length,
    "radius": _radius,
    "steps": _steps,
    "min_velocity": _velocity("min_velocity"),
    "max_velocity": _velocity("max_velocity"),
    "machine": lambda: [_at("none", 0, 1.1)],
    "neighbourhood": _pair("neighbourhood", {"four": 1.19, "nine": 1.25}),
    "self_contained_checkered": _pair("self_contained", {"on": 1.18, "off": 1.181}),
    "self_contained_track": _pair("self_contained", {"on": 2.31, "off": 2.59}, "track"),
    "self_contained_repeat": _pair("self_contained", {"on": 3.62, "off": 3.91}, "repeat"),
    "schedule_find": _schedule("find", FIND, ("guided", 4)),
    "schedule_resolve": _schedule("resolve", RESOLVE, ("guided", 5)),
    "schedule_resolve_row": _schedule("resolve", ROW, ("dynamic", 1)),
    "row": _row,
    "reverse": _reverse,
    "sequential_orders": lambda: [Point(k, 0, v, axes={"order": k}) for k, v in SEQUENTIAL.items()],
    "compiler": _compiler,
    "phases": _phases,
    "density": _density,
    "ladder": _ladder,
    "limits": _limits,
    "oversubscription": _oversubscription,
    "control": _control,
    "speed_against_error": _speed_against_error,
    "hard_cases": _hard_cases,
    "ways": _ways,
    "ways_of_processes": _ways,
}
