"""Reads a results folder: every record validated, unreadable ones named and left out, the rest as tables."""

import contextlib
import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pandas as pd
from jsonschema.exceptions import best_match

from analysis.records import promises, tables
from support.errors import InputError
from support.files import finite, of_json
from support.record_schema import definition, is_record

NEEDED_TAGS = ["experiment", "series", "x_name", "x", "block"]
NUMERIC_TAGS = ["x", "block"]
TEXT_TAGS = ["experiment"]


MEASURED = ["runs", "times", "trajectory", "phases", "threads", "counters"]
"""The tables of what was measured of a variant or a program, each made by the function of that name."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Tables:
    """Records as tables, each with the columns that the function of its name tells.

    `runs` has a row per record, `times` per repetition of a timed run, `trajectory` per comparison with the
    reference, `phases` per phase and `threads` per phase and thread of a profiled run, `counters` per counter
    and thread, `limits` per rate that a machine reached at most, `outside` per run of a general engine
    beside the variants, `promises` per bound of an error, `failures` per failed point.
    """

    runs: pd.DataFrame
    times: pd.DataFrame
    trajectory: pd.DataFrame
    phases: pd.DataFrame
    threads: pd.DataFrame
    counters: pd.DataFrame
    limits: pd.DataFrame
    outside: pd.DataFrame
    promises: pd.DataFrame
    failures: pd.DataFrame


@dataclass(frozen=True, eq=False)
class Records(Tables):
    """One results folder as tables; `skipped` holds one line for every file that could not be counted."""

    skipped: list[str]


def load(results: Path, warn: Callable[[str], None] | None = None) -> Records:
    """Read `results/records/**.json` and `results/failures/**.json`.

    A file that is torn, foreign or of another schema version is passed to `warn` (default: standard error)
    as one line and is not counted. Raises InputError if `results` is not a folder.
    """
    if not results.is_dir():
        raise InputError(f"{results}: no such folder (records are made by `make experiments`)")
    skipped: list[str] = []
    records = [
        record
        for folder in ("records", "failures")
        for record in _readable(results, results / folder, folder == "failures", skipped)
    ]
    for line in skipped:
        warn(line) if warn else print(line, file=sys.stderr)
    measured, limits, outside, promised, failed = (
        [(path, record) for path, record in records if record["kind"] in kinds]
        for kinds in (("bench", "profile", "process"), ("limits",), ("outside",), ("promises",), ("failure",))
    )
    placed = [(tables.context(name, record), record) for name, record in measured]
    return Records(
        **{name: getattr(tables, name)(placed) for name in MEASURED},
        limits=tables.limits(limits),
        outside=tables.outside(outside),
        promises=promises.table(promised),
        failures=tables.failures(failed),
        skipped=skipped,
    )


def _readable(
    results: Path, folder: Path, failures: bool, skipped: list[str]
) -> Iterator[tuple[str, dict[str, Any]]]:
    seen: dict[str, str] = {}
    for path in sorted(folder.rglob("*.json")):
        name = path.relative_to(results).as_posix()
        try:
            content = path.read_bytes()
        except OSError as error:
            skipped.append(f"{path}: skipped: {error.strerror}")
            continue
        problem, record = _parse(content, failures)
        digest = hashlib.sha256(content).hexdigest()
        if problem is None and digest in seen:
            problem = f"the same record as {seen[digest]}"
        if problem is not None:
            skipped.append(f"{path}: skipped: {problem}")
            continue
        seen[digest] = name
        yield name, record


@cache
def _parse(content: bytes, failures: bool) -> tuple[str | None, dict[str, Any]]:
    """Return what is wrong with a file's content, or None and the record, which is not to be changed.

    Remembered by content: whoever loads a growing folder again and again pays for what is new.
    """
    with contextlib.suppress(ValueError):
        return _checked(of_json(content), failures)
    try:  # more slowly, for what is to be said of it
        return _checked(json.loads(content, parse_float=finite, parse_constant=finite), failures)
    except UnicodeDecodeError:
        return "not UTF-8 text", {}
    except json.JSONDecodeError as error:
        return f"not JSON (line {error.lineno}, column {error.colno}: {error.msg})", {}
    except ValueError as error:
        return f"not JSON ({error})", {}
    except RecursionError:
        return "not a Carom record (nested too deeply)", {}


def _checked(record: Any, failures: bool) -> tuple[str | None, dict[str, Any]]:  # noqa: ANN401 - any JSON
    if not isinstance(record, dict) or "schema_version" not in record:
        return "not a Carom record (no schema_version)", {}
    expected = definition().schema["properties"]["schema_version"]["const"]  # type: ignore[index]
    if record["schema_version"] != expected:
        return f"schema version {record['schema_version']!r}, expected {expected}", {}
    if not is_record(record):
        violation = best_match(definition().iter_errors(record))
        told = (
            f"{violation.json_path}: {_shortened(violation.message)}" if violation else "not a Carom record"
        )
        return told, {}
    return _wrong_tag(record, failures), record


def _shortened(message: str, limit: int = 160) -> str:
    line = " ".join(message.split())
    return line if len(line) <= limit else f"{line[: limit // 2]} ... {line[-limit // 2 :]}"


def _wrong_tag(record: dict[str, Any], failures: bool) -> str | None:
    if failures != (record["kind"] == "failure"):
        return f"a record of kind {record['kind']!r} in the wrong folder"
    tags = record["tags"]
    if record["kind"] == "limits":
        return None
    for name in NEEDED_TAGS[:1] if failures else NEEDED_TAGS:
        if name not in tags:
            return f"$.tags.{name}: missing"
        if name in NUMERIC_TAGS and isinstance(tags[name], str):
            return f"$.tags.{name}: found {tags[name]!r}, expected a number"
        if name in TEXT_TAGS and not isinstance(tags[name], str):
            return f"$.tags.{name}: found {tags[name]!r}, expected a text"
    return None
