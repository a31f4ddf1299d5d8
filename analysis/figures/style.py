"""The look that all figures share, and what a figure function returns."""

import re
import tomllib
from collections.abc import Iterable, Iterator, Sequence
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

FOLDER = Path(__file__).parent
PALETTE = BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
)  # fmt: skip
"""The colour-blind safe palette of Okabe and Ito (2008) without its yellow, too pale for lines."""


class Look(NamedTuple):
    """How a thing is drawn, so that it is told from others in grey as well."""

    colour: str
    marker: str = "o"
    dashes: Any = "-"


_LOOKS = (
    Look(BLUE), Look(VERMILLION, "s", "--"), Look(GREEN, "^", "-."),
    Look(PURPLE, "D", (0, (4, 1, 1, 1, 1, 1))), Look(ORANGE, "v", (0, (1, 1))), Look(SKY, "P", (0, (6, 2))),
)  # fmt: skip
_SERIES = tomllib.loads((FOLDER / "looks.toml").read_text(encoding="utf-8"))
_LOOK_OF = {name: look for look, names in zip(_LOOKS, _SERIES.values(), strict=True) for name in names}

INK, FAINT, BAND = "#222222", "#8a8a8a", "#ececec"
DOTS_PER_INCH = 200
"""Of what a figure has as pixels."""
WIDTH = 7.0
SETTINGS = mpl.rc_params_from_file(FOLDER / "style.mplstyle", use_default_template=False)


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
    left = [look for look in _LOOKS if look not in found.values()] or _LOOKS
    return found | {name: left[number % len(left)] for number, name in enumerate(unknown)}


def lighten(colour: str, amount: float = 0.55) -> str:
    """Return the colour mixed with white, for the published series."""
    return to_hex(tuple(np.array(to_rgb(colour)) * (1 - amount) + amount))


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


def partial(data: Evidence, experiment: str) -> str:
    """Return `partial: n of m runs` if the study lacks some of the experiment's planned records, else
    nothing. What is planned the runner wrote down last; records tell what it was when they were made.
    """
    study = data.study
    runs = study.runs[study.runs["experiment"] == experiment]
    known = planned_runs(data.folder, study.scale, experiment, set(runs["point"]))
    planned = len(runs) + _lacking(runs) if known is None else float(known)
    is_partial = len(runs) and len(runs) < planned
    return f"partial: {len(runs)} of {int(planned)} runs" if is_partial else ""


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
    values = ((x_label, along), (axes.get_ylabel(), up))
    lines = (": ".join(filter(None, (" ".join(label.split()), value))) for label, value in values if value)
    return "\n".join(filter(None, (name, *lines)))


def save(drawing: Drawing, folder: Path, name: str, *, pdf: bool = False) -> list[Path]:
    """Write the figure as SVG, and as `pdf` if wanted, and return the files; an outdated PDF is removed."""
    svg, other = (folder / f"{name}.{suffix}" for suffix in ("svg", "pdf"))
    points = [one for one in drawing.figure.findobj(Point) if isinstance(one, Point)]
    for number, one in enumerate(points):
        one.set_gid(f"point-{number}")

    def titled(found: re.Match[str]) -> str:
        return f"{found[0]}<title>{escape(_in_words(points[int(found[1])]), quote=False)}</title>"

    files = [svg, other] if pdf else [svg]
    with styled(name):
        for file in files:
            with replacing(file) as part:
                form, undated = file.suffix[1:], {"Date" if file is svg else "CreationDate": None}
                drawing.figure.savefig(part, format=form, dpi=DOTS_PER_INCH, metadata=undated)
                if file is svg:
                    text = part.read_text(encoding="utf-8")
                    part.write_text(re.sub(r'<g id="point-(\d+)">', titled, text), encoding="utf-8")
    if not pdf:
        other.unlink(missing_ok=True)
    return files
