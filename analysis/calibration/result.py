"""From a folder's streams to its tables, as Markdown for a page, and to the figure of false alarms."""

from pathlib import Path

import numpy as np
import pandas as pd

from analysis.calibration import tables
from analysis.calibration.streams import load
from analysis.calibration.studies import all_studies
from analysis.calibration.tables import FOUND_WITHIN_SECONDS, STREAM, TO_BE_FOUND
from analysis.calibration.usual_ways import all_ways
from analysis.figures.labels import key, name_rows
from analysis.figures.style import BAND, BLUE, INK, VERMILLION, Drawing, new_figure, save, styled
from analysis.support.values import Row
from analysis.support.wording import markdown_table
from support.errors import InputError
from support.files import replacing

NAME = "calibration"
PANELS = ((0.0, "said to differ, and do not"), (TO_BE_FOUND, "a true 5 % found"))
SECONDS = ("half", "nine_of_ten", "longest")
COUNTS = [
    *("comparisons", "decided", "wrong", "interval misses", "disjoint: wrong", "at most (95 %)"),
    *("stretches: wrong", "at most (95 %)"),
]
_SHIFT = 0.16


def write(folder: Path) -> tuple[str, list[Path]]:
    """Write `calibration.md` and `calibration.svg` beside the streams; return the tables and the files.

    Raises InputError where there are no streams, or none with enough blocks for a single look.
    """
    streams, origin = load(folder)
    studies = all_studies(streams)
    if studies.empty:
        raise InputError(f"{folder}: no stream has enough blocks for a verdict, expected a longer time")
    compared = tables.ours_and_theirs(studies, all_ways(streams), streams)
    of_first = studies[studies["reference"] == 0].sort_values("more", kind="stable")
    text = "\n\n".join(
        [
            origin,
            _errors(tables.errors(studies, STREAM)),
            _truths(tables.errors(of_first, ["more"])),
            _power(tables.power(studies)),
            f"{_compared(compared)}\n",
        ]
    )
    target = folder / f"{NAME}.md"
    with replacing(target) as part:
        part.write_text(text, encoding="utf-8")
    return text, [target, *save(draw(compared, origin), folder, NAME)]


def _errors(table: pd.DataFrame) -> str:
    rows = [[row["kind"], row["condition"], *_counts(row)] for row in table.to_dict("records")]
    return "Wrong verdicts:\n\n" + markdown_table(["contenders", "machine", *COUNTS], rows)


def _truths(table: pd.DataFrame) -> str:
    rows = [[_more(row["more"]), *_counts(row)] for row in table.to_dict("records")]
    return "By the true difference, all streams together:\n\n" + markdown_table(["more work", *COUNTS], rows)


def _counts(row: Row) -> list[str]:
    tries = row["studies"]
    parts = {name: row[name] / tries if tries else np.nan for name in ("wrong", "missed")}
    counts = [f"{row[name]:.0f} ({_share(part)})" for name, part in parts.items()]
    apart = f"{row['disjoint_wrong']:.0f} of {row['disjoint']:.0f}"
    once = f"{row['stretches_wrong']:.0f} of {row['stretches']:.0f}"
    bounds = [apart, _share(row["bound"]), once, _share(row["stretch_bound"])]
    return [f"{tries:.0f}", _share(row["decided"]), *counts, *bounds]


def _power(table: pd.DataFrame) -> str:
    rows = [
        [row["kind"], row["condition"], _share(row["found"]), *(_seconds(row[name]) for name in SECONDS)]
        for row in table.to_dict("records")
    ]
    within = f"within {FOUND_WITHIN_SECONDS:g} s"
    head = ["contenders", "machine", within, "half, s", "nine of ten, s", "longest study, s"]
    return f"A true {_more(TO_BE_FOUND)} found:\n\n" + markdown_table(head, rows)


def _compared(table: pd.DataFrame) -> str:
    parts = []
    for condition, group in table.groupby("condition", sort=False):
        shares = group.pivot_table(index="way", columns="more", values="said", sort=False, dropna=False)
        head = ["way", *(_more(float(one)) for one in shares.columns)]
        by_way = zip(shares.index, shares.to_numpy(), strict=True)
        rows = [[str(way), *(_share(one) for one in row)] for way, row in by_way]
        parts.append(f"Said to differ, {condition}:\n\n" + markdown_table(head, rows))
    return "\n\n".join(parts)


def _more(more: float) -> str:
    return "none" if more == 0 else f"{100 * more:g} %"


def _share(share: float) -> str:
    return "–" if np.isnan(share) else f"{100 * share:.1f} %"


def _seconds(seconds: float) -> str:
    return "not in sight" if np.isinf(seconds) else f"{seconds:.2g}"


def draw(compared: pd.DataFrame, origin: str) -> Drawing:
    """Draw the rows of `tables.ours_and_theirs`: a row a way, a colour a condition of the machine."""
    ways = list(dict.fromkeys(compared["way"]))
    conditions = list(dict.fromkeys(compared["condition"]))
    colours = dict(zip(conditions, (BLUE, VERMILLION), strict=False))
    with styled(NAME):
        figure, panels = new_figure(0.6 + 0.27 * len(ways), columns=2)
        for axes, (more, label) in zip(panels, PANELS, strict=True):
            axes.axhspan(-0.5, 0.5, color=BAND, zorder=0)
            for number, condition in enumerate(conditions):
                chosen = compared[(compared["condition"] == condition) & np.isclose(compared["more"], more)]
                rows = chosen.set_index("way").reindex(ways)
                heights = np.arange(len(ways)) + _SHIFT * (2 * number - len(conditions) + 1)
                colour = colours.get(condition, INK)
                axes.hlines(heights, 100 * rows["low"], 100 * rows["high"], color=colour, linewidth=1)
                axes.plot(100 * rows["said"], heights, "o", color=colour)
            axes.set_xlim(-2, 102)
            axes.set_ylim(len(ways) - 0.5, -0.5)
            axes.set_xlabel(f"{label}, % of comparisons")
            axes.spines["left"].set_visible(False)
            name_rows(axes, ways if axes is panels[0] else [""] * len(ways))
        key(figure, [(one, colours.get(one, INK)) for one in conditions])
    told = "Three kinds of contenders; exact 95 % intervals, of as many comparisons as would not overlap"
    return Drawing(figure, f"False alarms and findings. {told}. {origin}.")
