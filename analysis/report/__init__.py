"""The report: one self-contained HTML page, and the same as PDF."""

import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from datetime import UTC, datetime
from io import StringIO
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from analysis.records.reading import load
from analysis.report.content import content
from analysis.support.wording import NO_BREAK
from support.files import replacing

TEMPLATE = "report.html.jinja"
SHOWN = ("svg", "png")
"""The formats of figures in the page and in the PDF; `analysis figures` draws PDF files as well."""

REMEDY = "apt install libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"


def write(results: Path, asked: Sequence[str] = (), *, pdf: bool = True) -> list[Path]:
    """Write `report.html` and, if wanted, `report.pdf` into the results folder from whatever records are
    there; return what was written. Questions that were `asked` by name lead.

    Draws the figures on the way. Without the libraries that the PDF needs, one line on standard error says
    so. A PDF that is not written anew is removed, since it would be outdated. A line tells each question
    asked that has no records. Raises InputError if there is no such folder.
    """
    records = load(results)
    present = {*records.runs["experiment"], *records.failures["experiment"]}
    for name in dict.fromkeys(asked):
        if name not in present:
            print(f"study: found no records of {name}, which does not lead the report", file=sys.stderr)
    gathered = content(records, results, asked, formats=SHOWN if pdf else SHOWN[:1])
    if not pdf:
        return [_write_html_alone(gathered, results)]
    return [_write_html(_page(gathered), results), *_write_pdf(gathered, results)]


def _write_html(page: str, results: Path) -> Path:
    html = results / "report.html"
    with replacing(html) as part:
        part.write_text(page, encoding="utf-8")
    return html


def _write_html_alone(gathered: dict[str, Any], results: Path, goes_on: str = "") -> Path:
    html = _write_html(_page(gathered, goes_on=goes_on), results)
    (results / "report.pdf").unlink(missing_ok=True)
    return html


def _write_pdf(gathered: dict[str, Any], results: Path) -> list[Path]:
    pdf = results / "report.pdf"
    try:
        # Imported late, and in silence: without Pango the import fails, and prints a banner first.
        with redirect_stdout(StringIO()):
            from weasyprint import HTML
        base = f"{results.resolve().as_uri()}/"
        document = HTML(string=_page(gathered, images=True), base_url=base).write_pdf()
    except (ImportError, OSError) as error:
        if getattr(error, "errno", None) is not None:
            raise  # of the disk: that a library cannot be loaded has no number
        why = " ".join(str(error).split())
        print(f"{pdf}: not written, only the HTML: {why} (WeasyPrint needs Pango; {REMEDY})", file=sys.stderr)
        pdf.unlink(missing_ok=True)
        return []
    with replacing(pdf) as part:
        part.write_bytes(document)
    return [pdf]


def write_meanwhile(results: Path, asked: Sequence[str], how_far: str) -> Path:
    """Write `report.html` alone, with what a study that goes on has so far, and say when and `how_far` it
    was; return it. An earlier PDF would be outdated, and is removed.
    """
    gathered = content(load(results), results, asked, formats=SHOWN[:1])
    return _write_html_alone(gathered, results, f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC, {how_far}")


def render(results: Path, asked: Sequence[str] = ()) -> str:
    """Return the report as one HTML page that needs nothing but itself."""
    return _page(content(load(results), results, asked, formats=("svg",)))


def _page(gathered: dict[str, Any], *, images: bool = False, goes_on: str = "") -> str:
    """Return the page; with `images`, figures are the PNG files beside it, which a PDF takes many times
    faster than SVG. `goes_on` tells when and how far it was written while the study goes on.
    """
    environment = Environment(
        loader=PackageLoader("analysis.report", "."),
        autoescape=select_autoescape(default=True),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(TEMPLATE).render(gathered, images=images, goes_on=goes_on, nbsp=NO_BREAK)
