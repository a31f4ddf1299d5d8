"""The claim about compilers, each of which brings an OpenMP runtime of its own."""

from dataclasses import replace

import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import Compared, Outcome, directed, judged, no_records, told
from analysis.statistics.pairs import log_ratios
from analysis.support.wording import blocks, change

NOT_TOLD_APART = (
    "each compiler's code ran with its own OpenMP runtime: what is the code's and what is the runtime's is "
    "not told apart (`make build COMPILER=gcc-libomp` does)"
)


def compilers(evidence: Evidence, experiment: str, candidate: str, reference: str) -> Outcome:
    """Test that the candidate's program is faster, each with its own runtime, as the study compared them;
    and, where the reference's code was measured with the candidate's runtime, that its code alone is.

    Both have to hold: a program that is faster by its runtime alone is not faster code.
    """
    times = evidence.study.times_of(experiment)
    if times.empty:
        return no_records(experiment)
    family, runtime = times["compiler_family"], times["openmp_runtime"]
    ours, theirs = times[family == candidate], times[family == reference]
    if ours.empty or theirs.empty:
        return no_records(experiment, candidate if ours.empty else reference)
    shared = theirs["openmp_runtime"].isin(set(runtime[family == candidate]))
    margin = evidence.margin(experiment)
    whole = None if theirs[~shared].empty else _against(theirs[~shared], ours, "with its own runtime", margin)
    code = None if theirs[shared].empty else _against(theirs[shared], ours, "with the same runtime", margin)
    parts = [part for part in (whole, code) if part is not None]
    joined = both(parts)
    if code is None:
        why = "; ".join(part for part in (joined.why, NOT_TOLD_APART) if part)
        return replace(joined, why=why)
    return joined


def _against(reference: pd.DataFrame, candidate: pd.DataFrame, how: str, margin: float) -> Outcome:
    names = [
        f"{side['compiler_family'].iloc[0]} ({' or '.join(sorted(side['openmp_runtime'].unique()))})"
        for side in (candidate, reference)
    ]
    row = directed(log_ratios(reference, candidate)["log_ratio"], margin)
    said = told(row, "faster")
    measured = f"{names[0]} against {names[1]}: {change(row)} of time, {blocks(row)} ({said})"
    figure = Compared(f"time of {names[0]} against {names[1]}", "–", change(row))
    outcome = judged(row, "faster", measured, (figure,))
    return replace(outcome, why=outcome.why or f"{said} {how}")
