"""What all comparisons of a study tell of the noise of each: the prior of its moderated variance."""

from functools import lru_cache

import numpy as np
import pandas as pd

from analysis.records.studies import Study
from analysis.statistics.moderation import NOTHING_KNOWN, Prior, fit
from analysis.statistics.pairs import PAIR, process_medians

_POINT = ["scene_name", "label", "series", "x"]


@lru_cache(maxsize=64)
def prior(study: Study, experiment: str) -> Prior:
    """Return the prior for log ratios of an experiment, from all of the study that were measured alike: in
    turns, or each in a process of its own.
    """
    in_turns = study.times_of(experiment)["in_turns"]
    if in_turns.empty:
        return NOTHING_KNOWN
    return _prior(study, bool(in_turns.iloc[0]))


@lru_cache(maxsize=16)
def _prior(study: Study, in_turns: bool) -> Prior:
    times = study.times[study.times["in_turns"] == in_turns]
    filled = times.assign(**{key: times[key].fillna("") for key in ("label", "scene_name")})
    tables = [_variances(group) for _, group in process_medians(filled).groupby(["experiment", "scene_name"])]
    found = pd.concat(tables) if tables else pd.DataFrame(columns=["variance", "freedom"])
    return fit(found["variance"], found["freedom"])


def _variances(processes: pd.DataFrame) -> pd.DataFrame:
    """Return the variance over blocks of each point's log ratio against the first one, with its degrees of
    freedom.
    """
    table = np.log(processes.pivot_table(index=PAIR, columns=_POINT, values="steps_seconds"))
    ratios = table.iloc[:, 1:].sub(table.iloc[:, 0], axis=0)
    counted = ratios.notna().sum()
    return pd.DataFrame({"variance": ratios.var(ddof=1), "freedom": counted - 1})[counted > 1]
