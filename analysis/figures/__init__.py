"""The figures of the report, in its order: those of the published questions, from a table, then those of all
other experiments, by the kind that their records name.
"""

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial as bound
from pathlib import Path

import pandas as pd

from analysis import claims
from analysis.derived.accuracy import MEASURES
from analysis.derived.ways import KIND, bias_sentence
from analysis.figures import comparisons, errors, ladder, pairs, profiles, scaling, sweeps
from analysis.figures.captions import growth_sentence, linear_sentence, minimum_sentence
from analysis.figures.style import Data, Drawing, mark_partial, partial, save, styled
from analysis.records.studies import Study
from analysis.support.parallel import in_parallel
from analysis.support.values import Table
from support.vocabulary import PAUSES


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


def _of_kind(
    name: str, title: str, draw: Callable[..., Drawing | None], subject: str, **more: object
) -> Entry:
    return Entry(name, name, title, bound(draw, experiment=name, subject=subject, **more))


def _own(name: str, title: str, draw: Callable[[Data], Drawing | None], experiment: str = "") -> Entry:
    return Entry(name, experiment or name, title, draw)


def _over(experiment: str, title: str, label: str, describe: Callable[[pd.DataFrame], str]) -> Entry:
    subject = f"Time over the {label}"
    return _of_kind(experiment, title, sweeps.trend, subject, label=label, describe=describe)


def _pair(
    experiment: str, title: str, candidate: str, reference: str, subject: str,
    names: tuple[str, str] | None = None, *, work: bool = False,
) -> Entry:  # fmt: skip
    series = candidate, reference
    named = dict(zip(series, names or series, strict=True))
    return _of_kind(experiment, title, pairs.pair_drawing, subject, names=named, work=work)


def _schedule(experiment: str, title: str, subject: str) -> Entry:
    """Return the entry of schedules, with the one that a published claim says is to be chosen."""
    told = next(claim.arguments for claim in claims.load() if experiment in claim.experiments)
    chosen = (told["schedule"], told["chunk"])
    return _of_kind(experiment, title, sweeps.schedule, subject, chosen=chosen)


def _counted(name: str, title: str, source: str, subject: str) -> Entry:
    return Entry(name, "phases", title, bound(profiles.panels, source=source, subject=subject))


def _accuracy(kind: str, experiment: str, name: str, title: str) -> list[Entry]:
    """Return the entries of an experiment about errors: one figure, or one for each measure."""
    if kind == HARD_CASES:
        drawn = bound(errors.hard_cases, experiment=experiment, subject=title)
        return [Entry(name, experiment, title, drawn, kind)]
    drawn = bound(errors.draw, experiment=experiment, subject=title)
    return [
        Entry(f"{name}-{one.key}", experiment, f"{title}: {one.title}", bound(drawn, measure=one), kind)
        for one in MEASURES
    ]


SPEED_AGAINST_ERROR, HARD_CASES = OF_ERRORS = ("speed_against_error", "hard_cases")
"""The kinds of experiments about errors, whose figures have a part of the report of their own."""

_EARLY = "Resolving self-contained pairs early, on against off, under the"

FIGURES = [
    _pair("control", "Control: the same variant twice", "A-again", "A",
          "The same variant under two labels", ("A again", "A")),
    _of_kind("ways", "In turns, and in processes of their own", comparisons.ways,
             "The same comparisons both ways"),
    _of_kind("ways_of_processes", "Whole processes in slices, and alone", comparisons.ways,
             "The same whole processes both ways"),
    _of_kind("threads", "Threads", scaling.scaling, "Time, speed-up and efficiency over threads"),
    _own("oversubscription", "More threads than the machine has", scaling.oversubscription),
    _of_kind("machine", "Machines", comparisons.machines, "One scene on every machine"),
    _over("particles", "Number of discs", "number of discs", growth_sentence),
    _own("grid_length", "Side length", sweeps.grid_length),
    _over("radius", "Radius", "radius of a disc", minimum_sentence),
    _own("density", "Area fraction", sweeps.density),
    _over("steps", "Steps", "number of steps", linear_sentence),
    _over("min_velocity", "Least velocity", "least velocity component", growth_sentence),
    _over("max_velocity", "Greatest velocity", "greatest velocity component", growth_sentence),
    _pair("neighbourhood", "Four boxes against nine", "four", "nine",
          "Four boxes against nine", ("four boxes", "nine boxes")),
    _pair("self_contained_checkered", "Self-contained resolves, checkered", "on", "off",
          f"{_EARLY} checkered order"),
    _pair("self_contained_track", "Self-contained resolves, sequential (track)", "on", "off",
          f"{_EARLY} sequential order (track)"),
    _pair("self_contained_repeat", "Self-contained resolves, sequential (repeat)", "on", "off",
          f"{_EARLY} sequential order (repeat)"),
    _of_kind("sequential_orders", "Sequential orders", comparisons.comparison,
             "The sequential resolve orders", published=comparisons.published_orders),
    _schedule("schedule_find", "Schedule for finding overlaps", "Schedules for finding overlaps"),
    _schedule("schedule_resolve", "Schedule for the checkered resolve",
              "Schedules for the checkered resolve"),
    _schedule("schedule_resolve_row", "Schedule for the row resolve", "Schedules for the row resolve"),
    _own("row", "Row against checkered", sweeps.row),
    _pair("reverse", "Reverse against forward", "reverse", "forward",
          "A disc's overlaps in reverse against forward", work=True),
    _pair("compiler", "Compilers", "clang++ with libomp", "g++ with libomp",
          "The same source by two compilers"),
    _of_kind("ladder", "The ladder from the published best to the fastest variant", ladder.waterfall,
             "From the published best to the fastest variant"),
    _of_kind("phases", "The phases of a step", profiles.profile, "Where the time of a step goes"),
    _of_kind("limits", "How close to the limits of the machine", profiles.phases_against_limits,
             "Phases of a step against the limits of this machine"),
    _own("timeline", "A step on every thread", profiles.timeline, "phases"),
    _counted("counters_hardware", "Hardware counters", "papi-hardware", "Hardware counters (PAPI)"),
    _counted("counters_software", "Software counters", "papi-software", "Software counters (PAPI)"),
    _counted("counters_usage", "Resource usage", "rusage", "Resource usage (getrusage)"),
    _counted("counters_simulated", "Simulated counters", "cachegrind",
             "Simulated counters (cachegrind, one thread)"),
    *_accuracy(SPEED_AGAINST_ERROR, "speed_against_error", "speed_against_error", "Speed against error"),
    *_accuracy(HARD_CASES, "hard_cases", "hard_cases", "Hard cases"),
]  # fmt: skip

