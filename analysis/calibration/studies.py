"""Small studies of a stream, each decided by Carom's rule as its blocks come.

A study takes a stretch of successive blocks in the order of time, so that their dependence stays in it. It
looks where looks are planned, and stops when it is decided or has no blocks left. Stretches of one set begin
all over the stream and overlap: they show how often something happens, and are no independent tries. Those of
the other set are disjoint: exact bounds rest on them.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from analysis.calibration.streams import Stream
from analysis.statistics.looks import LOOKS, looks_up_to
from analysis.statistics.verdicts import INCONCLUSIVE, MARGIN, judge_one
from analysis.support.parallel import in_parallel
from analysis.support.values import Floats

FEWEST_STUDIES = 2000
"""Of one stream, on stretches that overlap, if it has so many."""

LONGEST_PART, DISJOINT_PART = 3, 20
"""Overlapping stretches are a third of the stream at most; of disjoint ones there are twenty at least."""
LONGEST_DISJOINT = 48

DECIDED = ("faster", "slower", "equivalent")


def comparisons(more: Sequence[float]) -> list[tuple[int, int]]:
    """Return each contender against the first, then against the others that do the same work as the first."""
    equal = [k for k, one in enumerate(more) if one == 0]
    return [(one, k) for one in equal for k in range(len(more)) if k > one]


def is_wrong(verdict: str, more: float, margin: float = MARGIN) -> bool:
    """Return whether a verdict contradicts the truth: a difference beyond the margin where there is none, the
    wrong direction, equivalence where the difference is beyond the margin.
    """
    truth = "slower" if more > margin else "faster" if 1 + more < 1 / (1 + margin) else "equivalent"
    return verdict in DECIDED and verdict != truth


def study(values: Floats, looks: Sequence[int], more: float) -> dict[str, Any]:
    """Return what came of the study of these blocks: its `verdict`, how many `blocks` it took, whether that
    is `wrong`, and whether every interval up to there `covered` the truth.
    """
    verdict, covered, blocks = INCONCLUSIVE, True, 0
    for look in looks:
        row = judge_one(values[:look])
        verdict, blocks = row.verdict, look
        covered = covered and row.low <= 1 + more <= row.high
        if verdict in DECIDED:
            break
    return {"verdict": verdict, "blocks": blocks, "wrong": is_wrong(verdict, more), "covered": covered}


def of_stream(stream: Stream, reference: int, candidate: int) -> Iterator[dict[str, Any]]:
    """Yield every study of one comparison: a row with the columns of `study`, of which stream and contenders
    it is, where it starts, whether it is `disjoint`, and the `seconds` that measuring those two alone would
    have taken.
    """
    values, more = stream.log_ratios(reference, candidate), stream.more[candidate]
    seconds = stream.seconds_of_block(reference, candidate)
    named = {"kind": stream.kind, "condition": stream.condition, "reference": reference, "more": more}
    plans = [(False, overlapping(stream))] + [(True, disjoint(stream))] * (reference == 0)
    for is_disjoint, (starts, looks) in plans:
        for start in starts:
            row = study(values[start:], looks, more)
            told = {"start": start, "disjoint": is_disjoint, "seconds": row["blocks"] * seconds}
            yield {**named, **row, **told}


def overlapping(stream: Stream) -> tuple[range, list[int]]:
    """Return where the overlapping studies of a comparison begin, and their looks."""
    looks = looks_up_to(max(stream.blocks / LONGEST_PART, min(LOOKS[0], stream.blocks)))
    if not looks:
        return range(0), []
    places = stream.blocks - looks[-1] + 1
    wanted = -(-FEWEST_STUDIES // len(comparisons(stream.more)))
    return range(0, places, max(1, places // wanted)), looks


def disjoint(stream: Stream) -> tuple[range, list[int]]:
    """Return where the disjoint studies of a comparison begin, and their looks."""
    looks = looks_up_to(min(LONGEST_DISJOINT, max(LOOKS[0], stream.blocks / DISJOINT_PART)))
    return range(0, stream.blocks - looks[-1] + 1, looks[-1]), looks


def all_studies(streams: Sequence[Stream]) -> pd.DataFrame:
    """Return the studies of all streams, a row each, as of `of_stream`. All processors work on it."""
    asked = [(stream, *two) for stream in streams for two in comparisons(stream.more)]
    found = in_parallel(lambda number: list(of_stream(*asked[number])), len(asked))
    return pd.DataFrame([row for rows in found for row in rows])
