"""Two ways to measure what is compared: in turns within one process, and in processes of their own. How far
the ratios by turns are off, and how soon either way knows a ratio.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analysis.records.studies import Study
from analysis.statistics.intervals import FEWEST, centre
from analysis.statistics.pairs import PAIR, ratios_of
from analysis.statistics.verdicts import ratio_of
from analysis.support.values import Interval
from analysis.support.wording import change, percent

KIND = "ways"
"""The kind of the experiments that measure each point both ways."""

TURNS, APART = "by turns", "apart"

_SHOWN = 60
"""Enough for a curve. An interval of hundreds of blocks takes a good part of a second."""


@dataclass(frozen=True)
class Comparison:
    """A series against the first one on a scene, both ways: `pairs` has a row a block, with `scene_name`,
    `series`, the columns of `PAIR` and the log ratios `by turns` and `apart`; `seconds` what a block took, by
    way.
    """

    name: str
    pairs: pd.DataFrame
    seconds: dict[str, float]

    @property
    def bias(self) -> Interval:
        """How far the log ratio by turns is off, with its 95 % interval over the blocks."""
        return centre(self.pairs[TURNS] - self.pairs[APART], 0.95)

    def log_ratio(self, way: str, blocks: int | None = None) -> Interval:
        """The log ratio as one way has it, from the first blocks alone if so many are given."""
        return centre(self.pairs[way].to_numpy()[:blocks], 0.95)

    def half_widths(self, way: str) -> pd.DataFrame:
        """Return the `seconds` spent and half of the interval of the log ratio, `half`, after four blocks and
        more, at `_SHOWN` numbers of blocks that grow by the same factor.
        """
        blocks = np.unique(np.geomspace(FEWEST, len(self.pairs), _SHOWN).round().astype(int))
        found = [self.log_ratio(way, number) for number in blocks]
        half = [(one.high - one.low) / 2 for one in found]
        return pd.DataFrame({"seconds": blocks * self.seconds[way], "half": half})


def comparisons(study: Study, experiment: str) -> list[Comparison]:
    """Return the comparisons of an experiment that have four blocks both ways, in the order of its file."""
    times = study.times_of(experiment)
    spent = study.runs_of(experiment).set_index("file")["process_seconds"]
    processes = times.assign(scene_name=times["scene_name"].fillna(""), seconds=times["file"].map(spent))
    found = []
    for scene, group in processes.groupby("scene_name", sort=False):
        reference, *others = group.sort_values("series_number")["series"].drop_duplicates()
        for series in others:
            name = f"{scene}: {series} / {reference}" if scene else f"{series} / {reference}"
            found.append(_comparison(name, group, str(reference), str(series)))
    return sorted((one for one in found if len(one.pairs) >= FEWEST), key=lambda one: one.name)


def _comparison(name: str, processes: pd.DataFrame, reference: str, candidate: str) -> Comparison:
    both = processes[processes["series"].isin([reference, candidate])]
    ways = {TURNS: both[both["in_turns"]], APART: both[~both["in_turns"]]}
    tables = [
        ratios_of(part, "series", reference, candidate).set_index(PAIR)["log_ratio"].rename(way)
        for way, part in ways.items()
    ]
    seconds = {
        way: float(part.groupby(PAIR)["seconds"].sum().median()) if len(part) else np.nan
        for way, part in ways.items()
    }
    return Comparison(name, pd.concat(tables, axis=1, join="inner").reset_index(), seconds)


def overall(found: list[Comparison]) -> Interval:
    """Return the mean of the biases, with its interval over the blocks that all comparisons have."""
    pairs = [one.pairs.set_index(PAIR) for one in found]
    shared = pd.concat(
        [one[TURNS] - one[APART] for one in pairs], axis=1, join="inner", keys=range(len(pairs))
    )
    return centre(shared.mean(axis=1), 0.95)


def said(log_ratio: Interval) -> str:
    """Return a log ratio as a change with its interval, e.g. `−0.2 % [−0.9 %, +0.5 %]`."""
    return (
        change(ratio_of(log_ratio)) if np.isfinite(log_ratio.high) else percent(np.expm1(log_ratio.estimate))
    )
