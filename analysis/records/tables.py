"""From validated records to flat tables; every table carries the same columns of context (see `context`)."""

import math
import re
import shlex
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import pandas as pd

from analysis.statistics.returning import excess

Record = dict[str, Any]
Named = list[tuple[str, Record]]
Placed = list[tuple[dict[str, Any], Record]]
"""Records with their context."""

TAGS = [
    "experiment", "series", "x_name", "x", "block", "position", "session", "scale", "site", "point",
    "label", "scene_name", "series_number", "figure", "title", "points_planned", "blocks_planned",
    "margin", "error", "reference", "replicate",
]  # fmt: skip
AXES = [
    "variant", "neighbourhood", "order", "self_contained", "direction", "find_schedule",
    "resolve_schedule", "find_chunk", "resolve_chunk", "threads", "substeps", "tolerance",
]  # fmt: skip
SCENE = ["particles", "side", "radius", "steps", "area_fraction"]
PROVENANCE = [
    "cpu_model", "cores", "hardware_threads", "affinity", "memory_bytes", "virtualised", "governor",
    "operating_system", "compiler", "compiler_flags", "build_type", "binary_sha256",
]  # fmt: skip
LATER_AXES = {
    "storage": "numbered", "box_side": "wide", "overlaps": "lists", "search": "exact", "worklist": "all",
    "impact": "step_end", "precision": "double",
}  # fmt: skip
"""Policies that not all records name, each with its value in those that do not."""
COLUMN_OF = {"overlaps": "overlaps_kept"}
"""The columns of axes whose name in the record is that of a count, too."""
LATER_COLUMNS = [COLUMN_OF.get(name, name) for name in LATER_AXES]
WORK = ["overlaps", "pair_resolves", "pair_attempts", "sweeps"]
"""Totals over the S steps; `pair_attempts` is NaN where they were not counted."""
ERRORS = [
    "energy_drift", "discs_outside", "unresolved_pairs", "momentum_drift", "penetration_worst",
    "penetration_mean", "time_to_tenth_radius", "collision_rate", "collision_rate_reference", "pressure",
    "pressure_reference", "speed_distance",
]  # fmt: skip
LIMITS = [
    "file", "machine", "compiler", "limit", "threads", "level", "working_set_bytes", "lanes", "best",
    "median", "repetitions",
]  # fmt: skip
OUTSIDE = [
    "file", "machine", "scale", "experiment", "scene_name", "scene_sha256", "block", "session", "substeps",
    "engine", "seconds", "energy_drift",
]  # fmt: skip
NO_SCENE: dict[str, Any] = {"name": "", "sha256": "", **dict.fromkeys(SCENE)}
"""Of a program that is about something else than discs."""
_OLD_REPLICATE = re.compile(r"(?:(.*) )?replicate (\d+)")
CONTEXT = [
    "file", "kind", "question_kind", "recorded_at", *TAGS, *AXES, *LATER_COLUMNS, "scene",
    "scene_sha256", *SCENE, *PROVENANCE, "openmp", "openmp_runtime", "proc_bind", "environment",
    "warm_ups", "in_turns", "time_from", "undisturbed", "command", "compiler_family", "node", "machine",
    "revision",
]  # fmt: skip


def context(name: str, record: Record) -> dict[str, Any]:
    """Return where a record stands: its tags, axes, scene and origin, one column each.

    `machine` is what may be compared as one machine: the host with its CPU model or, under Slurm, the
    partition with its CPU model (`node` then tells its nodes apart). `revision` is the commit with the hash
    of what was changed on top of it.
    """
    tags, scene, origin = record["tags"], record["scene"] or NO_SCENE, record["provenance"]
    slurm = origin["slurm"] or {}
    changes = f" with changes {str(origin['diff_sha256'])[:8]}" if origin["dirty"] else ""
    return {
        "file": name,
        "kind": record["kind"],
        "question_kind": tags.get("kind", tags.get("figure")),
        "recorded_at": record["recorded_at"],
        **{column: tags.get(column) for column in TAGS},
        **_replicate(tags),
        "series": str(tags["series"]),
        "session": str(tags.get("session", "")),
        "scale": str(tags.get("scale", "unstated")),
        **{column: record["axes"].get(column) for column in AXES},
        **{COLUMN_OF.get(name, name): record["axes"].get(name, old) for name, old in LATER_AXES.items()},
        "scene": scene["name"],
        "scene_sha256": scene["sha256"],
        **{column: scene[column] for column in SCENE},
        **{column: origin[column] for column in PROVENANCE},
        "openmp": f"{origin['openmp']['runtime']} {origin['openmp']['version']}",
        "openmp_runtime": origin["openmp"]["runtime"],
        "proc_bind": origin["openmp"]["proc_bind"],
        "environment": " ".join(f"{k}={v}" for k, v in sorted(origin["openmp"]["environment"].items())),
        "warm_ups": record["warm_ups"],
        "in_turns": bool(record.get("turns")),
        "time_from": record.get("process", {}).get("time_from"),
        "undisturbed": record.get("process", {}).get("undisturbed"),
        "command": shlex.join(record["process"]["command"]) if record["kind"] == "process" else None,
        "compiler_family": _compiler_family(origin["compiler"]),
        "node": slurm.get("SLURMD_NODENAME", origin["host"]),
        "machine": machine_of(origin),
        "revision": f"{origin['commit'][:10]}{changes}" if origin["commit"] else "no commit known",
    }


