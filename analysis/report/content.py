"""Everything that the report says, gathered from the records; the template only lays it out."""

import re
from collections.abc import Collection, Mapping, Sequence
from html import escape, unescape
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from analysis import claims
from analysis.claims import missing, summary
from analysis.claims.entry import CLAIMS_FILE, Evidence, evidence_of, questions_folder
from analysis.figures import Drawn, draw, titles
from analysis.records.reading import Records
from analysis.records.studies import Study
from analysis.report import all_claims, first_screen, graphs, provenance
from analysis.report.parts import contents, inline, parts
from analysis.report.words import tell
from analysis.statistics.looks import ERROR
from analysis.statistics.noise import in_order, levels, needed_said, process_noise, shifting, warning
from analysis.statistics.verdicts import INCONCLUSIVE, MARGIN
from analysis.support.wording import share
from support.vocabulary import CONTROL

STYLE = Path(__file__).parent / "report.css"


def content(records: Records, results: Path, asked: Sequence[str] = ()) -> dict[str, Any]:
    """Return the template's variables; draws the figures into the results folder.

    Questions that were `asked` by name lead; without any, all of them were.
    """
    own = (results / CLAIMS_FILE.name).exists()
    found = [_study(data, asked) for data in evidence_of(results, records)]
    # A study that has what was asked comes before one that has not.
    found.sort(key=lambda study: bool(asked) and not study["asked"])
    for position, study in enumerate(found, start=1):
        study["anchor"] = f"study-{position}"
        study["contents"] = contents(study)
    shown = [part for study in reversed(found) for part in (*study["asked"], *study["parts"])]
    told = {part.experiment for study in found for part in (*study["trust"], *shown)}
    return {
        "style": Markup(STYLE.read_text(encoding="utf-8")),
        "margin": share(MARGIN),
        "error": share(ERROR),
        "records": len(records.runs),
        "latest": records.runs["recorded_at"].max() if len(records.runs) else None,
        "studies": found,
        "own": own,
        "graphs": [] if own else graphs.rows({part.experiment: part.anchor for part in shown}),
        "unmeasured": [] if own else _unmeasured(records.runs),
        "missing_counters": provenance.missing_counters(records.counters),
        "failures": records.failures.to_dict("records"),
        "wrong": records.runs[records.runs["check_verdict"] == "failed"].to_dict("records"),
        "skipped": records.skipped,
        "verbs": provenance.verbs(records, questions_folder(results)),
        "scale": _scale(records.runs),
        "commands": [
            {"experiment": name, "commands": provenance.commands(runs)}
            for name, runs in records.runs.groupby("experiment")
            if name not in told
        ],
    }


def _study(data: Evidence, asked: Collection[str]) -> dict[str, Any]:
    study, is_first = data.study, data.study is data.studies[0]
    drawn = list(draw(data))
    table = claims.evaluate(data)
    told = table if is_first else table[~table["missing"]]
    rows = table.to_dict("records")
    shown = parts(study, drawn, rows)
    places = {part.experiment: (part.anchor, part.title) for part in shown}
    for row in rows:
        row["places"] = [places[name] for name in row["experiments"] if name in places]
        row["anchor"] = _anchor(row, data.prefix)
    noise, settled = process_noise(study.times), _settled(table, drawn)
    return {
        "name": study.name,
        "machine": provenance.machine(study),
        "asked": [part for part in shown if part.experiment in asked and part.experiment != CONTROL],
        "parts": [part for part in shown if part.experiment not in (*asked, CONTROL)],
        "trust": [part for part in shown if part.experiment == CONTROL],
        "control": control_sentence(study),
        "warning": warning(noise, settled),
        "noise": [_noise_row(row, settled) for row in noise.to_dict("records")],
        "checks": provenance.checks(study),
        "partners": provenance.partners(study),
        "states": missing.tally(told),
        **_claims(rows, asked),
        "prefix": data.prefix,
        "said": first_screen.sentences(study, rows, drawn),
        "figure": _all_claims(*all_claims.draw(data, table), rows),
        "beside": first_screen.beside(study, missing.tally(told)),
        "without_records": list(told.loc[told["missing"], "id"]),
    }


