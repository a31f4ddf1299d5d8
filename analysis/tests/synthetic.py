"""Makes results folders of schema-valid records with known effects."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

TEMPLATES: dict[str, Any] = json.loads(
    (Path(__file__).parents[2] / "experiments" / "tests" / "fake_records.json").read_text(encoding="utf-8")
)
"""Parts of records with values that no test minds."""


@dataclass(frozen=True)
class Machine:
    """What a record says of where it was measured."""

    host: str = "bench-1"
    cpu_model: str = "Example CPU @ 2.50GHz"
    cores: int = 2
    hardware_threads: int = 4
    partition: str | None = None
    proc_bind: str = "close"
    runtime: str = "libgomp"
    commit: str = "0123456789abcdef0123456789abcdef01234567"

    def provenance(self, compiler: str, threads: int) -> dict[str, Any]:
        """Return the record's origin as the schema wants it."""
        job = {"SLURM_JOB_PARTITION": self.partition, "SLURMD_NODENAME": self.host}
        openmp = {
            "runtime": self.runtime,
            "max_threads": threads,
            "proc_bind": self.proc_bind,
            "places": self.hardware_threads,
            "environment": {"OMP_PROC_BIND": "close"},
        }
        return TEMPLATES["provenance"] | {
            "host": self.host,
            "cpu_model": self.cpu_model,
            "cores": self.cores,
            "hardware_threads": self.hardware_threads,
            "affinity": f"0-{self.hardware_threads - 1}",
            "affinity_count": self.hardware_threads,
            "oversubscribed": threads > self.hardware_threads,
            "virtualised": True,
            "openmp": TEMPLATES["provenance"]["openmp"] | openmp,
            "compiler": compiler,
            "commit": self.commit,
            "dirty": False,
            "binary_sha256": digest(self.partition or self.host, compiler),
            "slurm": job if self.partition else None,
        }


@dataclass(frozen=True)
class Point:
    """One configuration of an experiment, with its true time and work."""

    series: str
    x: float
    seconds: float
    x_name: str = "none"
    label: str | None = None
    compiler: str = "g++ 12.2.0"
    axes: dict[str, Any] = field(default_factory=dict)
    scene: dict[str, Any] = field(default_factory=dict)
    pair_resolves: int = 12_000_000
    pair_attempts: int = 30_000_000
    scene_name: str | None = None
    errors: dict[str, Any] | None = None
    tags: dict[str, str | float] = field(default_factory=dict)
    in_turns: bool = False


AXES: dict[str, Any] = TEMPLATES["policies"] | {
    "variant": "published",
    "find_chunk": 4,
    "resolve_chunk": 5,
    "threads": 2,
    "substeps": 1,
    "tolerance": "relative",
}
SCENE: dict[str, Any] = {
    "name": "scene.in",
    "particles": 100_000,
    "side": 10_000.0,
    "radius": 16.0,
    "steps": 100,
}


ROUNDS = 4
"""Of turns in each timed run."""


def digest(*parts: object) -> str:
    """Return a stand-in for a SHA-256 of what the parts name."""
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def bench(
    experiment: str, point: Point, block: int, seconds: Iterable[float], machine: Machine, **tags: str | float
) -> dict[str, Any]:
    """Return one timed run, as a contender of a record with what the record says of its process."""
    axes, scene = AXES | point.axes, SCENE | point.scene
    area = scene["particles"] * np.pi * scene["radius"] ** 2 / scene["side"] ** 2
    repetitions = [{"steps_seconds": float(value), "cpu_seconds": float(value) * 1.9} for value in seconds]
    turns = [value["steps_seconds"] / ROUNDS for value in repetitions for _ in range(ROUNDS)]
    return record("bench", tags_of(experiment, point, block, machine) | tags, block) | {
        "axes": axes,
        "scene": {**scene, "sha256": digest(scene), "area_fraction": float(area)},
        "warm_ups": 1,
        "repetitions": repetitions,
        "turns": turns_of(turns, ROUNDS) if point.in_turns else None,
        "parse_seconds": 0.01,
        "process_seconds": float(sum(value["steps_seconds"] for value in repetitions)) + 0.02,
        "work": TEMPLATES["work"]
        | {
            "steps": scene["steps"],
            "overlaps": 10_000_000,
            "pair_resolves": point.pair_resolves,
            "pair_attempts": point.pair_attempts,
            "sweeps": 400,
        },
        "errors": TEMPLATES["errors"]
        | {"energy_drift": 1e-13}
        | (point.errors if point.errors and block == 0 else {}),
        "check": {"verdict": "passed", "scope": "last-step", "reason": None},
        "state_hash": "0" * 16,
        "provenance": machine.provenance(point.compiler, axes["threads"]),
    }


