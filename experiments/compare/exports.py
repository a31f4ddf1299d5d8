"""The result as files: everything as JSON, a row a run as CSV, a table as Markdown, a page as HTML."""

import csv
import io
import json
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from experiments.compare.commands import Compared
from experiments.compare.found import Found
from experiments.compare.pages import markdown, page, title
from experiments.plan.executable import found as file_of
from experiments.plan.executable import is_file
from support.command_line import print_lines
from support.errors import InputError, cannot
from support.files import descriptor_of, require_place, write_out

SCHEMA_VERSION = 2


def require_places(
    exports: Mapping[str, Path], earlier: Path | None, commands: Sequence[Compared] = ()
) -> None:
    """Raises InputError, before anything is measured, for a file that cannot be written, for two of one name,
    and for one that a command has among its words.
    """
    places = {f"--export-{kind}": path for kind, path in exports.items()}
    for option, path in places.items():
        require_place(option, path)
    seen: dict[object, str] = {}
    for option, path in {**places, **({"--append": earlier} if earlier else {})}.items():
        place = _place(path)
        if place in seen:
            raise InputError(f"{option}: found {path}, which {seen[place]} names too, expected another file")
        seen[place] = option
    for one in commands:
        words = [part for word in one.words for part in (word, *word.split())]
        for word in words:
            file = file_of(word.strip("'\""), one.folder)
            used = _place(file)
            if used in seen:
                raise InputError(
                    f"{seen[used]}: found {word}, which {one.called} uses, expected another file"
                )


def _place(path: Path) -> object:
    """What tells a file from others, whatever name it has."""
    there = path.stat() if is_file(path) else None
    return descriptor_of(path) or ((there.st_dev, there.st_ino) if there is not None else path.resolve())


def write(found: Found, said: list[str], first: str, draw: Callable[[], Path]) -> None:
    """Write what was asked for, each file whole or not at all: `said` are the lines of the result, `first` is
    the verdict in a line if it is another than the usual one, `draw` makes the picture. Once all others are
    written, raises the OSError or InputError of the one that cannot be, or InputError with those of several.
    """
    first = first or title(found)
    again = shlex.join(["carom", *sys.argv[1:]])
    errors: list[OSError | InputError] = []
    for kind, path in found.asked.exports.items():
        try:
            text = {
                "json": lambda: _json(found),
                "csv": lambda: _csv(found),
                "markdown": lambda: markdown(found, said, first, again),
                "html": lambda: page(found, said, first, again, draw() if found.answer.commands else None),
            }[kind]()
            write_out(path, text)
        except (OSError, InputError) as error:
            errors.append(error)
    if len(errors) > 1:
        raise InputError("; ".join(cannot(one) if isinstance(one, OSError) else str(one) for one in errors))
    if errors:
        raise errors[0]


def tell(said: list[str], exports: Mapping[str, Path]) -> None:
    """Print the lines of the result; beside standard output where an export is written there."""
    is_taken = any(descriptor_of(path) == 1 for path in exports.values())
    print_lines(said, sys.stderr if is_taken else sys.stdout)


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
        "clock": answer.clock,
        "cases": asked.cases,
        "rounds": asked.rounds,
        "seconds": found.seconds,
        "blocks": found.blocks,
        "blocks_before": found.before,
        "commands": [{"name": one.name, "line": one.line, "words": one.words} for one in asked.commands],
        "differences": [asdict(one) for one in answer.commands],
        "differences_by_wall": [asdict(one) for one in found.by_wall],
        "controls": [asdict(one) for one in answer.controls],
        "places": [asdict(one) for one in answer.places],
        "effects": [asdict(one) for one in answer.effects],
        "remarks": found.remarks,
        "looks": [asdict(one) for one in found.looks],
        "runs": [
            {
                "command": name,
                "case": case,
                "blocks": one.blocks,
                "seconds": one.seconds,
                "cores": one.cores,
                "bytes": one.bytes,
            }
            | {"counts": one.counts, "exit_codes": one.codes, "failed": one.reason or None}
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
        for row in zip(one.blocks, one.seconds, one.cores, strict=True):
            writer.writerow([name, called, *row])
    return output.getvalue()
