"""The result as files: everything as JSON, a row a run as CSV, a table as Markdown."""

import csv
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from experiments.compare.answer import Answer
from experiments.compare.blocks import Runs
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


def write(
    asked: Asked,
    answer: Answer,
    runs: Mapping[str, Runs],
    machine: str,
    said: Sequence[str],
) -> None:
    """Write what was asked for, each file whole or not at all."""
    for kind, path in asked.exports.items():
        text = {
            "json": lambda: _json(asked, answer, runs, machine),
            "csv": lambda: _csv(runs),
            "markdown": lambda: markdown(asked, answer, runs, machine, said),
        }[kind]()
        with replacing(path) as part:
            part.write_text(text, encoding="utf-8")


def _json(asked: Asked, answer: Answer, runs: Mapping[str, Runs], machine: str) -> str:
    """Seconds and bytes; ratios of times, command over reference."""
    content = {
        "schema_version": SCHEMA_VERSION,
        "machine": machine,
        "reference": asked.reference,
        "margin": asked.margin,
        "error": asked.error,
        "withdrawn": answer.is_withdrawn,
        "commands": [
            {"name": one.name, "line": one.line, "words": one.words, **_of(runs[one.name])}
            for one in asked.commands
        ],
        "differences": [asdict(one) for one in answer.commands],
        "control": {
            **(asdict(answer.control) if answer.control else {}),
            **{
                key: value
                for name, one in runs.items()
                for key, value in _of(one).items()
                if _is_extra(name, asked)
            },
        },
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _is_extra(name: str, asked: Asked) -> bool:
    return name not in {one.name for one in asked.commands}


def _of(runs: Runs) -> dict[str, list[float]]:
    return {"seconds": runs.seconds, "cores": runs.cores, "bytes": runs.bytes}


def _csv(runs: Mapping[str, Runs]) -> str:
    """A row a run: `command`, `block`, `seconds`, `cores`."""
    output = io.StringIO()
    writer = csv.writer(output, lineterminator="\n")
    writer.writerow(["command", "block", "seconds", "cores"])
    for name, one in runs.items():
        writer.writerows(
            [name, *row] for row in zip(range(len(one.seconds)), one.seconds, one.cores, strict=True)
        )
    return output.getvalue()