def turns_of(seconds: list[float], rounds: int) -> dict[str, Any]:
    """Return what a record says of turns of the one contender that it has."""
    count = len(seconds)
    own = {"contenders": [0] * count, "steps": [1] * count, "returning_seconds": [None] * count}
    return {"seed": 1, "rounds": rounds, "seconds": seconds, **own}


def record(kind: str, tags: Mapping[str, str | float], minute: int = 0) -> dict[str, Any]:
    """Return what records of every kind have."""
    recorded_at = f"2024-05-01T10:{minute:02}:00Z"
    return {"schema_version": 2, "kind": kind, "recorded_at": recorded_at, "tags": dict(tags)}


def tags_of(experiment: str, point: Point, block: int, machine: Machine) -> dict[str, str | float]:
    """Return the tags that say where a record stands in the study."""
    named = (point.label, point.scene_name, *point.tags.values())
    identity = (machine.host, experiment, point.series, point.x, point.in_turns, *named)
    tags: dict[str, str | float] = {
        "experiment": experiment,
        "series": point.series,
        "x_name": point.x_name,
        "x": point.x,
        "block": block,
        "position": 0,
        "session": "session-1",
        "scale": "paper",
        "site": "local",
        "point": f"p{digest(*identity)[:16]}",
    }
    optional = {"label": point.label, "scene_name": point.scene_name}
    return tags | point.tags | {key: value for key, value in optional.items() if value is not None}


def process(
    experiment: str, series: str, block: int, seconds: float, scope: str = "nothing", **told: object
) -> dict[str, Any]:
    """Return one record of a whole program; `told` is what it says of its process."""
    tags: dict[str, Any] = {
        "experiment": experiment, "series": series, "series_number": 1, "x_name": "repetition", "x": 0,
        "block": block, "session": "s", "scale": "paper", "site": "local", "point": series,
    }  # fmt: skip
    own = {"command": ["./a b", series], "folder": "/", "sources": [], "exit_code": 0, "counters": {}}
    spent = {
        "wall_seconds": seconds,
        "user_seconds": seconds,
        "system_seconds": 0,
        "peak_memory_bytes": 1 << 20,
    }
    return record("process", tags, block) | {
        "axes": {"threads": 2},
        "scene": None,
        "warm_ups": 0,
        "repetitions": [{"steps_seconds": seconds, "cpu_seconds": seconds}],
        "process_seconds": seconds,
        "process": {**own, **spent, "undisturbed": None, "time_from": "outside", **told},
        "turns": None,
        "slices": None,
        "check": {"verdict": "unchecked" if scope == "nothing" else "passed", "scope": scope, "reason": None},
        "provenance": Machine().provenance("GNU 12", 2),
    }


