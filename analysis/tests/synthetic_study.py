"""A whole synthetic study: the records of every experiment, and what else a results folder may hold."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np

from analysis import report
from analysis.claims import evidence_of
from analysis.claims.entry import Evidence
from analysis.figures import Drawn
from analysis.figures.style import Drawing
from analysis.tests.synthetic import Machine, bench, failure, limits, profile, write
from analysis.tests.synthetic_noise import Noise
from analysis.tests.synthetic_points import EXPERIMENTS

PROFILED = ("phases", "limits")
COPY = {"L2": (1 << 20, 40e9), "L3": (4 << 20, 20e9), "memory": (2 << 30, 8e9)}
ARITHMETIC = 3e9
SHARES = {"move": 0.03, "bin": 0.12, "find": 0.3, "resolve": 0.55}


def study(
    names: Iterable[str] = EXPERIMENTS,
    blocks: int = 8,
    repetitions: int = 1,
    noise: Noise | None = None,
    machine: Machine | None = None,
    speed: float = 1.0,
    seed: int = 1,
    scale: str = "paper",
    threads: int | None = None,
) -> list[dict[str, Any]]:
    """Return the records of the named experiments, complete: every point in every block; all on `threads`, if
    given.
    """
    generator = np.random.default_rng(seed)
    names = list(names)
    records = []
    for name in names:
        points = EXPERIMENTS[name]()
        if threads is not None:
            points = [replace(point, axes=point.axes | {"threads": threads}) for point in points]
        truth = np.array([point.seconds for point in points]) / speed
        samples = (noise or Noise()).seconds(generator, truth, blocks, repetitions)
        for point, rows in zip(points, samples, strict=True):
            for block, seconds in enumerate(rows):
                record = bench(
                    name, point, block, seconds, machine or Machine(),
                    scale=scale, points_planned=len(points), blocks_planned=blocks, figure=figure_of(name),
                )  # fmt: skip
                records.append(profile(record, SHARES, counters(record)) if name in PROFILED else record)
    if "limits" in names:
        records.append(limits(machine or Machine(), COPY, ARITHMETIC))
    return records


def under(experiment: str, records: Iterable[dict[str, Any]], **tags: str) -> list[dict[str, Any]]:
    """Return the records under another name, which nothing in this package knows, and with these tags."""
    return [record | {"tags": record["tags"] | {"experiment": experiment, **tags}} for record in records]


def slowed(records: list[dict[str, Any]], factor: float, **tags: object) -> list[dict[str, Any]]:
    """Return the records with those of some tags made slower by a factor."""
    for record in records:
        if all(record["tags"][key] == value for key, value in tags.items()):
            for repetition in record["repetitions"]:
                repetition["steps_seconds"] *= factor
    return records


def data_in(folder: Path, records: Iterable[dict[str, Any]]) -> Evidence:
    """Write records into a folder, and return what the figures of their first study may draw from."""
    write(folder, records)
    return evidence_of(folder)[0]


def page_of(results: Path, asked: Sequence[str] = ()) -> str:
    """Return the report of a folder."""
    return report.write(results, asked).read_text(encoding="utf-8")


def tables_of(drawing: Drawing | Drawn) -> dict[str, list[list[str]]]:
    """Return the tables that follow a figure as the page has them, by title: rows of texts, the first names
    the columns. What has a mark ends in it, in brackets.
    """
    macros = report.templates().get_template("tables.jinja").module
    cell = r'<t[hd](?: class="(\w+)")?>(.*?)</t[hd]>'
    html = unescape("".join(getattr(macros, name)(**facts) for name, facts in drawing.tables))
    found = {}
    for title, table in re.findall(r'<p class="table">(.*?)</p>(.*?)</table>', html, re.DOTALL):
        rows = (re.findall(cell, row, re.DOTALL) for row in table.split("</tr>")[:-1])
        found[title] = [[f"{text} [{mark}]" if mark else text for mark, text in row] for row in rows]
    return found


def figure_of(experiment: str) -> str:
    """Return how an experiment is drawn, as its records say."""
    points = EXPERIMENTS[experiment]()
    own = ("control", "machine", *PROFILED, "ladder", "speed_against_error", "hard_cases")
    if experiment in own:
        return experiment
    if any(point.in_turns for point in points):
        return "ways"
    kinds = {"none": "comparison", "chunk": "schedule", "threads": "scaling"}
    return kinds.get(points[0].x_name, "trend")


def counters(record: dict[str, Any]) -> list[dict[str, Any]]:
    """Return counters per thread of every source but the hardware, which this machine cannot count."""
    missing = {"value": None, "reason": "virtual machine without a PMU", "remedy": "run on bare metal"}
    known = {"reason": None, "remedy": None}
    rows: list[dict[str, Any]] = [
        {"name": "PAPI_TOT_CYC", "thread": None, "source": "papi-hardware", **missing},
        {"name": "maximum_resident_bytes", "thread": None, "value": 2**26, "source": "rusage", **known},
    ]
    software = {"perf::TASK-CLOCK": 1e9, "perf::CONTEXT-SWITCHES": 40, "perf::PAGE-FAULTS": 4000}
    usage = {"user_seconds": 1.0, "system_seconds": 0.01, "minor_page_faults": 4000}
    for thread in range(record["axes"]["threads"]):
        for source, values in (("papi-software", software), ("rusage", usage)):
            for name, value in values.items():
                row = {"name": name, "thread": thread, "value": value * (1 + thread / 10), "source": source}
                rows.append(row | known)
    return rows


def trace(title: str, chunks: int, steps: int = 3, threads: int = 2) -> dict[str, Any]:
    """Return a timeline in the Trace Event format as the program writes it, times in microseconds."""
    events: list[dict[str, Any]] = []

    def span(name: str, thread: int, begin: float, duration: float) -> None:
        events.append({"name": name, "ph": "X", "pid": 1, "tid": thread, "ts": begin, "dur": duration})

    now = 0.0
    for _ in range(steps):
        for phase, part in SHARES.items():
            length = 10_000 * part
            span(phase, 0, now, length)
            for thread in range(threads):
                busy = 0.9 * length * (1 - 0.2 * thread)
                span(f"{phase} loop", thread, now, busy)
                span("wait", thread, now + busy, 0.9 * length - busy)
                for chunk in range(chunks):
                    span(f"{phase} chunk", thread, now + busy * chunk / chunks, busy / chunks)
            now += length
    return {
        "displayTimeUnit": "ms",
        "otherData": {"title": title, "spans_left_out": 0},
        "traceEvents": events,
    }


def failures() -> list[dict[str, Any]]:
    """Return the record of one point that failed its check."""
    return [
        failure("sequential_orders", "once", "step 3: discs 1 and 2 are still colliding"),
        failure("hard_cases", "row", "step 2: disc 4 left moving into the wall", scene_name="corner"),
    ]
