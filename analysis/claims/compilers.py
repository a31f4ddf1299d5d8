"""The claim about compilers, each of which brings an OpenMP runtime of its own."""

from dataclasses import replace

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
    outcome = _against(theirs[shared], ours, margin)
    if theirs[~shared].empty:
        return outcome
    beside = _told(theirs[shared], theirs[~shared], margin)
    return replace(outcome, measured=f"{outcome.measured}; the runtime alone: {beside}")


def _against(reference: pd.DataFrame, candidate: pd.DataFrame, margin: float) -> Outcome:
    pairs = log_ratios(reference, candidate)
    row = directed(pairs["log_ratio"], margin, stops=pairs["stops"])
    said, names = told(row, "faster"), [_name(candidate), _name(reference)]
    measured = f"{names[0]} against {names[1]}: {change(row)} of time, {blocks(row)} ({said})"
    figure = Compared(f"time of {names[0]} against {names[1]}", "–", change(row))
    outcome = judged(row, "faster", measured, (figure,))
    effect = effect_of(" against ".join(name.split()[0] for name in names), row, margin=margin)
    return replace(outcome, why=outcome.why or f"{said} with the same runtime", effects=(effect,))


def _told(reference: pd.DataFrame, candidate: pd.DataFrame, margin: float) -> str:
    pairs = log_ratios(reference, candidate)
    row = directed(pairs["log_ratio"], margin, stops=pairs["stops"])
    return f"{_name(candidate)} against {_name(reference)}: {change(row)} of time ({told(row, 'faster')})"


def _name(side: pd.DataFrame) -> str:
    return f"{side['compiler_family'].iloc[0]} ({' or '.join(sorted(side['openmp_runtime'].unique()))})"