def profile(
    record: dict[str, Any], shares: dict[str, float], counters: list[dict[str, Any]]
) -> dict[str, Any]:
    """Turn a timed record into a profiled one: its first time split into phases by `shares`, over its
    threads.
    """
    wall = record["repetitions"][0]["steps_seconds"]
    count = record["axes"]["threads"]
    rows = [
        {
            "phase": phase,
            "thread": thread,
            "busy_seconds": wall * share * (0.9 - 0.1 * thread / count),
            "waiting_seconds": wall * share * (0.1 + 0.1 * thread / count),
            "iterations": 1000,
            "chunks": 50,
            "loops": 4,
        }
        for phase, share in shares.items()
        for thread in range(count)
    ]
    phases = [
        {"phase": phase, "wall_seconds": wall * share, "serial_seconds": wall * share * 0.05}
        for phase, share in shares.items()
    ]
    measured = {"phases": phases, "threads": rows, "counters": counters, "wall_seconds": wall, "cost": 1.02}
    return record | {"kind": "profile", "profile": measured}


def measured_errors(path: float, horizon: int | None, times: Iterable[int], **more: float) -> dict[str, Any]:
    """Return the error measures of a run whose distance from the exact paths is `path` at time 1 and grows
    tenfold from each of the times to the next; all that `more` does not say is as in an exact run.
    """
    trajectory = [
        {"time": time, "rms_distance": min(path * 10**number, 50.0)} for number, time in enumerate(times)
    ]
    known = {
        "energy_drift": 2e-14,
        "momentum_drift": 1e-15,
        "trajectory": trajectory,
        "time_to_tenth_radius": horizon,
        "collision_rate": 0.4,
        "collision_rate_reference": 0.4,
        "pressure": 0.02,
        "pressure_reference": 0.02,
        "speed_distance": 0.001,
    }
    return TEMPLATES["all_errors"] | known | more


def limits(machine: Machine, copy: dict[str, tuple[int, float]], arithmetic: float) -> dict[str, Any]:
    """Return the record of a machine's limits on one thread and, twice that, on two: `copy` is working set
    and bytes per second of each level, `arithmetic` operations per second of one double at a time, twice
    that of two.
    """

    def rate(best: float) -> dict[str, float]:
        return {"best": best, "median": 0.9 * best, "repetitions": 9}

    tags: dict[str, str | float] = {"experiment": "limits-of-machines", "point": "limits", "block": 0}
    return record("limits", tags) | {
        "limits": {
            "copy": [
                {"level": level, "working_set_bytes": size, "threads": n, "bytes_per_second": rate(n * best)}
                for n in (1, 2)
                for level, (size, best) in copy.items()
            ],
            "arithmetic": [
                {"lanes": lanes, "threads": n, "operations_per_second": rate(n * lanes * arithmetic)}
                for n in (1, 2)
                for lanes in (1, 2)
            ],
        },
        "provenance": machine.provenance("g++ 12.2.0", 2),
    }


def failure(experiment: str, series: str, reason: str, **tags: str) -> dict[str, Any]:
    """Return the record of a point that failed."""
    where: dict[str, str | float] = {"x_name": "none", "x": 0, "block": 0, "scale": "paper", "site": "local"}
    return record("failure", {"experiment": experiment, "series": series, **where, **tags}) | {
        "exit_code": 2,
        "reason": reason,
        "command": ["build/gcc/carom", "bench", "scene.in"],
    }


OF_PROCESS = ("schema_version", "kind", "recorded_at", "turns", "provenance")
"""What a record has once, whoever was measured."""


def whole(*contenders: dict[str, Any]) -> dict[str, Any]:
    """Return the record of a process with these contenders, each with what the record says of its process."""
    common = {key: value for key, value in contenders[0].items() if key in OF_PROCESS}
    own = [{key: value for key, value in one.items() if key not in OF_PROCESS} for one in contenders]
    return common | {"contenders": [{"provenance": {}} | one for one in own]}


def write(folder: Path, records: Iterable[dict[str, Any]]) -> None:
    """Write records of one contender each where a results folder keeps them."""
    for record in records:
        tags = record["tags"]
        own = folder / "records" / tags["experiment"] / f"b{tags['block']}"
        path = own / f"{tags.get('point', 'p0')}-b{tags['block']}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(whole(record)), encoding="utf-8")
