"""The figures of a study as parts of the report, one a question, and the list of contents."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from markupsafe import Markup

from analysis.derived.accuracy import MEASURES, errors
from analysis.figures import HARD_CASES, OF_ERRORS, SPEED_AGAINST_ERROR, Drawn
from analysis.records.studies import Study
from analysis.report.answers import Answer, answer, questions
from analysis.report.provenance import commands
from analysis.report.words import tell

PHASES = "phases"


@dataclass(frozen=True)
class Part:
    """What the report shows of one question: its `title`, the `question` itself, the answer to it, sentences,
    figures, and the commands that repeat its points. The anchor of a part with one figure is the figure's.
    """

    experiment: str
    anchor: str
    title: str
    question: str
    answer: Answer
    said: Sequence[str]
    figures: Sequence[Mapping[str, Any]]
    commands: Sequence[str]


def parts(study: Study, drawn: Sequence[Drawn], claims: Sequence[Mapping[str, Any]] = ()) -> list[Part]:
    """Return a part for each question that was drawn: where the time goes, the others in the order of the
    figures, those about errors last. Where `claims` (rows of `claims.evaluate`) are about it, they answer it.
    """
    found = [
        _part(study, [one for one in drawn if one.entry.experiment == experiment], claims)
        for experiment in dict.fromkeys(one.entry.experiment for one in drawn)
    ]
    kinds = {one.entry.experiment: one.entry.kind for one in drawn}
    order = {kind: number for number, kind in enumerate(OF_ERRORS, start=1)}
    return sorted(found, key=lambda part: (part.experiment != PHASES, order.get(kinds[part.experiment], 0)))


def _part(study: Study, drawn: Sequence[Drawn], claims: Sequence[Mapping[str, Any]]) -> Part:
    entry = drawn[0].entry
    said: Sequence[str] = ()
    title = entry.title
    if entry.kind == SPEED_AGAINST_ERROR:
        title, said = title.partition(":")[0], _errors(study, entry.experiment)
    elif entry.kind == HARD_CASES:
        said = [tell("hard_cases")]
    elif entry.experiment == PHASES:
        title = "Where the time goes"
    figures = [_figure(one) for one in drawn]
    name = str(figures[0]["name"])
    return Part(
        entry.experiment,
        f"part-{name}" if len(figures) > 1 or said else name,
        title,
        questions().get(entry.experiment, title),
        answer(study, entry.experiment, drawn, claims),
        said,
        figures,
        commands(study.runs_of(entry.experiment)),
    )


def _errors(study: Study, experiment: str) -> list[str]:
    """Say of an experiment of speed against error how far paths can be compared, and which measures were 0
    throughout and so have no figure.
    """
    measured = errors(study, experiment)
    zeros = [measure.title for measure in MEASURES if (measured[measure.key] == 0).all()]
    said = [f"{tell('errors')} {horizons(study, experiment)}"]
    return [*said, f"Zero in every run, and so without a figure: {', '.join(zeros)}."] if zeros else said


def horizons(study: Study, experiment: str) -> str:
    """Say how far single paths can be compared with the exact ones before chaos ends it, from the records;
    nothing without any.
    """
    runs = errors(study, experiment).dropna(subset=["path"])
    scenes = [
        _horizon(part) for _, part in runs.sort_values("area_fraction").groupby("scene_name", sort=False)
    ]
    return tell("horizons", scenes=scenes) if scenes else ""


def _horizon(runs: pd.DataFrame) -> dict[str, Any]:
    """Return until when the paths of a scene's fewest and most substeps can be compared: the latest time,
    over the series, None for one that is never within the run; and the `rate` of collisions.
    """
    ends = {}
    for substeps in (runs["substeps"].min(), runs["substeps"].max()):
        times = runs.loc[runs["substeps"] == substeps, "time_to_tenth_radius"]
        ends[substeps] = None if times.isna().any() else times.max()
    rate = runs["collision_rate_reference"].median()
    return {"scene": runs["scene_name"].iloc[0], "ends": ends, "rate": None if np.isnan(rate) else rate}


def _figure(figure: Drawn) -> dict[str, Any]:
    return {
        "name": figure.files[0].stem,
        "title": figure.entry.title,
        "caption": figure.caption,
        "verdicts": [] if figure.verdicts is None else list(figure.verdicts.itertuples()),
        "tables": figure.tables,
        "svg": Markup(inline(figure.files[0].read_text(encoding="utf-8"), figure.files[0].stem)),
    }


def inline(svg: str, name: str) -> str:
    """Return an SVG file's root element, free to take the width that the page gives it.

    Its identifiers get the figure's name in front, since a page may hold each only once.
    """
    root = svg[svg.index("<svg") :]
    end = root.index(">")
    head = re.sub(r'\s(width|height)="[^"]*"', "", root[:end])
    return head + re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", root[end:])


def contents(study: Mapping[str, Any]) -> list[tuple[str, str, Answer | None]]:
    """Return the study's list of contents: the anchor and the title of each of its places, in their order.
    With each question stands what it came to.
    """
    anchor = study["anchor"]
    claims = [(f"{anchor}-claims", "The claims, tested again", None)] if sum(study["states"].values()) else []
    return [
        *map(_entry, study["asked"]),
        *claims,
        (f"{anchor}-machine", "The machine and the programs", None),
        (f"{anchor}-trust", "Can these numbers be trusted?", None),
        *map(_entry, study["trust"]),
        *map(_entry, study["parts"]),
    ]


def _entry(part: Part) -> tuple[str, str, Answer | None]:
    return part.anchor, part.title, part.answer
