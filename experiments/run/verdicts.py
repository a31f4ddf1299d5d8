"""What the analysis program says so far: what is settled, and how many blocks the rest needs."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field

from experiments.support.process import Coprocess

_LIMIT = 600.0
"""Seconds after which an answer is given up."""


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


def ask(analysis: Coprocess) -> Verdicts | str:
    """Ask the analysis program; its reason, in a line, where it does not answer."""
    done = analysis.ask("open", _LIMIT)
    if done.exit_code != 0:
        return done.reason
    answer = json.loads(done.output)
    return Verdicts(
        {name: Open(one["blocks"], one["next"], one["needed"]) for name, one in answer["open"].items()},
        frozenset(answer["settled"]),
        answer["said"],
    )
