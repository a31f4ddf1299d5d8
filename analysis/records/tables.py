"""From a validated record to the rows of flat tables: what each table is made of, and where a record stands.

A record holds all that were compared in one process; each of these has rows of its own. Every table of what
was measured carries the same columns of context (see `context`).
"""

import math
import shlex
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from analysis.statistics.neighbours import FEWEST, contender_logs
from analysis.statistics.pairs import rounds_of, runs_of
from analysis.statistics.turns import excess, location

Record = dict[str, Any]
Row = dict[str, Any]

_RUNS, _ROUNDS = runs_of("steps_seconds"), rounds_of("steps_seconds")
TAGS = [
    "experiment", "series", "x_name", "x", "block", "position", "session", "scale", "site", "point",
    "label", "scene_name", "series_number", "figure", "title", "points_planned", "blocks_planned",
    "margin", "error", "reference", "replicate",
]  # fmt: skip
AXES = [
    "variant", "neighbourhood", "order", "self_contained", "direction", "find_schedule",
    "resolve_schedule", "find_chunk", "resolve_chunk", "threads", "substeps", "tolerance",
    "storage", "prefetch", "box_side", "overlaps", "search", "worklist", "impact", "precision",
]  # fmt: skip
SCENE = ["particles", "side", "radius", "steps", "area_fraction"]
PROVENANCE = [
    "cpu_model", "cores", "hardware_threads", "affinity", "memory_bytes", "virtualised", "governor",
    "operating_system", "compiler", "compiler_flags", "build_type", "binary_sha256",
]  # fmt: skip
COLUMN_OF = {"overlaps": "overlaps_kept"}
"""The columns of axes whose name in the record is that of a count, too."""
AXIS_COLUMNS = [COLUMN_OF.get(name, name) for name in AXES]
WORK = ["overlaps", "pair_resolves", "pair_attempts", "sweeps"]
"""Totals over the S steps, NaN of a whole process."""
ERRORS = [
    "energy_drift", "discs_outside", "unresolved_pairs", "momentum_drift", "penetration_worst",
    "penetration_mean", "time_to_tenth_radius", "collision_rate", "collision_rate_reference", "pressure",
    "pressure_reference", "speed_distance",
]  # fmt: skip
CHECKS = ["has_errors", "check_verdict", "check_scope", "check_reason", "repetitions", "process_seconds"]
NO_SCENE: dict[str, Any] = {"name": "", "sha256": "", **dict.fromkeys(SCENE)}
"""Of a program that is about something else than discs."""
CONTEXT = [
    "file", "kind", "question_kind", "recorded_at", *TAGS, *AXIS_COLUMNS, "scene",
    *SCENE, *PROVENANCE, "openmp", "openmp_runtime", "proc_bind", "environment",
    "warm_ups", "in_turns", "time_from", "undisturbed", "command", "compiler_family", "node", "machine",
    "revision",
]  # fmt: skip
OF_PARTS = {
    "runs": [*WORK, *ERRORS, *CHECKS],
    "times": ["lost_by_turns", "stops", "own_seconds", "steps_seconds", _RUNS, _ROUNDS],
    "trajectory": ["time", "rms_distance"],
    "phases": ["phase", "wall_seconds", "serial_seconds"],
    "threads": ["phase", "thread", "busy_seconds", "waiting_seconds"],
    "counters": ["name", "thread", "value", "source", "reason", "remedy"],
}
"""What each table has beside the context, a row a part of a record, made by the function of its name."""
ALONE = {
    "limits": ["file", "machine", "compiler", "limit", "threads", "level", "working_set_bytes", "lanes",
               "best", "median", "repetitions"],
    "failures": ["file", *TAGS, "command", "exit_code", "reason", "recorded_at", "owner", "program_sha256"],
}  # fmt: skip
"""The tables of other kinds, each made by the function of its name."""
TABLE_OF = {"limits": "limits", "failure": "failures"}
"""By kind of what is in a table of its own."""
FLOATS = {
    "runs": [*ERRORS, "pair_attempts"], "times": ["steps_seconds"], "trajectory": ["rms_distance"],
}  # fmt: skip
"""Columns that are numbers, NaN where nothing is known, even where that is everywhere."""


def contenders(name: str, record: Record) -> Iterator[tuple[str, Record]]:
    """Yield each contender of a process as if it had a record of its own, with a name of its own."""
    those = record["contenders"]
    turns = _turns_of(record)
    for number, one in enumerate(those):
        own = {key: value for key, value in record.items() if key not in ("contenders", "turns")} | one
        own["provenance"] = record.get("provenance", {}) | one.get("provenance", {})
        own["turns"] = turns.get(number)
        if "reason" in one:
            own["kind"] = "failure"
        yield (f"{name}#{number}" if len(those) > 1 else name), own


