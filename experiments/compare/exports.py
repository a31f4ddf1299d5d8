"""The result as files: everything as JSON, a row a run as CSV, a table as Markdown, a page as HTML."""

import csv
import io
import json
import shlex
import sys
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path

from experiments.compare.found import Found
from experiments.compare.pages import markdown, page, title
from support.errors import InputError
from support.files import replacing, require_room_for_folder

SCHEMA_VERSION = 1


def require_places(exports: Mapping[str, Path]) -> None:
    """Raises InputError, before anything is measured, for a file that cannot be written."""
    for kind, path in exports.items():
        require_room_for_folder(f"--export-{kind}", path.absolute().parent)
        if path.is_dir():
            raise InputError(f"--export-{kind}: found {path}, which is a folder, expected a place for a file")


def write(found: Found, said: list[str], first: str, draw: Callable[[], Path]) -> None:
    """Write what was asked for, each file whole or not at all: `said` are the lines of the result, `first` is
    the verdict in a line if it is another than the usual one, `draw` makes the picture.
    """
    first = first or title(found)
    again = shlex.join(["carom", *sys.argv[1:]])
    for kind, path in found.asked.exports.items():
        text = {
            "json": lambda: _json(found),
            "csv": lambda: _csv(found),
            "markdown": lambda: markdown(found, said, first, again),
            "html": lambda: page(found, said, first, again, draw() if found.answer.commands else None),
        }[kind]()
        with replacing(path) as part:
            part.write_text(text, encoding="utf-8")


def _json(found: Found) -> str:
    """Seconds, bytes and counts of one run, a value a block; ratios are of times, command over reference."""
    asked, answer = found.asked, found.answer
    content = {
        "schema_version": SCHEMA_VERSION,
        "machine": found.machine,
        "processors_of_others": found.others,
        "reference": asked.reference,
        "margin": asked.margin,
        "error": asked.error,
        "withdrawn": answer.is_withdrawn,
        "cases": asked.cases,
        "in_a_row": asked.in_a_row,
        "seconds": found.seconds,
        "blocks": found.blocks,
        "blocks_before": found.before,
        "commands": [{"name": one.name, "line": one.line, "words": one.words} for one in asked.commands],
        "differences": [asdict(one) for one in answer.commands],
        "controls": [asdict(one) for one in answer.controls],
        "places": [asdict(one) for one in answer.places],
        "effects": [asdict(one) for one in answer.effects],
        "looks": [asdict(one) for one in found.looks],
        "runs": [
            {"command": name, "case": case, "seconds": one.seconds, "cores": one.cores, "bytes": one.bytes}
            | {"counts": one.counts}
            for (name, case), one in found.runs.items()
        ],
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _csv(found: Found) -> str:
    """A row a run."""
    output = io.StringIO()
    writer = csv.writer(output, lineterminator="\n")
    writer.writerow(["command", "case", "block", "seconds", "cores"])
    for (name, case), one in found.runs.items():
        called = found.asked.cases[case] if found.asked.cases else ""
        for block, row in enumerate(zip(one.seconds, one.cores, strict=True)):
            writer.writerow([name, called, block, *row])
    return output.getvalue()
