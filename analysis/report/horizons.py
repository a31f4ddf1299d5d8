"""How far single paths can be compared with the exact ones before chaos ends it."""

import numpy as np
import pandas as pd

from analysis.derived import accuracy
from analysis.records.studies import Study
from analysis.support.wording import count, exact, number


def horizons(study: Study, experiment: str) -> str:
    """Say how far single paths can be compared with the exact ones, from the records; nothing without any."""
    runs = accuracy.errors(study, experiment).dropna(subset=["path"])
    if runs.empty:
        return ""
    parts = runs.sort_values("area_fraction").groupby("scene_name", sort=False)
    said = "; ".join(f"{scene or 'here'} {_horizon(part)}" for scene, part in parts)
    return (
        "Hard discs are chaotic: any difference, be it of dt or of rounding, grows exponentially with the "
        "number of collisions, so that the path of a single disc can be compared with the exact one up to a "
        "horizon only, and not at all beyond it. The RMS distance to the reference passes 0.1 radii: "
        f"{said}. What is said of paths below is said of time 1; collision rate, pressure and speeds are "
        "averages and go on meaning something."
    )


def _horizon(runs: pd.DataFrame) -> str:
    least, most = runs["substeps"].min(), runs["substeps"].max()
    coarse, fine = (runs.loc[runs["substeps"] == end, "time_to_tenth_radius"] for end in (least, most))
    rate = runs["collision_rate_reference"].median()
    collisions = "" if np.isnan(rate) else f" ({number(rate, 2)} collisions per disc and unit of time)"
    first = _when(coarse)
    if least == most:
        return f"{first} with {count(int(least), 'substep')}{collisions}"
    return f"{first} with {least:g} and {_when(fine)} with {most:g} substeps{collisions}"


def _when(times: pd.Series) -> str:
    """Return the latest of the times, over the series; NaN is never within the run."""
    return "never" if times.isna().any() else f"by time {exact(times.max())}"
