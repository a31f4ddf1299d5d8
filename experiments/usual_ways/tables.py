"""What each way said of equal and of different programs, as a table."""

import csv
import statistics
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from experiments.usual_ways.ways import EQUIVALENT, FASTER, NOTHING, SLOWER, WAYS

COLUMNS = ("machine", "commit", "date", "load", "more", "way", "said", "ratio", "seconds")
"""Of the raw data: `more` is the fraction of work that the second program has more."""

Row = Mapping[str, str]


def read(file: Path) -> list[Row]:
    """The rows of the raw data."""
    with file.open(encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def table(rows: Iterable[Row]) -> str:
    """A Markdown table: by load, work and way, how often each thing was said, and the seconds it took."""
    groups: dict[tuple[str, float, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row["load"], float(row["more"]), row["way"]), []).append(row)
    head = [
        "load", "more work", "way", "slower", "faster", "equivalent", "says nothing", "worst estimate off by",
        "seconds",
    ]  # fmt: skip
    ways = list(WAYS)
    order = sorted(groups, key=lambda key: (key[0] != "quiet", key[0], key[1], ways.index(key[2])))
    lines = [head, ["---"] * len(head), *(_cells(key, groups[key]) for key in order)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _cells(key: tuple[str, float, str], rows: Sequence[Row]) -> list[str]:
    load, more, way = key
    said = [row["said"] for row in rows]
    counts = [f"{said.count(one)} of {len(rows)}" for one in (SLOWER, FASTER, EQUIVALENT, NOTHING)]
    off = max(abs(float(row["ratio"]) / (1 + more) - 1) for row in rows)
    seconds = statistics.median(float(row["seconds"]) for row in rows)
    return [load, f"{more * 100:g} %", way, *counts, f"{off * 100:.1f} %", f"{seconds:.0f}"]
