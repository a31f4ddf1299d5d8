"""The figures of the report, in its order: those of the published questions, one function each, then those
of all other experiments, by the kind that their records name.
"""

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial as bound
from pathlib import Path

import pandas as pd

from analysis.derived.accuracy import MEASURES
from analysis.figures import (
    comparisons,
    counters,
    grid_length,
    hard_cases,
    ladder,
    limits,
    machines,
    orders,
    pairs,
    phases,
    scaling,
    schedules,
    speed_against_error,
    sweeps,
    timeline,
)
from analysis.figures.style import Data, Drawing, Table, mark_partial, partial, save, styled
from analysis.records.studies import Study
from analysis.support.parallel import in_parallel


@dataclass(frozen=True)
class Entry:
    """A figure: its file's name, the experiment whose records it draws, its title, and its function."""

    name: str
    experiment: str
    title: str
    draw: Callable[[Data], Drawing | None]
    kind: str = ""


@dataclass(frozen=True)
class Drawn:
    """A figure that was drawn, with its files and what the report says of it."""

    entry: Entry
    caption: str
    files: list[Path]
    verdicts: pd.DataFrame | None = None
    tables: Sequence[Table] = ()


def _entry(title: str, draw: Callable[[Data], Drawing | None], experiment: str = "") -> Entry:
    return Entry(draw.__name__, experiment or draw.__name__, title, draw)


def _accuracy(kind: str, experiment: str, name: str, title: str) -> list[Entry]:
    """Return the entries of an experiment about errors: a figure a measure, or the one of the hard cases."""
    if kind == HARD_CASES:
        return [
            Entry(
                name,
                experiment,
                title,
                bound(hard_cases.hard_cases, experiment=experiment, subject=title),
                kind,
            )
        ]
    return [
        Entry(
            f"{name}-{measure.key}", experiment, f"{title}: {measure.title}",
            bound(speed_against_error.draw, experiment=experiment, subject=title, measure=measure), kind,
        )
        for measure in MEASURES
    ]  # fmt: skip


SPEED_AGAINST_ERROR, HARD_CASES = "speed_against_error", "hard_cases"
"""The kinds of experiments about errors, whose figures have a part of the report of their own."""

FIGURES = [
    _entry("Control: the same variant twice", pairs.control),
    _entry("Threads", scaling.threads),
    _entry("More threads than the machine has", scaling.oversubscription),
    _entry("Machines", machines.machine),
    _entry("Number of discs", sweeps.particles),
    _entry("Side length", grid_length.grid_length),
    _entry("Radius", sweeps.radius),
    _entry("Area fraction", sweeps.density),
    _entry("Steps", sweeps.steps),
    _entry("Least velocity", sweeps.min_velocity),
    _entry("Greatest velocity", sweeps.max_velocity),
    _entry("Four boxes against nine", pairs.neighbourhood),
    _entry("Self-contained resolves, checkered", pairs.self_contained_checkered),
    _entry("Self-contained resolves, sequential (track)", pairs.self_contained_track),
    _entry("Self-contained resolves, sequential (repeat)", pairs.self_contained_repeat),
    _entry("Sequential orders", orders.sequential_orders),
    _entry("Schedule for finding overlaps", schedules.schedule_find),
    _entry("Schedule for the checkered resolve", schedules.schedule_resolve),
    _entry("Schedule for the row resolve", schedules.schedule_resolve_row),
    _entry("Row against checkered", orders.row),
    _entry("Reverse against forward", pairs.reverse),
    _entry("Compilers", pairs.compiler),
    _entry("The ladder from the published best to the fastest variant", ladder.ladder),
    _entry("The phases of a step", phases.phases),
    _entry("How close to the limits of the machine", limits.limits),
    _entry("A step on every thread", timeline.timeline, "phases"),
    _entry("Hardware counters", counters.counters_hardware, "phases"),
    _entry("Software counters", counters.counters_software, "phases"),
    _entry("Resource usage", counters.counters_usage, "phases"),
    _entry("Simulated counters", counters.counters_simulated, "phases"),
    *_accuracy(SPEED_AGAINST_ERROR, "speed_against_error", "speed_against_error", "Speed against error"),
    *_accuracy(HARD_CASES, "hard_cases", "hard_cases", "Hard cases"),
]

