"""Everything that the report says, gathered from the records; the template only lays it out."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from analysis import claims
from analysis.claims import missing
from analysis.claims.entry import CLAIMS_FILE
from analysis.derived.accuracy import MEASURES, errors
from analysis.derived.ladder import headlines
from analysis.derived.noise_prior import prior
from analysis.figures import FIGURES, HARD_CASES, SPEED_AGAINST_ERROR, Drawn, experiments
from analysis.figures.studies import draw_study
from analysis.records import published
from analysis.records.reading import Records
from analysis.records.studies import Study, split
from analysis.report import provenance
from analysis.report.horizons import horizons
from analysis.statistics.intervals import RANKS_FROM
from analysis.statistics.levels import in_order, levels, shifting
from analysis.statistics.looks import ERROR
from analysis.statistics.noise import needed_said, process_noise, warning
from analysis.statistics.pairs import log_ratios, process_medians
from analysis.statistics.verdicts import MARGIN, judge_one
from analysis.support.wording import blocks, change, count, number, share

STYLE = Path(__file__).parent / "report.css"
CONTROL = "control"


def content(records: Records, results: Path) -> dict[str, Any]:
    """Return the template's variables; draws the figures into the results folder."""
    studies = split(records)
    parts = [_study(study, studies, results) for study in studies]
    return {
        "style": Markup(STYLE.read_text(encoding="utf-8")),
        "margin": share(MARGIN),
        "error": share(ERROR),
        "ranks_from": RANKS_FROM,
        "records": len(records.runs),
        "latest": records.runs["recorded_at"].max() if len(records.runs) else None,
        "studies": parts,
        "unmeasured": [] if (results / CLAIMS_FILE.name).exists() else _unmeasured(records.runs),
        "missing_counters": provenance.missing_counters(records.counters),
        "failures": records.failures.to_dict("records"),
        "wrong": records.runs[records.runs["check_verdict"] == "failed"].to_dict("records"),
        "skipped": records.skipped,
        "verbs": provenance.verbs(records.runs),
        "commands": provenance.commands(records.runs),
    }


def _study(study: Study, studies: Sequence[Study], results: Path) -> dict[str, Any]:
    drawn = draw_study(study, studies, results)
    table = claims.evaluate(study, studies, published.load(), claims.load(results))
    if study is not studies[0]:
        table = table[~table["missing"]]
    noise = process_noise(study.times)
    return {
        "name": study.name,
        "machine": provenance.machine(study),
        "figures": [
            _figure(figure)
            for figure in drawn
            if figure.entry.experiment not in (CONTROL, "phases") and not figure.entry.kind
        ],
        "errors": _errors(study, drawn),
        "hard_cases": [_figure(figure) for figure in drawn if figure.entry.kind == HARD_CASES],
        "trust": [_figure(figure) for figure in drawn if figure.entry.experiment == CONTROL],
        "phases": [_figure(figure) for figure in drawn if figure.entry.experiment == "phases"],
        "control": control_sentence(study),
        "headlines": headlines(study),
        "warning": warning(noise),
        "noise": [_noise_row(row) for row in noise.to_dict("records")],
        "checks": provenance.checks(study),
        "claims": table.to_dict("records"),
        "states": missing.tally(table),
        "tally": table["verdict"].value_counts().to_dict(),
    }


def _errors(study: Study, drawn: Sequence[Drawn]) -> list[dict[str, Any]]:
    """Return for each experiment of speed against error how far paths can be compared, its figures, and the
    measures that were 0 throughout and so have no figure.
    """
    figures = [figure for figure in drawn if figure.entry.kind == SPEED_AGAINST_ERROR]
    parts = []
    for experiment in dict.fromkeys(figure.entry.experiment for figure in figures):
        own = [figure for figure in figures if figure.entry.experiment == experiment]
        measured = errors(study, experiment)
        zeros = [measure.title for measure in MEASURES if (measured[measure.key] == 0).all()]
        parts.append(
            {
                "horizons": horizons(study, experiment),
                "zeros": zeros,
                "figures": [_figure(one) for one in own],
            }
        )
    return parts


