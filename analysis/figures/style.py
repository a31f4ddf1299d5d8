"""The look that all figures share, and what a figure function returns."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analysis.claims.entry import Evidence
from analysis.records.plans import planned_runs
from analysis.support.values import Table
from support.files import replacing

PALETTE = BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
)  # fmt: skip
"""The colour-blind safe palette of Okabe and Ito (2008) without its yellow, too pale for lines."""


class Look(NamedTuple):
    """How a thing is drawn, so that it is told from others in grey as well."""

    colour: str
    marker: str = "o"
    dashes: Any = "-"


_NAMES: Mapping[Look, Sequence[str]] = {
    Look(BLUE): (
        "published", "checkered", "four", "four boxes", "on", "A", "guided", "forward", "g++ with libomp",
    ),
    Look(VERMILLION, "s", "--"): (
        "row", "nine", "nine boxes", "off", "self_contained_off", "A-again", "A again", "dynamic",
        "clang++ with libomp", "reverse",
    ),
    Look(GREEN, "^", "-."): ("fastest", "sorted", "track", "static"),
    Look(PURPLE, "D", (0, (4, 1, 1, 1, 1, 1))): ("repeat", "g++ with libgomp"),
    Look(ORANGE, "v", (0, (1, 1))): ("once",),
    Look(SKY, "P", (0, (6, 2))): (),
}  # fmt: skip
_LOOK_OF = {name: look for look, names in _NAMES.items() for name in names}
"""Which look a thing has in all figures; one that is not here gets the first that is left."""

INK, FAINT, BAND = "#222222", "#8a8a8a", "#ececec"
DOTS_PER_INCH = 200
"""Of what a figure has as pixels."""
WIDTH = 7.0
SETTINGS: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.titlelocation": "left",
    "axes.labelsize": 8,
    "axes.labelcolor": INK,
    "axes.edgecolor": FAINT,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": False,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.3,
    "lines.markersize": 3.5,
    "figure.constrained_layout.use": True,
    "figure.constrained_layout.h_pad": 0.06,
    "figure.constrained_layout.w_pad": 0.06,
    "pdf.fonttype": 42,
    "svg.fonttype": "path",
}


@dataclass(frozen=True)
class Data(Evidence):
    """What a figure may draw from: the study shown, all studies, the published one, the results folder."""

    folder: Path

    @property
    def prefix(self) -> str:
        """What the names of the study's files begin with: nothing of the first one."""
        name = re.sub(r"[^a-z0-9]+", "-", self.study.name.lower()).strip("-")
        return "" if self.study is self.studies[0] else f"{name}-"


@dataclass(frozen=True)
class Drawing:
    """A figure and its caption, generated from the same data; `verdicts` has a row a comparison, with the
    columns of `verdicts.judge` and what the report is to call it as `name`; `tables` follow the figure.
    """

    figure: Figure
    caption: str
    verdicts: pd.DataFrame | None = None
    tables: Sequence[Table] = ()


@contextmanager
def styled(name: str) -> Iterator[None]:
    """Draw in the common style; `name` keeps the identifiers inside an SVG the same from run to run."""
    with mpl.rc_context({**SETTINGS, "svg.hashsalt": name}):
        yield


def looks(names: Iterable[str]) -> dict[str, Look]:
    """Return the look of each thing that a figure shows. Of two with the same one the latter gets another."""
    found: dict[str, Look] = {}
    unknown = []
    for name in dict.fromkeys(names):
        look = _LOOK_OF.get(name)
        if look is None or look in found.values():
            unknown.append(name)
        else:
            found[name] = look
    left = [look for look in _NAMES if look not in found.values()] or list(_NAMES)
    return found | {name: left[number % len(left)] for number, name in enumerate(unknown)}


def lighten(colour: str, amount: float = 0.55) -> str:
    """Return the colour mixed with white, for the published series."""
    red, green, blue = (part * (1 - amount) + amount for part in to_rgb(colour))
    return to_hex((red, green, blue))


def new_figure(
    height: float, columns: int = 1, widths: Sequence[float] | None = None
) -> tuple[Figure, list[Axes]]:
    """Return a figure of the common width with a row of axes."""
    figure, grid = new_grid(height, 1, columns, width_ratios=widths)
    return figure, list(grid[0])