KINDS: dict[str, Callable[[Data, str, str], Drawing | None]] = {
    "scaling": scaling.scaling,
    "trend": sweeps.trend,
    "comparison": comparisons.comparison,
    "control": comparisons.comparison,
    "schedule": schedules.schedule,
    "machine": machines.machines,
    "phases": phases.profile,
    "ladder": ladder.waterfall,
    "limits": limits.phases_against_limits,
}
"""How an experiment without a figure of its own is drawn, given its name and title, by its tag `figure`."""


def draw(data: Data, folder: Path, prefix: str = "", wanted: Sequence[str] = ()) -> Iterator[Drawn]:
    """Draw every figure that the study has records for, or those of the experiments wanted, into the folder.

    Each is written as SVG, PNG and PDF, and marked as partial where planned records are missing. Several are
    drawn at once, one on each processor.
    """
    known = [*FIGURES, *further(data.study)]
    entries = [entry for entry in known if not wanted or entry.experiment in wanted]

    def drawn(number: int) -> _Saved | None:
        return _draw(entries[number], data, folder, f"{prefix}{entries[number].name}")

    for entry, saved in zip(entries, in_parallel(drawn, len(entries)), strict=True):
        if saved is not None:
            yield Drawn(entry, *saved)


_Saved = tuple[str, list[Path], pd.DataFrame | None, Sequence[Table]]


def _draw(entry: Entry, data: Data, folder: Path, name: str) -> _Saved | None:
    with styled(name):
        drawing = entry.draw(data)
    if drawing is None:
        return None
    missing = partial(data.study, entry.experiment)
    mark_partial(drawing.figure, missing)
    caption = f"{drawing.caption} {missing[0].upper()}{missing[1:]}." if missing else drawing.caption
    return caption, save(drawing, folder, name), drawing.verdicts, drawing.tables


def further(study: Study) -> list[Entry]:
    """Return an entry for every experiment of the study that has no figure of its own, by name."""
    runs = study.runs[~study.runs["experiment"].isin(experiments())]
    return [entry for name, group in runs.groupby("experiment") for entry in _further(str(name), group)]


def experiments() -> Sequence[str]:
    """Return the names of the experiments that have a figure of their own."""
    return list(dict.fromkeys(entry.experiment for entry in FIGURES))


def _further(experiment: str, runs: pd.DataFrame) -> list[Entry]:
    latest = runs.sort_values("recorded_at", kind="stable").iloc[-1]
    title, kind = (str(latest[tag]) if pd.notna(latest[tag]) else "" for tag in ("title", "figure"))
    title = title or experiment
    name = re.sub(r"[^\w.-]", "_", experiment)
    if name in {entry.name for entry in FIGURES}:
        name = f"experiment-{name}"
    if kind in (SPEED_AGAINST_ERROR, HARD_CASES):
        return _accuracy(kind, experiment, name, title)
    return [Entry(name, experiment, title, bound(_by_kind, experiment, title, kind))]


def _by_kind(experiment: str, title: str, kind: str, data: Data) -> Drawing | None:
    drawing = KINDS[kind](data, experiment, title) if kind in KINDS else None
    if drawing is None:
        kinds = ", ".join([*KINDS, SPEED_AGAINST_ERROR, HARD_CASES])
        why = "has no records for it" if kind in KINDS else f"expected a tag figure out of {kinds}"
        print(f"{experiment}: not drawn: found figure {kind!r}, {why}", file=sys.stderr)
    return drawing
