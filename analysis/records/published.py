"""The published study's measurements and machines, from `published.toml`."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

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


def load() -> Published:
    """Read the published measurements."""
    content = tomllib.loads(PUBLISHED_FILE.read_text(encoding="utf-8"))
    machines = pd.DataFrame([{"machine": name, **values} for name, values in content["machines"].items()])
    times = [row for name, table in content["experiments"].items() for row in _rows(name, table)]
    degenerate = {
        name: table["degenerate"] for name, table in content["experiments"].items() if "degenerate" in table
    }
    return Published(pd.DataFrame(times), machines, degenerate)


def _rows(experiment: str, table: Mapping[str, Any]) -> list[dict[str, Any]]:
    return [
        {
            "experiment": experiment,
            "series": series,
            "x_name": table["x_name"],
            "x": float(x),
            "seconds": float(seconds),
        }
        for series, points in table["series"].items()
        for x, seconds in zip(points["x"], points["seconds"], strict=True)
    ]