def new_grid(height: float, lines: int, columns: int = 1, **more: Any) -> tuple[Figure, Any]:  # noqa: ANN401
    """Return a figure of the common width with lines of axes; `more` is for `Figure.subplots`."""
    figure = Figure(figsize=(WIDTH, height))
    return figure, figure.subplots(lines, columns, squeeze=False, **more)


def partial(data: Data, experiment: str) -> str | None:
    """Return `partial: n of m runs` if the study lacks some of the experiment's planned records, else
    None. What is planned the runner wrote down last; records tell what it was when they were made.
    """
    study = data.study
    runs = study.runs[study.runs["experiment"] == experiment]
    known = planned_runs(data.folder, study.scale, experiment, set(runs["point"]))
    planned = len(runs) + _lacking(runs) if known is None else float(known)
    if runs.empty or np.isnan(planned) or len(runs) >= planned:
        return None
    return f"partial: {len(runs)} of {int(planned)} runs"


def _lacking(runs: pd.DataFrame) -> float:
    """Return how many records are missing of as many blocks as were planned, those that lack least; NaN where
    the records do not tell. A block that was begun and left has another one in its place.

    Later blocks may have fewer points than the first, since what is settled stops. A block without any record
    is taken to be as the one before.
    """
    planned = runs["blocks_planned"].max()
    if np.isnan(planned):
        return np.nan
    blocks = runs.groupby("block").agg(points=("points_planned", "max"), runs=("file", "size"))
    blocks = blocks.reindex(range(max(int(planned), int(blocks.index.max()) + 1)))
    lacking = blocks["points"].ffill().bfill() - blocks["runs"].fillna(0)
    return float(lacking.clip(lower=0).nsmallest(int(planned)).sum())


def mark_partial(figure: Figure, text: str | None) -> None:
    """Say in the figure itself that data are missing."""
    if text:
        # A title of the whole figure is given room of its own by the layout, unlike a text.
        figure.suptitle(text, x=0.995, ha="right", fontsize=7, color=VERMILLION, weight="bold")


class Point(Line2D):
    """A mark that tells its name and its values along both axes when the pointer rests on it in an SVG."""

    told = ("", "", "")


def point(axes: Axes, x: float, y: float, mark: str, *told: str, **look: Any) -> None:  # noqa: ANN401
    """Draw a mark that tells its name and its values along both axes, which the axes' labels name."""
    drawn = Point([x], [y], marker=mark, linestyle="", **look)
    name, along, up = (*told, "", "", "")[:3]
    drawn.told = name, along, up
    axes.add_line(drawn)
    axes.autoscale_view()


def _in_words(one: Point) -> str:
    """Return what a mark tells, a line each."""
    name, along, up = one.told
    axes: Any = one.axes
    shared = axes.get_shared_x_axes().get_siblings(axes)
    x_label = next(filter(None, (each.get_xlabel() for each in (axes, *shared))), "")
    values = (
        (" ".join(label.split()), value) for label, value in ((x_label, along), (axes.get_ylabel(), up))
    )
    lines = (f"{label}: {value}" if label and value else value for label, value in values)
    return "\n".join(filter(None, (name, *lines)))


def save(drawing: Drawing, folder: Path, name: str, *, pdf: bool = False) -> list[Path]:
    """Write the figure as SVG, and as `pdf` if wanted, and return the files; an outdated PDF is removed."""
    svg, other = (folder / f"{name}.{suffix}" for suffix in ("svg", "pdf"))
    points = [one for one in drawing.figure.findobj(Point) if isinstance(one, Point)]
    for number, one in enumerate(points):
        one.set_gid(f"point-{number}")

    def titled(found: re.Match[str]) -> str:
        return f"{found[0]}<title>{escape(_in_words(points[int(found[1])]), quote=False)}</title>"

    with styled(name):
        with replacing(svg) as part:
            drawing.figure.savefig(part, format="svg", dpi=DOTS_PER_INCH, metadata={"Date": None})
            text = re.sub(r'<g id="point-(\d+)">', titled, part.read_text(encoding="utf-8"))
            part.write_text(text, encoding="utf-8")
        if not pdf:
            other.unlink(missing_ok=True)
            return [svg]
        with replacing(other) as part:
            drawing.figure.savefig(part, format="pdf", dpi=DOTS_PER_INCH, metadata={"CreationDate": None})
    return [svg, other]
