"""Claims that one choice is faster than, or as fast as, another."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from analysis.claims.outcome import FAILS, HOLDS, OPEN, TOO_FEW, Outcome, both, no_records
from analysis.records.studies import Study
from analysis.statistics.pairs import log_ratios, process_medians
from analysis.statistics.verdicts import MARGIN, judge, judge_one, not_faster
from analysis.support.wording import blocks, change, count, exact, number, share


def pair(
    study: Study, experiments: Sequence[str], axis: str, candidate: str, reference: str, expected: str
) -> Outcome:
    """Test that `candidate` is faster than (or equivalent to) `reference` on an axis, at the largest x
    measured.
    """
    return both([_one_pair(study, name, axis, candidate, reference, expected) for name in experiments])


def _one_pair(
    study: Study, experiment: str, axis: str, candidate: str, reference: str, expected: str
) -> Outcome:
    times = study.times_of(experiment)
    if times.empty:
        return no_records(experiment)
    sides = [times[times[axis] == value] for value in (candidate, reference)]
    missing = [name for name, side in zip((candidate, reference), sides, strict=True) if side.empty]
    if missing:
        return no_records(experiment, " and ".join(f"{axis} = {name}" for name in missing))
    x_name, shared = times["x_name"].iloc[0], set(sides[0]["x"]) & set(sides[1]["x"])
    if not shared:
        return no_records(experiment, f"{candidate} and {reference} at the same {x_name}")
    chosen, against = (side[side["x"] == max(shared)] for side in sides)
    row = judge_one(log_ratios(process_medians(against), process_medians(chosen))["log_ratio"])
    where = f" at {x_name} = {exact(max(shared))}" if times["x"].nunique() > 1 else ""
    measured = (
        f"{candidate} against {reference}{where}: {change(row)} of time, {blocks(row)} ({row['verdict']})"
    )
    return _judged(row["verdict"], expected, measured)


def _judged(verdict: str, expected: str, measured: str) -> Outcome:
    if verdict == "inconclusive":
        return Outcome(OPEN, measured, TOO_FEW)
    return Outcome(HOLDS if verdict == expected else FAILS, measured)


def fewer_resolves(study: Study, experiment: str, axis: str, candidate: str, reference: str) -> Outcome:
    """Test that `candidate` resolves fewer pairs than `reference`; counts of work are exact, times are
    shown too.
    """
    runs, times = study.runs_of(experiment), process_medians(study.times_of(experiment))
    before, after = (runs[runs[axis] == value] for value in (reference, candidate))
    if before.empty or after.empty:
        return no_records(experiment)
    work = judge_one(log_ratios(before, after, value="pair_resolves")["log_ratio"])
    slow, fast = (times[times[axis] == value] for value in (reference, candidate))
    seconds = judge_one(log_ratios(slow, fast)["log_ratio"])
    measured = (
        f"{candidate} against {reference}: {change(work)} of pair resolves ({work['verdict']}); "
        f"{change(seconds)} of time, {blocks(seconds)} ({seconds['verdict']})"
    )
    if work["blocks"] < 2:
        return Outcome(OPEN, measured, "needs at least two blocks")
    return _judged(work["verdict"], "faster", measured.replace("(faster)", "(fewer)", 1))


def best_schedule(study: Study, experiment: str, axis: str, schedule: str, chunk: int) -> Outcome:
    """Test that no other schedule and chunk measured is faster than the chosen one by more than the margin.

    That nothing is faster needs evidence against every alternative (an intersection of tests, each at 5 %);
    that something is faster is Holm-corrected over the alternatives.
    """
    processes = process_medians(study.times_of(experiment))
    if processes.empty:
        return no_records(experiment)
    kind = processes[axis].str.split("_").str[0]
    chosen = processes[(kind == schedule) & (processes["x"] == chunk)]
    others = processes.drop(chosen.index)
    if chosen.empty or others.empty:
        return no_records(experiment, f"{schedule} with chunk {chunk}" if chosen.empty else "any alternative")
    if processes["threads"].max() < 2:
        return Outcome(OPEN, why="on a single thread a schedule shares nothing out: needs 2 hardware threads")
    alternatives = others.groupby(["series", "x"])
    pairs = pd.concat(
        log_ratios(chosen, group).assign(name=f"{series} {x:g}") for (series, x), group in alternatives
    )
    table = judge(pairs, ["name"])
    if table.empty:
        return no_records(experiment, "any block with both sides")
    best = table.loc[table["ratio"].idxmin()]
    undecided = [name for name, group in pairs.groupby("name") if not not_faster(group["log_ratio"])]
    seconds = np.median(chosen["steps_seconds"])
    measured = (
        f"{schedule} {chunk}: {number(seconds)} s on {count(int(chosen['threads'].iloc[0]), 'thread')}; "
        f"best other, {best['name']}: {change(best)} of time, {blocks(best)}"
    )
    faster = list(table.loc[table["verdict"] == "faster", "name"])
    if faster:
        return Outcome(FAILS, measured, f"faster by more than {share(MARGIN)}: {', '.join(faster)}")
    if undecided:
        return Outcome(
            OPEN, measured, f"not settled against {len(undecided)} of {len(table)} others; {TOO_FEW}"
        )
    return Outcome(HOLDS, measured, f"none of {len(table)} others is faster by more than {share(MARGIN)}")


def phase_dominates(study: Study, experiment: str, phase: str, other: str) -> Outcome:
    """Test that the published variant spends more wall time in `phase` than in `other`, over its profiled
    runs.
    """
    phases = study.phases[study.phases["experiment"] == experiment]
    phases = phases[(phases["variant"] == "published") | (phases["series"] == "checkered")]
    walls = phases.pivot_table(index="file", columns="phase", values="wall_seconds")
    if not {phase, other} <= set(walls.columns):
        return no_records(experiment)
    row = judge_one(np.log(walls[phase] / walls[other]))
    part = (walls[[phase, other]].div(walls.sum(axis=1), axis=0)).median()
    measured = (
        f"{phase} takes {share(part[phase])} and {other} {share(part[other])} of the time of a step; their "
        f"ratio is {number(row['ratio'])} [{number(row['low'])}, {number(row['high'])}], "
        f"{count(row['blocks'], 'profiled run')}"
    )
    if row["verdict"] == "inconclusive":
        return Outcome(OPEN, measured, TOO_FEW)
    return Outcome(HOLDS if row["verdict"] == "slower" else FAILS, measured)
