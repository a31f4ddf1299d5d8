"""Draws the figures of every study in a results folder."""

from collections.abc import Sequence
from pathlib import Path

from analysis.claims.entry import evidence_of
from analysis.figures import Drawn, draw, titles
from analysis.figures.style import Data
from analysis.records.reading import Records, load
from support.errors import InputError


def data_of(results: Path, records: Records | None = None) -> list[Data]:
    """Return what the figures of each study of a results folder may draw from, the one to show first at the
    front; its `records` are read if they are not given.
    """
    found = evidence_of(load(results) if records is None else records)
    return [Data(one.study, one.studies, one.published, results) for one in found]


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
    return [figure for data in data_of(results, records) for figure in draw(data, wanted, pdf=pdf)]