def _claims(rows: Sequence[Mapping[Any, Any]], asked: Collection[str]) -> dict[str, Any]:
    """Return the claims that have records, those asked about first, and how many have each verdict."""
    present = [row for row in rows if not row["missing"]]
    present.sort(key=lambda row: bool(asked) and not set(row["experiments"]) & set(asked))
    tally = pd.Series([row["verdict"] for row in present]).value_counts().to_dict()
    return {"claims": present, "tally": tally}


def _anchor(row: Mapping[Any, Any], prefix: str) -> str:
    """Return where a claim leads to: the section of its first question that was drawn, or its row in the
    table; the whole table where it has none.
    """
    if row["places"]:
        return str(row["places"][0][0])
    return f"{prefix}claims-table" if row["missing"] else f"{prefix}claim-{row['id']}"


def _all_claims(
    caption: str, files: Sequence[Path], rows: Sequence[Mapping[Any, Any]]
) -> dict[str, Any] | None:
    """Return the figure of all claims, wide and narrow, whose rows lead to their sections and tell their
    verdicts when the pointer rests on them.
    """
    if not files:
        return None
    by_id = {row["id"]: row for row in rows}

    def link(found: re.Match[str]) -> str:
        row = by_id[unescape(found[1])]
        said = escape(f"{row['claim']} {summary.mark(row)} {summary.verdict_in_short(row)}")
        return f'<a href="#{row["anchor"]}"><title>{said}</title>'

    pictures = []
    for file in files:
        svg = inline(file.read_text(encoding="utf-8"), file.stem)
        pictures.append(Markup(re.sub(r'<a xlink:href="\.\./report\.html#claim-([^"]+)"[^>]*>', link, svg)))
    return {"name": files[0].stem, "caption": caption, "wide": pictures[0], "narrow": pictures[1]}


def _settled(table: pd.DataFrame, drawn: Sequence[Drawn]) -> set[str]:
    """Return the experiments that have verdicts, in a figure or of a claim, none of which is open."""
    decided, still_open = table["verdict"].isin(missing.DECIDED), table["needed"].notna()
    settled, unsettled = (set(table.loc[rows, "experiments"].explode()) for rows in (decided, still_open))
    for figure in drawn:
        if figure.verdicts is not None and len(figure.verdicts):
            inconclusive = (figure.verdicts["verdict"] == INCONCLUSIVE).any()
            (unsettled if inconclusive else settled).add(figure.entry.experiment)
    return settled - unsettled


def control_sentence(study: Study) -> str:
    """Say what came of the control, the same variant measured under two labels, and that the machine has two
    speeds, or one that shifts, if the control's times show it.
    """
    verdict, row = first_screen.control_of(study)
    processes = study.times_of(CONTROL)
    times = in_order(processes) if verdict else pd.Series(dtype=float)
    shifts = len(times) > 0 and shifting(times)
    return tell(
        "control", verdict=verdict, row=row, sessions=study.times["session"].nunique(),
        beside=processes["session"].nunique(), speeds=levels(times) if len(times) else None,
        ends=(times.min(), times.max()) if shifts else None,
    )  # fmt: skip


def _noise_row(row: dict[str, Any], settled: Collection[str]) -> dict[str, Any]:
    if row["enough"]:
        said = "enough"
    elif not row["small"]:
        said = "a trend"
    else:
        said = "settled all the same" if row["experiment"] in settled else "too few for small differences"
    return {**row, "noise": share(row["noise"], 2), "needed": needed_said(row["needed"]), "said": said}


def _scale(runs: pd.DataFrame) -> str:
    """Return ` SCALE=` where all records are of one scale that is not the default."""
    scales = set(runs["scale"])
    return "" if len(scales) != 1 or scales <= {"paper", "unstated"} else f" SCALE={min(scales)}"


def _unmeasured(runs: pd.DataFrame) -> list[dict[str, str]]:
    """Return the name and the title of each published question without any record."""
    present = set(runs["experiment"])
    return [{"name": name, "title": title} for name, title in titles().items() if name not in present]