def _turns_of(record: Record) -> dict[int, Record]:
    """Return the turns that each contender of a process took. Of many of one scene what each of them takes
    beside its neighbours in the order of time is `joint`, one turn instead of all of them.
    """
    turns, those = record.get("turns") or {}, record["contenders"]
    if "rounds" not in turns:
        return {}
    whose = np.array(turns["contenders"])
    seconds, steps = np.array(turns["seconds"]), np.array(turns["steps"])
    returning = np.array(turns["returning_seconds"], dtype=float)
    found: dict[int, Record] = {
        number: {
            "rounds": turns["rounds"],
            "seconds": seconds[whose == number],
            "steps": steps[whose == number],
            "returning_seconds": returning[whose == number],
        }
        for number in range(len(those))
    }
    is_of_one_scene = len({(one.get("scene") or {}).get("sha256") for one in those}) == 1
    if len(those) >= FEWEST and is_of_one_scene and (seconds > 0).all():
        logs = np.log(np.stack([own["seconds"] for own in found.values()]))
        joint = location(logs.mean(axis=0)) + contender_logs(logs, whose.reshape(-1, len(those)))
        for number, log in enumerate(joint):
            found[number]["joint"] = np.exp([log])
    return found


def context(name: str, record: Record) -> Row:
    """Return where a record stands: its tags, axes, scene and origin, one column each.

    `machine` is what may be compared as one machine: the host with its CPU model or, under Slurm, the
    partition with its CPU model (`node` then tells its nodes apart).
    """
    tags, scene, origin = record["tags"], record["scene"] or NO_SCENE, record["provenance"]
    slurm = origin["slurm"] or {}
    return {
        "file": name,
        "kind": record["kind"],
        "question_kind": tags.get("kind", tags.get("figure")),
        "recorded_at": record["recorded_at"],
        **{column: tags.get(column) for column in TAGS},
        "replicate": tags.get("replicate", 1),
        "series": str(tags["series"]),
        "session": str(tags.get("session", "")),
        "scale": str(tags.get("scale", "unstated")),
        **{COLUMN_OF.get(name, name): record["axes"].get(name) for name in AXES},
        "scene": scene["name"],
        **{column: scene[column] for column in SCENE},
        **{column: origin[column] for column in PROVENANCE},
        "openmp": f"{origin['openmp']['runtime']} {origin['openmp']['version']}",
        "openmp_runtime": origin["openmp"]["runtime"],
        "proc_bind": origin["openmp"]["proc_bind"],
        "environment": " ".join(f"{k}={v}" for k, v in sorted(origin["openmp"]["environment"].items())),
        "warm_ups": record["warm_ups"],
        "in_turns": bool(record["turns"] or record.get("slices")),
        "time_from": record.get("process", {}).get("time_from"),
        "undisturbed": record.get("process", {}).get("undisturbed"),
        "command": shlex.join(record["process"]["command"]) if record["kind"] == "process" else None,
        "compiler_family": _compiler_family(origin["compiler"]),
        "node": slurm.get("SLURMD_NODENAME", origin["host"]),
        "machine": machine_of(origin),
        "revision": revision_of(origin),
    }


def revision_of(origin: dict[str, Any]) -> str:
    """Return the commit with the hash of what was changed on top of it."""
    changes = f" with changes {str(origin['diff_sha256'])[:8]}" if origin["dirty"] else ""
    return f"{origin['commit'][:10]}{changes}" if origin["commit"] else "no commit known"


def machine_of(origin: dict[str, Any]) -> str:
    """Return what a record's machine is called: the partition or host, its processor, and the quota if that
    grants less than the processors that the process may run on.
    """
    partition = (origin["slurm"] or {}).get("SLURM_JOB_PARTITION")
    quota = origin.get("cpu_quota")
    limited = f", a quota of {quota:g} processors" if quota and quota < origin["affinity_count"] else ""
    return f"{partition or origin['host']}: {origin['cpu_model']}{limited}"


def _compiler_family(compiler: str) -> str:
    """Return `clang` or `gcc` for what they call themselves, else the compiler's first word."""
    name = compiler.lower()
    if "clang" in name:
        return "clang"
    if any(alias in name for alias in ("gcc", "g++", "gnu")):
        return "gcc"
    return next(iter(compiler.split()), "unknown")


