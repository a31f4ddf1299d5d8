"""How many collisions a second the exact simulation makes, over scenes and threads."""

import pandas as pd

from analysis.derived.ladder import named
from analysis.statistics.bootstrap import summarise
from analysis.statistics.scalability import speed_up

CURVE = ["scene_name", "series"]


def rates(runs: pd.DataFrame, times: pd.DataFrame) -> pd.DataFrame:
    """Return a row a scene, series and number of threads, by rising number of discs.

    Takes the tables of one experiment over threads. Columns: `scene_name`, `series`, `particles`, `x` (the
    threads), `rate` (pair collisions a second, median over the repetitions), `speed_up` over the fewest
    threads with `low` and `high`, NaN for these themselves and where there are too few blocks.
    """
    at = [*CURVE, "x"]
    collisions = named(runs).groupby(at)[["pair_resolves", "particles"]].median()
    parts = []
    for _, part in named(times).groupby(CURVE, sort=False):
        table = summarise(part, at).join(collisions, on=at)
        table["rate"] = table["pair_resolves"] / table["median"]
        table = table.drop(columns=["low", "high"]).merge(speed_up(part), on="x", how="left")
        parts.append(table[[*CURVE, "particles", "x", "rate", "speed_up", "low", "high"]])
    return pd.concat(parts).sort_values(["particles", *CURVE, "x"], ignore_index=True)
