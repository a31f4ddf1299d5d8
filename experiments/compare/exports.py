"""The result as files: everything as JSON, a row a run as CSV, a table as Markdown."""

import csv
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from experiments.compare.answer import Answer
from experiments.compare.blocks import Key, Runs
from experiments.compare.options import Asked
from experiments.compare.texts import markdown
from support.errors import InputError
from support.files import replacing, require_room_for_folder

SCHEMA_VERSION = 1


def require_places(exports: Mapping[str, Path]) -> None:
    """Raises InputError, before anything is measured, for a file that cannot be written."""
    for kind, path in exports.items():
        require_room_for_folder(f"--export-{kind}", path.absolute().parent)
        if path.is_dir():
            raise InputError(f"--export-{kind}: found {path}, which is a folder, expected a place for a file")


def write(asked: Asked, answer: Answer, runs: Mapping[Key, Runs], machine: str, said: Sequence[str]) -> None:
    """Write what was asked for, each file whole or not at all."""
    for kind, path in asked.exports.items():
        text = {
            "json": lambda: _json(asked, answer, runs, machine),
            "csv": lambda: _csv(asked, runs),
            "markdown": lambda: markdown(asked, answer, runs, machine, said),
        }[kind]()
        with replacing(path) as part:
            part.write_text(text, encoding="utf-8")


def _json(asked: Asked, answer: Answer, runs: Mapping[Key, Runs], machine: str) -> str:
    """Seconds and bytes, a value a block; ratios are of times, command over reference."""
    content = {
        "schema_version": SCHEMA_VERSION,
        "machine": machine,
        "reference": asked.reference,
        "margin": asked.margin,
        "error": asked.error,
        "withdrawn": answer.is_withdrawn,
        "cases": asked.cases,
        "commands": [{"name": one.name, "line": one.line, "words": one.words} for one in asked.commands],
        "differences": [asdict(one) for one in answer.commands],
        "controls": [asdict(one) for one in answer.controls],
        "places": [asdict(one) for one in answer.places],
        "runs": [
            {"command": name, "case": case, "seconds": one.seconds, "cores": one.cores, "bytes": one.bytes}
            for (name, case), one in runs.items()
        ],
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _csv(asked: Asked, runs: Mapping[Key, Runs]) -> str:
    """A row a run."""
    output = io.StringIO()
    writer = csv.writer(output, lineterminator="\n")
    writer.writerow(["command", "case", "block", "seconds", "cores"])
    for (name, case), one in runs.items():
        called = asked.cases[case] if asked.cases else ""
        for block, row in enumerate(zip(one.seconds, one.cores, strict=True)):
            writer.writerow([name, called, block, *row])
    return output.getvalue()
