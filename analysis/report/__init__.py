"""The report: one self-contained HTML page."""

import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from jinja2 import Environment, select_autoescape

from analysis.claims import summary
from analysis.derived import ways
from analysis.figures import errors
from analysis.figures.captions import environment
from analysis.records.reading import load
from analysis.report.content import content
from analysis.support.wording import NO_BREAK
from support.files import replacing

TEMPLATE = "report.html.jinja"
TOLD_BY = (ways, errors, summary)
"""Modules whose functions say things in the page."""


def templates() -> Environment:
    """Return what renders the page and its parts."""
    escaped = select_autoescape(default=True)
    made = environment("analysis.report", *TOLD_BY, autoescape=escaped, trim_blocks=True, lstrip_blocks=True)
    made.globals["nbsp"] = NO_BREAK
    return made


def write(results: Path, asked: Sequence[str] = (), how_far: str = "") -> Path:
    """Write `report.html` into the results folder from whatever records are there, and return it. Questions
    that were `asked` by name lead. `how_far` is told, with the time, in that of a study that goes on.

    Draws the figures on the way. A line tells each question asked that has no records, if the study does not
    go on. Raises InputError if there is no such folder.
    """
    records = load(results)
    present = {*records.runs["experiment"], *records.failures["experiment"]}
    for name in dict.fromkeys(asked):
        if name not in present and not how_far:
            print(f"study: found no records of {name}, which does not lead the report", file=sys.stderr)
    goes_on = f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC, {how_far}" if how_far else ""
    gathered = content(records, results, asked)
    page = templates().get_template(TEMPLATE).render(gathered, goes_on=goes_on)
    html = results / "report.html"
    with replacing(html) as part:
        part.write_text(page, encoding="utf-8")
    return html
