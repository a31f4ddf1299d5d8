"""The claim about compilers, each of which brings an OpenMP runtime of its own."""

from dataclasses import replace
from typing import Any

import pandas as pd

from analysis.claims.effects import effect_of
from analysis.claims.entry import Evidence
from analysis.claims.outcome import Compared, Outcome, directed, judged, no_records, told
from analysis.statistics.pairs import log_ratios
from analysis.support.wording import blocks, change

CODE_ALONE = "g++'s code with the runtime of clang++, which its build has where clang++ is installed"


def compilers(evidence: Evidence, experiment: str, candidate: str, reference: str) -> Outcome:
    """Test that the candidate's code is faster with the same OpenMP runtime under both. What the reference's
    own runtime changes is told beside it.
    """
    times = evidence.study.times_of(experiment)
    if times.empty:
        return no_records(experiment)
    family, runtime = times["compiler_family"], times["openmp_runtime"]
    ours, theirs = times[family == candidate], times[family == reference]
    shared = theirs["openmp_runtime"].isin(set(runtime[family == candidate]))
    if ours.empty or theirs[shared].empty:
        return no_records(experiment, candidate if ours.empty else CODE_ALONE)
    margin = evidence.margin(experiment)
    row, said = _against(theirs[shared], ours, margin)
    verdict, names = told(row, "faster"), said.partition(":")[0]
    measured = f"{said}, {blocks(row)} ({verdict})"
    outcome = judged(row, "faster", measured, (Compared(f"time of {names}", "–", change(row)),))
    effect = effect_of(f"{candidate} against {reference}", row, margin=margin)
    outcome = replace(outcome, why=outcome.why or f"{verdict} with the same runtime", effects=(effect,))
    if theirs[~shared].empty:
        return outcome
    runtimes, said = _against(theirs[shared], theirs[~shared], margin)
    return replace(outcome, measured=f"{measured}; the runtime alone: {said} ({told(runtimes, 'faster')})")


def _against(reference: pd.DataFrame, candidate: pd.DataFrame, margin: float) -> tuple[dict[str, Any], str]:
    """Return the row of the candidate's time against the reference's, and what it says."""
    pairs = log_ratios(reference, candidate)
    row = directed(pairs["log_ratio"], margin, stops=pairs["stops"])
    return row, f"{_name(candidate)} against {_name(reference)}: {change(row)} of time"


def _name(side: pd.DataFrame) -> str:
    return f"{side['compiler_family'].iloc[0]} ({' or '.join(sorted(side['openmp_runtime'].unique()))})"