KINDS: dict[str, Callable[[Data, str, str], Drawing | None]] = {
    "scaling": scaling.scaling,
    "trend": sweeps.trend,
    "comparison": comparisons.comparison,
    "control": comparisons.comparison,
    "schedule": sweeps.schedule,
    "machine": comparisons.machines,
    "phases": profiles.profile,
    "ladder": ladder.waterfall,
    "limits": profiles.phases_against_limits,
    KIND: comparisons.ways,
    PAUSES: comparisons.pauses,
}
"""How an experiment without a figure of its own is drawn, given its name and title, by its tag `figure`."""


def draw(data: Data, wanted: Sequence[str] = (), *, pdf: bool = False) -> Iterator[Drawn]:
    """Draw every figure that the study has records for, or those of the experiments wanted, into the folder
    `figures` of its results.

    Each is written as SVG, and as `pdf` if wanted, and marked as partial where planned records are missing.
    Several are drawn at once, one on each processor.
    """
    known = [*FIGURES, *further(data.study)]
    entries = [entry for entry in known if not wanted or entry.experiment in wanted]
    bias_sentence(data.study)  # before there are several processes, of which each would work it out
    yield from filter(None, in_parallel(lambda number: _draw(entries[number], data, pdf=pdf), len(entries)))


def _draw(entry: Entry, data: Data, *, pdf: bool) -> Drawn | None:
    name = f"{data.prefix}{entry.name}"
    with styled(name):
        drawing = entry.draw(data)
    if drawing is None:
        return None
    missing = partial(data, entry.experiment)
    mark_partial(drawing.figure, missing)
    caption = f"{drawing.caption} {missing[0].upper()}{missing[1:]}." if missing else drawing.caption
    if drawing.verdicts is not None and data.study.times_of(entry.experiment)["in_turns"].all():
        caption += bias_sentence(data.study)
    files = save(drawing, data.folder / "figures", name, pdf=pdf)
    return Drawn(entry, caption, files, drawing.verdicts, drawing.tables)


def further(study: Study) -> list[Entry]:
    """Return an entry for every experiment of the study that has no figure of its own, by name."""
    runs = study.runs[~study.runs["experiment"].isin(titles())]
    return [entry for name, group in runs.groupby("experiment") for entry in _further(str(name), group)]


def titles() -> dict[str, str]:
    """Return the experiments that have a figure of their own, each with the title of its first one."""
    first = {entry.experiment: entry.title for entry in reversed(FIGURES)}
    return {entry.experiment: first[entry.experiment] for entry in FIGURES}


def _further(experiment: str, runs: pd.DataFrame) -> list[Entry]:
    latest = runs.sort_values("recorded_at", kind="stable").iloc[-1]
    title, kind = (str(latest[tag]) if pd.notna(latest[tag]) else "" for tag in ("title", "figure"))
    title = title or experiment
    name = re.sub(r"[^\w.-]", "_", experiment)
    if name in {entry.name for entry in FIGURES}:
        name = f"experiment-{name}"
    if kind in OF_ERRORS:
        return _accuracy(kind, experiment, name, title)
    return [Entry(name, experiment, title, bound(_by_kind, experiment, title, kind))]


def _by_kind(experiment: str, title: str, kind: str, data: Data) -> Drawing | None:
    drawing = KINDS[kind](data, experiment, title) if kind in KINDS else None
    if drawing is None:
        kinds = ", ".join([*KINDS, *OF_ERRORS])
        why = "has no records for it" if kind in KINDS else f"expected a tag figure out of {kinds}"
        print(f"{experiment}: not drawn: found figure {kind!r}, {why}", file=sys.stderr)
    return drawing
