"""Questions about programs of others, and what became of them."""

from pathlib import Path

from experiments.run.study import Study
from experiments.tests.conftest import Workplace

HEAD = 'title = "Programs"\nfigure = "comparison"\nthreads = 1\n'
BLOCKS = "[blocks]\nminimum = 2\nwanted = 2\n"


def script(place: Workplace, name: str, text: str, mode: int = 0o755) -> Path:
    """A program beside the questions, for the shell unless it begins otherwise."""
    path = place.root / "questions" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text if text.startswith("#!") else f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(mode)
    return path


def series(name: str, *lines: str) -> str:
    return "\n".join(["[[series]]", f'name = "{name}"', *lines, ""])


def ids(place: Workplace) -> list[str]:
    return [point.id for experiment in Study(place.settings).experiments for point in experiment.points]
