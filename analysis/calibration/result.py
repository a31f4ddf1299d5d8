"""From a folder's streams to its tables, as Markdown for a page, and to the figure of false alarms."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from analysis.calibration import tables
from analysis.calibration.streams import load
from analysis.calibration.studies import all_studies
from analysis.calibration.tables import FOUND_WITHIN_SECONDS, STREAM, TO_BE_FOUND
from analysis.calibration.usual_ways import all_ways
from analysis.figures.captions import environment
from analysis.figures.labels import key, name_rows
from analysis.figures.style import BAND, BLUE, INK, VERMILLION, Drawing, new_figure, save, styled
from support.errors import InputError
from support.files import replacing

NAME = "calibration"
PANELS = ((0.0, "said to differ, and do not"), (TO_BE_FOUND, "a true 5 % found"))
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
    text = _text(
        origin=origin, errors=tables.errors(studies, STREAM), truths=tables.errors(of_first, ["more"]),
        power=tables.power(studies), asked=TO_BE_FOUND, within=FOUND_WITHIN_SECONDS,
        compared=[
            (condition, group.pivot_table("said", "way", "more", sort=False, dropna=False))
            for condition, group in compared.groupby("condition", sort=False)
        ],
    )  # fmt: skip
    target = folder / f"{NAME}.md"
    with replacing(target) as part:
        part.write_text(text, encoding="utf-8")
    return text, [target, *save(draw(compared, origin), folder, NAME)]


def _text(**facts: Any) -> str:  # noqa: ANN401
    """Return the facts in the words of `tables.jinja`."""
    made = environment("analysis.calibration", trim_blocks=True, lstrip_blocks=True)
    made.filters |= {"more": _more, "part": _part}
    return made.get_template("tables.jinja").render(facts, nan=np.nan, inf=np.inf).strip() + "\n"


def _more(more: float) -> str:
    return "none" if more == 0 else f"{100 * more:g} %"


def _part(part: float) -> str:
    return "–" if np.isnan(part) else f"{100 * part:.1f} %"


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
