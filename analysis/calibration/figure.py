"""The figure: false alarms and findings, ours and theirs."""

import numpy as np
import pandas as pd

from analysis.calibration.tables import TO_BE_FOUND
from analysis.figures.style import BAND, BLUE, INK, VERMILLION, Drawing, key, new_figure, styled

NAME = "calibration"
PANELS = ((0.0, "said to differ, and do not"), (TO_BE_FOUND, "a true 5 % found"))
_SHIFT = 0.16


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
            axes.tick_params(axis="y", length=0)
            axes.spines["left"].set_visible(False)
            axes.set_yticks(range(len(ways)), ways if axes is panels[0] else [""] * len(ways))
        key(panels[0], [(one, colours.get(one, INK)) for one in conditions])
    told = "Three kinds of contenders; exact 95 % intervals, of as many comparisons as would not overlap"
    return Drawing(figure, f"False alarms and findings. {told}. {origin}.")
