"""Reads the timelines that `carom profile --timeline FILE --timeline-chunks` writes."""

import json
import sys
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import pandas as pd

FOLDER = "timelines"
COLUMNS = ["thread", "phase", "kind", "begin", "end"]


@dataclass(frozen=True)
class Timeline:
    """One profiled run: `title`, and `spans` with thread, phase, kind (phase, loop, chunk, sweep, wait), and
    begin and end in seconds.
    """

    title: str
    spans: pd.DataFrame


def load(results: Path) -> list[Timeline]:
    """Return the timelines in the folder `timelines` of the results, by file name; a file that is none is
    named on standard error and left out.
    """
    found = []
    for path in sorted((results / FOLDER).glob("*.json")):
        try:
            found.append(_timeline(path))
        except (json.JSONDecodeError, UnicodeDecodeError, KeyError, TypeError, ValueError) as error:
            print(f"{path}: skipped: not a timeline ({type(error).__name__}: {error})", file=sys.stderr)
    return found


def _timeline(path: Path) -> Timeline:
    trace = json.loads(path.read_text(encoding="utf-8"))
    rows = []
    for event in trace["traceEvents"]:
        if event["ph"] != "X":
            continue
        words = event["name"].split()
        kind = words[1] if len(words) > 1 else words[0] if words[0] in ("wait", "sweep") else "phase"
        begin = event["ts"] * 1e-6
        rows.append((event["tid"], words[0], kind, begin, begin + event["dur"] * 1e-6))
    spans = pd.DataFrame(rows, columns=COLUMNS)
    if spans[(spans["kind"] == "phase") & (spans["phase"] == "move")].empty:
        raise ValueError("no span named 'move'")
    return Timeline(str(trace["otherData"]["title"]), spans)


def one_step(spans: pd.DataFrame) -> pd.DataFrame:
    """Return the spans of the step of median length, with times from its beginning.

    A step begins with the phase `move` and lasts until the next one, or until the run's end.
    """
    moves = spans[(spans["kind"] == "phase") & (spans["phase"] == "move")]["begin"].sort_values()
    bounds = [*moves, spans["end"].max()]
    steps = sorted(pairwise(bounds), key=lambda step: step[1] - step[0])
    begin, end = steps[(len(steps) - 1) // 2]
    inside = spans[(spans["begin"] >= begin) & (spans["begin"] < end)]
    return inside.assign(begin=inside["begin"] - begin, end=inside["end"].clip(upper=end) - begin)
