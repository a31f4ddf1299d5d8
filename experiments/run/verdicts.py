"""What the analysis says so far: what is settled, how many blocks the rest needs, and the report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from experiments.support.interrupts import signals_held


@dataclass(frozen=True)
class Open:
    """An experiment in which something is open: the `blocks` it has, the `next` number at which the analysis
    looks again, and those `needed` to settle the first thing in it.
    """

    blocks: int
    next: int
    needed: int


@dataclass(frozen=True)
class Verdicts:
    """What is `open` by experiment, which experiments are `settled`, and what was `said` of each decision."""

    open: Mapping[str, Open] = field(default_factory=dict)
    settled: frozenset[str] = frozenset()
    said: Mapping[str, str] = field(default_factory=dict)


class Analysis:
    """The analysis of a folder of results, in which the questions `asked` by name lead the report. It is
    loaded when first needed: a study of one block needs none.
    """

    def __init__(self, results: Path, asked: Sequence[str]) -> None:
        self._results = results
        self._asked = asked
        self._remembered: dict[Any, Any] = {}

    def verdicts(self) -> Verdicts:
        """What the records say. What was tested of the same records is not tested again."""
        with signals_held():
            from analysis.commands.open_questions import open_questions
        told = open_questions(self._results, self._remembered)
        opened = {name: Open(**one) for name, one in told["open"].items()}
        return Verdicts(opened, frozenset(told["settled"]), told["said"])

    def report(self, how_far: str = "") -> Path:
        """Write the report and return its file; `how_far` the study is, if it goes on."""
        with signals_held():
            from analysis.report import write
        return write(self._results, self._asked, how_far)
