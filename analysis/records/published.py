"""The published study's measurements and machines, from `published.toml`."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.statistics.pairs import log_ratios
from analysis.statistics.verdicts import Ratio, judge_one

PUBLISHED_FILE = Path(__file__).parent / "published.toml"


@dataclass(frozen=True)
class Published:
    """`times`: experiment, series, x_name, x, seconds (wall time of the whole process, mean of three runs).

    `machines`: one row a machine of the published study, with its cores, hardware threads and maximum clock.
    """

    times: pd.DataFrame
    machines: pd.DataFrame
    degenerate: Mapping[str, Sequence[float]]
    """By experiment the values of x at which the scene is of another kind: drawn, but no part of a trend."""

    def without_degenerate(self, experiment: str, times: pd.DataFrame) -> pd.DataFrame:
        """Return the rows of a table of that experiment that are part of its trend."""
        return times[~times["x"].isin(list(self.degenerate.get(experiment, ())))]

    def experiment(self, name: str) -> pd.DataFrame:
        """Return the rows of one experiment, in the order of the file; empty if the study has none."""
        return self.times[self.times["experiment"] == name]

    def curve(self, experiment: str) -> pd.DataFrame:
        """Return a sweep in the shape of records: a process a point, all in one block; empty without one."""
        times = self.experiment(experiment)
        columns = {"file": times["x"].astype(str), "steps_seconds": times["seconds"]}
        return times.assign(**columns, node="published", block=0, session="")

    def ratio(self, experiment: str, candidate: str, reference: str) -> Ratio | None:
        """Return the ratio of two series, paired by repetition; None without both."""
        times = self.experiment(experiment)
        times = times.assign(node="published", block=times["x"], session="")
        first, second = (times[times["series"] == series] for series in (reference, candidate))
        if first.empty or second.empty:
            return None
        return judge_one(log_ratios(first, second, value="seconds")["log_ratio"])


def load() -> Published:
    """Read the published measurements."""
    content = tomllib.loads(PUBLISHED_FILE.read_text(encoding="utf-8"))
    machines = pd.DataFrame([{"machine": name, **values} for name, values in content["machines"].items()])
    times = [row for name, table in content["experiments"].items() for row in _rows(name, table)]
    degenerate = {
        name: table["degenerate"] for name, table in content["experiments"].items() if "degenerate" in table
    }
    columns = ["experiment", "series", "x_name", "x", "seconds"]
    return Published(pd.DataFrame(times, columns=columns), machines, degenerate)


def _rows(experiment: str, table: Mapping[str, Any]) -> list[tuple[str, str, str, float, float]]:
    return [
        (experiment, series, table["x_name"], float(x), float(seconds))
        for series, points in table["series"].items()
        for x, seconds in zip(points["x"], points["seconds"], strict=True)
    ]