def runs(record: Record) -> Iterable[Row]:
    """Give one row: work totals over the S steps, the check's verdict, and the error measures, NaN for those
    that were not asked for or not possible; `has_errors` tells who was asked.
    """
    errors, check = record.get("errors") or {}, record["check"]
    yield {
        **{column: record.get("work", {}).get(column) for column in WORK},
        **{column: errors.get(column) for column in ERRORS},
        "has_errors": "trajectory" in errors,
        "check_verdict": check["verdict"],
        "check_scope": check["scope"],
        "check_reason": check["reason"],
        "repetitions": len(record["repetitions"]),
        "process_seconds": record["process_seconds"],
    }


def trajectory(record: Record) -> Iterable[Row]:
    """Give one row a time at which a run was compared with the exact reference: `time`, `rms_distance` (in
    units of the radius).
    """
    return (record.get("errors") or {}).get("trajectory") or []


def times(record: Record) -> Iterable[Row]:
    """Give one row for a process that was timed: `lost_by_turns`, the share of its time that coming back to
    cold caches took, and `stops`, in how many slices a run of a whole program was, 0 if it was never stopped;
    NaN where not known. `steps_seconds` is the median of its runs, whose times are beside it, and those of
    its turns, run by run, if it took any; of a whole process they are its own, as seen from outside or as it
    says itself. `own_seconds` is the median of the runs less what they waited for a processor.
    """
    if record["kind"] not in ("bench", "process") or not record["repetitions"]:
        return
    seconds = np.array([one["steps_seconds"] for one in record["repetitions"]], dtype=float)
    waited = np.array([one.get("waited_seconds") for one in record["repetitions"]], dtype=float)
    turns = record["turns"] or {}
    yield {
        "lost_by_turns": _lost_by_turns(record),
        "stops": _stops(record),
        "own_seconds": float(np.median(seconds - waited)),
        "steps_seconds": float(np.median(seconds)),
        _RUNS: seconds,
        _ROUNDS: turns.get("joint", turns.get("seconds", np.array([]))),
    }


def _lost_by_turns(record: Record) -> float:
    """Return the share of a process's time, NaN where it is not known."""
    turns = record["turns"]
    if turns is None:
        return math.nan
    return excess(turns["seconds"], turns["returning_seconds"], turns["steps"], turns["rounds"])


def _stops(record: Record) -> float:
    if record["kind"] != "process":
        return math.nan
    slices, runs = len((record["slices"] or {}).get("seconds", [])), len(record["repetitions"])
    return slices / runs if slices > runs else 0.0


def phases(record: Record) -> Iterable[Row]:
    """Give one row a phase of a profiled run: `phase`, `wall_seconds`, `serial_seconds`."""
    return _profiled(record, "phases")


def threads(record: Record) -> Iterable[Row]:
    """Give one row a phase and thread of a profiled run: seconds busy and waiting."""
    return _profiled(record, "threads")


def counters(record: Record) -> Iterable[Row]:
    """Give one row a counter and thread of a profiled run: `name`, `value` or `reason`, `remedy`."""
    return _profiled(record, "counters")


def _profiled(record: Record, part: str) -> Iterable[Row]:
    return record.get("profile", {}).get(part, []) if record["kind"] == "profile" else []


def limits(name: str, record: Record) -> Iterable[Row]:
    """Give one row a rate that a machine reached at most: `file`, `machine`, `compiler`, `limit` (copy or
    arithmetic), `threads`, `level` and `working_set_bytes` of a copy, `lanes` of arithmetic, `best` and
    `median` per second, `repetitions`.
    """
    rates = {"copy": "bytes_per_second", "arithmetic": "operations_per_second"}
    return (
        {
            "file": name,
            "machine": machine_of(record["provenance"]),
            "compiler": record["provenance"]["compiler"],
            "limit": limit,
            **row,
            **row[rate],
        }
        for limit, rate in rates.items()
        for row in record["limits"][limit]
    )


def failures(name: str, record: Record) -> Iterable[Row]:
    """Give one row of a failed point: its tags, `command` (one line), `exit_code`, `reason`, `recorded_at`;
    `owner`, the partition or host that it failed on, and `program_sha256`, where the record tells them.
    """
    tags = record["tags"]
    yield {
        "file": name,
        **{column: tags.get(column) for column in TAGS},
        "command": " ".join(record["command"]),
        "exit_code": record["exit_code"],
        "reason": record["reason"],
        "recorded_at": record["recorded_at"],
        "owner": tags.get("partition") or tags.get("host"),
        "program_sha256": tags.get("program_sha256"),
    }