def control_sentence(study: Study) -> str:
    """Say what came of the control, the same variant measured under two labels."""
    processes = process_medians(study.times_of(CONTROL))
    sides = [part for _, part in processes.groupby("label")]
    if len(sides) != 2:
        return "The control (one variant, two labels) was not measured: nothing vouches for the rest."
    return f"{_control_verdict(study, processes, sides)}{_speeds(processes)}"


def _speeds(processes: pd.DataFrame) -> str:
    """Say that the machine has two speeds, or one that shifts, if the control's times show it: no count of
    bursts does.
    """
    times = in_order(processes)
    found = levels(times)
    if found is not None:
        said = (
            f"has two speeds, a factor of {number(found.factor, 2)} apart: {found.slow} of the {found.times} "
            f"runs of the control were slow, and it changed {count(found.changes, 'time')} between them"
        )
    elif shifting(times):
        said = (
            f"shifts its speed: the same run took {number(times.min())} to {number(times.max())} s, and runs "
            "close in time took alike"
        )
    else:
        return ""
    return (
        f" The machine {said}. What is compared was in part measured at unlike speeds: intervals are wider."
    )


def _control_verdict(study: Study, processes: pd.DataFrame, sides: Sequence[pd.DataFrame]) -> str:
    row = judge_one(log_ratios(*sides)["log_ratio"], prior=prior(study, CONTROL))
    sessions, beside = study.times["session"].nunique(), processes["session"].nunique()
    over = "the whole run" if beside == sessions else f"{beside} of {count(sessions, 'session')}"
    said = f"one variant, measured under two labels over {over}, differs by {change(row)} ({blocks(row)})"
    if row["verdict"] == "equivalent":
        return f"The control came out equivalent, as it must: {said}."
    if row["verdict"] == "inconclusive":
        return (
            f"The control is inconclusive: {said}. Differences of a few per cent cannot be told apart here."
        )
    return (
        f"The control FAILED: {said} and was judged {row['verdict']}. Only the label differs, so do not "
        "trust the verdicts below: measure again on a quiet machine."
    )


def _noise_row(row: dict[str, Any]) -> dict[str, Any]:
    return {**row, "noise": share(row["noise"], 2), "needed": needed_said(row["needed"])}


def _figure(figure: Drawn) -> dict[str, Any]:
    return {
        "name": figure.files[0].stem,
        "title": figure.entry.title,
        "caption": figure.caption,
        "verdicts": _verdicts(figure),
        "tables": figure.tables,
        "svg": Markup(inline(figure.files[0].read_text(encoding="utf-8"), figure.files[0].stem)),
    }


def _verdicts(figure: Drawn) -> list[dict[str, str]]:
    rows = [] if figure.verdicts is None else figure.verdicts.to_dict("records")
    return [
        {"name": row["name"], "change": change(row), "blocks": blocks(row), "verdict": row["verdict"]}
        for row in rows
    ]


def inline(svg: str, name: str) -> str:
    """Return an SVG file's root element, free to take the width that the page gives it.

    Its identifiers get the figure's name in front, since a page may hold each only once.
    """
    root = svg[svg.index("<svg") :]
    end = root.index(">")
    head = re.sub(r'\s(width|height)="[^"]*"', "", root[:end])
    return head + re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", root[end:])


def _unmeasured(runs: pd.DataFrame) -> list[dict[str, str]]:
    """Return the experiments without any record, with the command that would measure each."""
    titles = {entry.experiment: entry.title for entry in reversed(FIGURES)}
    present = set(runs["experiment"])
    return [
        {"title": titles[name], "command": f"make experiments STUDY={name}"}
        for name in experiments()
        if name not in present
    ]