def place(name: str, record: Record) -> dict[str, Any]:
    """Return where a record stands that is of no variant or program: a few columns of `context`."""
    tags = record["tags"]
    return {
        "file": name,
        "machine": machine_of(record["provenance"]),
        "experiment": tags.get("experiment"),
        **{column: str(tags.get(column, "")) for column in ("scale", "scene_name", "session")},
    }


def _replicate(tags: dict[str, Any]) -> dict[str, Any]:
    """Return the label and the number of the replicate, which was a word of the label before it was a tag."""
    label = tags.get("label")
    old = _OLD_REPLICATE.fullmatch(str(label)) if tags.get("figure") == "schedule" else None
    if "replicate" in tags or old is None:
        return {"label": label, "replicate": tags.get("replicate", 1)}
    return {"label": old[1] or None, "replicate": int(old[2])}


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


def runs(records: Placed) -> pd.DataFrame:
    """One row a record: context, work totals over the S steps, the check's verdict, and the error measures,
    NaN for those that were not asked for or not possible; `has_errors` tells who was asked.
    """
    rows = [
        {
            **context,
            **{column: record.get("work", {}).get(column) for column in WORK},
            **{column: (record.get("errors") or {}).get(column) for column in ERRORS},
            "has_errors": "trajectory" in (record.get("errors") or {}),
            "check_verdict": record["check"]["verdict"],
            "check_scope": record["check"]["scope"],
            "check_reason": record["check"]["reason"],
            "repetitions": len(record["repetitions"]),
            "process_seconds": record["process_seconds"],
        }
        for context, record in records
    ]
    checks = ["has_errors", "check_verdict", "check_scope", "check_reason", "repetitions", "process_seconds"]
    table = pd.DataFrame(rows, columns=[*CONTEXT, *WORK, *ERRORS, *checks])
    return table.astype(dict.fromkeys([*ERRORS, "pair_attempts"], float))


def _table(records: Placed, parts: Callable[[Record], Iterable[Record]], *columns: str) -> pd.DataFrame:
    """One row a part of a record: context, and these columns of the part."""
    rows = [{**context, **part} for context, record in records for part in parts(record)]
    return pd.DataFrame(rows, columns=[*CONTEXT, *columns])


def trajectory(records: Placed) -> pd.DataFrame:
    """One row a time at which a run was compared with the exact reference: context, `time`, `rms_distance`
    (in units of the radius).
    """
    table = _table(
        records, lambda record: (record.get("errors") or {}).get("trajectory") or [], "time", "rms_distance"
    )
    return table.astype({"rms_distance": float})


def times(records: Placed) -> pd.DataFrame:
    """One row a repetition of every timed run: context, `repetition`, `steps_seconds`, and `lost_by_turns`,
    the share of the process's time that coming back to cold caches took, NaN where not known. Of a whole
    process the seconds are its own, as seen from outside or as it says itself.
    """

    timed = [
        (context, record)
        for context, record in records
        if record["kind"] in ("bench", "process") and record["repetitions"]
    ]
    counts = [len(record["repetitions"]) for _, record in timed]
    # A context is made once a record and repeated as rows: there may be hundreds of repetitions in each.
    contexts = pd.DataFrame([context for context, _ in timed], columns=CONTEXT)
    table = contexts.take(np.repeat(np.arange(len(timed)), counts)).reset_index(drop=True)
    first = np.cumsum([0, *counts])[:-1]
    lost = np.full(len(table), np.nan)
    lost[first] = [_lost_by_turns(record) for _, record in timed]
    seconds = [float(one["steps_seconds"]) for _, record in timed for one in record["repetitions"]]
    numbers = np.arange(len(table)) - np.repeat(first, counts)
    return table.assign(repetition=numbers, steps_seconds=np.array(seconds, dtype=float), lost_by_turns=lost)


