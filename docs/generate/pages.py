"""The generated pages, by their place below `docs/reference/`."""

from collections.abc import Callable, Mapping
from pathlib import Path

from docs.generate import command_line, first_day, questions, records
from support.files import replacing
from support.home import ROOT

FOLDER = ROOT / "docs" / "reference"
PROGRAM = ROOT / "build" / "gcc" / "carom"

PAGES: Mapping[str, Callable[[], str]] = {
    "command_line.md": lambda: command_line.render(PROGRAM),
    "faults.md": first_day.render,
    "questions.md": questions.render,
    "records.md": records.render,
}


def write() -> list[Path]:
    """Write all pages anew; returns their files. Raises OSError, and CalledProcessError for the program."""
    FOLDER.mkdir(exist_ok=True)
    files = []
    for name, render in PAGES.items():
        text = render()
        with replacing(FOLDER / name) as part:
            part.write_text(text, encoding="utf-8")
        files.append(FOLDER / name)
    return files
