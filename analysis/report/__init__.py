"""The report: one self-contained HTML page, and the same as PDF."""

import sys
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from analysis.records.reading import load
from analysis.report.content import content
from analysis.support.files import replacing

TEMPLATE = "report.html.jinja"
REMEDY = "apt install libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"


def write(results: Path) -> list[Path]:
    """Write `report.html` and `report.pdf` into the results folder from whatever records are there; return
    what was written.

    Draws the figures on the way. Without the libraries that the PDF needs, one line on standard error says so
    and an earlier, now outdated PDF is removed. Raises InputError if there is no such folder.
    """
    gathered = content(load(results), results)
    html, pdf = results / "report.html", results / "report.pdf"
    with replacing(html) as part:
        part.write_text(_page(gathered), encoding="utf-8")
    try:
        document = _pdf(_page(gathered, images=True), results)
    except (ImportError, OSError) as error:
        if getattr(error, "errno", None) is not None:
            raise  # of the disk: that a library cannot be loaded has no number
        why = " ".join(str(error).split())
        print(f"{pdf}: not written, only the HTML: {why} (WeasyPrint needs Pango; {REMEDY})", file=sys.stderr)
        pdf.unlink(missing_ok=True)
        return [html]
    with replacing(pdf) as part:
        part.write_bytes(document)
    return [html, pdf]


def _pdf(page: str, folder: Path) -> bytes:
    # Imported late, and in silence: without Pango the import fails, and prints a banner first.
    with redirect_stdout(StringIO()):
        from weasyprint import HTML
    data: bytes = HTML(string=page, base_url=f"{folder.resolve().as_uri()}/").write_pdf()
    return data


def render(results: Path) -> str:
    """Return the report as one HTML page that needs nothing but itself."""
    return _page(content(load(results), results))


def _page(gathered: dict[str, Any], *, images: bool = False) -> str:
    """Return the page; with `images`, figures are files beside it, quicker to lay out for a PDF."""
    environment = Environment(
        loader=PackageLoader("analysis.report", "."),
        autoescape=select_autoescape(default=True),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(TEMPLATE).render(gathered, images=images)
