"""The figures of the report, in its order: those of the published questions, from `figures.toml`, then
those of all other experiments, by the kind that their records name. `comparisons`, `sweeps`, `profiles` and
`errors` make rows of a study and draw them with `kinds`, `labels`, `style`; `captions` puts them into words.
"""

import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.claims.entry import Evidence, evidence_of
from analysis.derived.accuracy import MEASURES
from analysis.derived.ways import KIND as WAYS
from analysis.figures import comparisons, errors, profiles, sweeps
from analysis.figures.style import VERMILLION, Drawing, partial, save, styled
from analysis.records.reading import load
from analysis.records.studies import Study
from analysis.support.parallel import in_parallel
from analysis.support.values import Table, rows_in
from support.errors import InputError
from support.vocabulary import PAUSES

SPECIFICATIONS = Path(__file__).parent / "figures.toml"
SPEED_AGAINST_ERROR, HARD_CASES = OF_ERRORS = ("speed_against_error", "hard_cases")
"""The kinds of experiments about errors, whose figures have a part of the report of their own."""

KINDS: dict[str, Callable[..., Drawing | None]] = {
    "scaling": sweeps.scaling,
    "trend": sweeps.trend,
    "comparison": comparisons.comparison,
    "control": comparisons.comparison,
    "schedule": sweeps.schedule,
    "machine": comparisons.machines,
    "phases": profiles.profile,
    "ladder": profiles.waterfall,
    "limits": profiles.phases_against_limits,
    WAYS: comparisons.ways,
    PAUSES: comparisons.pauses,
    SPEED_AGAINST_ERROR: errors.speed_against_error,
    HARD_CASES: errors.hard_cases,
}
"""How an experiment is drawn, given its name and subject, by its tag `figure`."""

OF_ONE_QUESTION: dict[str, Callable[..., Drawing | None]] = {
    "oversubscription": sweeps.oversubscription,
    "timeline": profiles.timeline,
    "counters": profiles.panels,
}
"""The kinds that `figures.toml` may name besides."""

OF_TIMES = ("scaling", "trend", "comparison", "control", "schedule", "oversubscription")
"""The kinds that draw times of the study, and are told of none."""


@dataclass(frozen=True)
class Entry:
    """A figure: its file's name, the experiment whose records it draws, its title, its kind, what its caption
    begins with, and what else the function of that kind is told.
    """

    name: str
    title: str
    kind: str
    subject: str
    experiment: str
    more: Mapping[str, Any] = field(default_factory=dict)

    def draw(self, data: Evidence) -> Drawing | None:
        """Draw it, or return None where the study has no records for it."""
        if self.kind in OF_TIMES and data.study.times_of(self.experiment).empty:
            return None
        return (KINDS | OF_ONE_QUESTION)[self.kind](data, self.experiment, self.subject, **self.more)


@dataclass(frozen=True)
class Drawn:
    """A figure that was drawn, with its files and what the report says of it."""

    entry: Entry
    caption: str
    files: list[Path]
    verdicts: pd.DataFrame | None = None
    tables: Sequence[Table] = ()


def _entries(
    name: str,
    title: str,
    kind: str,
    subject: str,
    experiment: str = "",
    **more: Any,  # noqa: ANN401
) -> list[Entry]:
    """Return the entries of a table of `figures.toml`: one, or one for each measure of the errors."""
    entry = Entry(name, title, kind, subject, experiment or name, more)
    if kind != SPEED_AGAINST_ERROR:
        return [entry]
    return [
        replace(entry, name=f"{name}-{one.key}", title=f"{title}: {one.title}", more={"measure": one})
        for one in MEASURES
    ]


FIGURES = [entry for entries in rows_in(SPECIFICATIONS, "figure", _entries) for entry in entries]


def draw(data: Evidence, wanted: Sequence[str] = (), *, pdf: bool = False) -> Iterator[Drawn]:
    """Draw every figure that the study has records for, or those of the experiments wanted, into the folder
    `figures` of its results.

    Each is written as SVG, and as `pdf` if wanted, and marked as partial where planned records are missing.
    Several are drawn at once, one on each processor.
    """
    known = [*FIGURES, *further(data.study)]
    entries = [entry for entry in known if not wanted or entry.experiment in wanted]
    comparisons.bias_sentence(
        data.study
    )  # before there are several processes, of which each would work it out
    yield from filter(None, in_parallel(lambda number: _draw(entries[number], data, pdf=pdf), len(entries)))


def draw_all(results: Path, wanted: Sequence[str] = (), *, pdf: bool = False) -> list[Drawn]:
    """Load a results folder and draw into its `figures/`, all experiments or those wanted, as SVG and, if
    wanted, as `pdf`.

    Raises InputError for an experiment that is neither one of the published questions nor in the records.
    """
    records = load(results)
    names = list(dict.fromkeys([*titles(), *sorted(records.runs["experiment"])]))
    for name in wanted:
        if name not in names:
            raise InputError(f"--experiment: found {name!r}, expected one of {', '.join(names)}")
    return [figure for data in evidence_of(results, records) for figure in draw(data, wanted, pdf=pdf)]


def _draw(entry: Entry, data: Evidence, *, pdf: bool) -> Drawn | None:
    name = f"{data.prefix}{entry.name}"
    with styled(name):
        drawing = entry.draw(data)
    if drawing is None:
        if entry not in FIGURES and entry.kind not in OF_ERRORS:
            found = f"{entry.experiment}: not drawn: found figure {entry.kind!r}"
            print(f"{found}, has no records for it", file=sys.stderr)
        return None
    caption, missing = drawing.caption, partial(data, entry.experiment)
    if missing:
        # A title of the whole figure is given room of its own by the layout, unlike a text.
        look: Any = {"ha": "right", "fontsize": 7, "color": VERMILLION, "weight": "bold"}
        drawing.figure.suptitle(missing, x=0.995, **look)
        caption += f" {missing.capitalize()}."
    if drawing.verdicts is not None and data.study.times_of(entry.experiment)["in_turns"].all():
        caption += comparisons.bias_sentence(data.study)
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
    if kind not in KINDS:
        expected = f"expected a tag figure out of {', '.join(KINDS)}"
        print(f"{experiment}: not drawn: found figure {kind!r}, {expected}", file=sys.stderr)
        return []
    name = re.sub(r"[^\w.-]", "_", experiment)
    if name in {entry.name for entry in FIGURES}:
        name = f"experiment-{name}"
    return _entries(name, title or experiment, kind, title or experiment, experiment)
