"""Draws the figures of every study in a results folder."""

import re
from collections.abc import Sequence
from pathlib import Path

from analysis.figures import Drawn, draw, titles
from analysis.figures.style import Data
from analysis.records import published
from analysis.records.reading import load
from analysis.records.studies import Study, split
from support.errors import InputError


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
    studies = split(records)
    return [figure for study in studies for figure in draw_study(study, studies, results, wanted, pdf=pdf)]


def draw_study(
    study: Study, studies: Sequence[Study], results: Path, wanted: Sequence[str] = (), *, pdf: bool = False
) -> list[Drawn]:
    """Draw one study; the files of any but the first carry its name."""
    data = Data(study, studies, published.load(), results)
    return list(draw(data, results / "figures", prefix_of(study, studies), wanted, pdf=pdf))


def prefix_of(study: Study, studies: Sequence[Study]) -> str:
    """Return what the names of a study's files begin with: nothing of the first one."""
    return "" if study is studies[0] else f"{slug(study.name)}-"


def slug(name: str) -> str:
    """Return the name as part of a file name."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