def _lost_by_turns(record: Record) -> float:
    """Return the share of a process's time, NaN where it is not known."""
    turns = record.get("turns") or {}
    if "returning_seconds" not in turns:
        return math.nan
    steps, rounds = record["scene"]["steps"], turns["rounds"]
    found = excess(turns["seconds"], turns["returning_seconds"], steps, rounds)
    return found.share if found else math.nan


def phases(records: Placed) -> pd.DataFrame:
    """One row a phase of every profiled run: context, `phase`, `wall_seconds`, `serial_seconds`."""
    return _table(records, _profiled("phases"), "phase", "wall_seconds", "serial_seconds")


def threads(records: Placed) -> pd.DataFrame:
    """One row a phase and thread of every profiled run: context, seconds busy and waiting."""
    return _table(records, _profiled("threads"), "phase", "thread", "busy_seconds", "waiting_seconds")


def counters(records: Placed) -> pd.DataFrame:
    """One row a counter and thread of every profiled run: context, `name`, `value` or `reason`, `remedy`."""
    columns = ("name", "thread", "value", "source", "reason", "remedy")
    return _table(records, _profiled("counters"), *columns)


def _profiled(part: str) -> Callable[[Record], Iterable[Record]]:
    return lambda record: record.get("profile", {}).get(part, []) if record["kind"] == "profile" else []


def limits(records: Named) -> pd.DataFrame:
    """One row a rate that a machine reached at most: `file`, `machine`, `compiler`, `limit` (copy or
    arithmetic), `threads`, `level` and `working_set_bytes` of a copy, `lanes` of arithmetic, `best` and
    `median` per second, `repetitions`.
    """
    rates = {"copy": "bytes_per_second", "arithmetic": "operations_per_second"}
    rows = [
        {
            "file": name,
            "machine": machine_of(record["provenance"]),
            "compiler": record["provenance"]["compiler"],
            "limit": limit,
            **row,
            **row[rate],
        }
        for name, record in records
        for limit, rate in rates.items()
        for row in record["limits"][limit]
    ]
    return pd.DataFrame(rows, columns=LIMITS)


def outside(records: Named) -> pd.DataFrame:
    """One row a run of a general engine beside the variants: where it stands, `engine` with its version,
    `seconds` for a unit of simulated time, and the size of its relative `energy_drift`.
    """
    rows = [
        {
            **place(name, record),
            "block": record["tags"].get("block"),
            "scene_sha256": record["scene"]["sha256"],
            "substeps": record["axes"]["substeps"],
            "engine": f"{record['engine']['name']} {record['engine']['version']}",
            "seconds": run["steps_seconds"] / record["scene"]["steps"],
            "energy_drift": record["errors"]["energy_drift"],
        }
        for name, record in records
        for run in record["repetitions"]
    ]
    table = pd.DataFrame(rows, columns=OUTSIDE)
    return table.assign(energy_drift=table["energy_drift"].astype(float).abs())


def failures(records: Named) -> pd.DataFrame:
    """One row a failed point: its tags, `command` (one line), `exit_code`, `reason`, `recorded_at`; `owner`,
    the partition or host that it failed on, and `program_sha256`, where the record tells them.
    """
    rows = [
        {
            "file": name,
            **{column: record["tags"].get(column) for column in TAGS},
            "command": " ".join(record["command"]),
            "exit_code": record["exit_code"],
            "reason": record["reason"],
            "recorded_at": record["recorded_at"],
            "owner": record["tags"].get("partition") or record["tags"].get("host"),
            "program_sha256": record["tags"].get("program_sha256"),
        }
        for name, record in records
    ]
    columns = ["command", "exit_code", "reason", "recorded_at", "owner", "program_sha256"]
    return pd.DataFrame(rows, columns=["file", *TAGS, *columns])
