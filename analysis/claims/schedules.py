"""Claims that one schedule and chunk is the one to choose."""

from dataclasses import replace
from math import nan

import numpy as np
import pandas as pd

from analysis.claims.alternatives import alternatives
from analysis.claims.effects import effect_of
from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import FAILS, OPEN, Compared, Outcome, directed, judged, no_records, told
from analysis.statistics.pairs import PAIR, log_ratios
from analysis.support.wording import blocks, change, count, exact, number, percent

ONE_THREAD = "on a single thread a schedule shares nothing out: needs 2 hardware threads"

EFFECTS = ("best other", "against the others")
NOT_BETTER = {
    "equivalent": "equivalent to the others on average: it does not matter which is chosen",
    "slower": "slower than the others on average",
    "not faster": "not faster than the others on average by more than the margin",
}


def best_schedule(evidence: Evidence, experiment: str, axis: str, schedule: str, chunk: int) -> Outcome:
    """Test that a schedule is the one to choose, which says two things: that no other one measured is faster,
    and that choosing matters, so that it is faster than the others on average. If that is by
    less than the margin, so does the claim hold.

    Were the first enough, the claim would hold where all schedules tie; a tie refutes claims about two
    choices, and so it does here. The average is that of the log ratios within each block.
    """
    processes = evidence.study.times_of(experiment)
    best_published, *ratios = _published(evidence, experiment, schedule, chunk)
    if processes.empty:
        effects = tuple(effect_of(what, None, ratio) for what, ratio in zip(EFFECTS, ratios, strict=True))
        return replace(no_records(experiment), effects=effects)
    kind = processes[axis].str.split("_").str[0]
    chosen = processes[(kind == schedule) & (processes["x"] == chunk)]
    others = processes.drop(chosen.index)
    if chosen.empty or others.empty:
        return no_records(experiment, f"{schedule} with chunk {chunk}" if chosen.empty else "any alternative")
    if processes["threads"].max() < 2:
        return Outcome(OPEN, why=ONE_THREAD)
    pairs = pd.concat(
        log_ratios(chosen, group).assign(name=f"{series} {x:g}")
        for (series, x), group in others.groupby(["series", "x"])
    )
    if pairs.empty:
        return no_records(experiment, "any block with both sides")
    margin = evidence.margin(experiment)
    # ln(choice / mean of the others) of every block that has all of them.
    table = pairs.pivot_table(index=PAIR, columns="name", values="log_ratio").dropna()
    average = directed(-table.mean(axis=1), margin)
    found = alternatives(pairs, margin)
    best, seconds = found.best, number(float(np.median(chosen["steps_seconds"])))
    measured = (
        f"{schedule} {chunk}: {seconds} s on {count(int(chosen['threads'].iloc[0]), 'thread')}; "
        f"best other, {best['name']}: {change(best)} of time, {blocks(best)}"
    )
    medians = processes.groupby(["series", "x"], as_index=False)["steps_seconds"].median()
    fastest = _least(evidence.published.experiment(experiment), "seconds"), _least(medians, "steps_seconds")
    figures = (
        Compared("fastest measured", *fastest),
        Compared("best other against the choice", best_published, f"{best['name']}: {change(best)}"),
    )
    against = f"against the others on average {change(average)} of time, {blocks(average)}"
    matters = judged(average, "faster", against)
    if matters.verdict == FAILS:
        matters = replace(matters, why=NOT_BETTER[told(average, "faster")])
    rows = zip(EFFECTS, (best, average), ratios, strict=True)
    effects = tuple(effect_of(what, row, published, margin) for what, row, published in rows)
    return replace(both([found.outcome(measured), matters]), figures=figures, effects=effects)


def _published(
    evidence: Evidence, experiment: str, schedule: str, chunk: int
) -> tuple[str, float, float]:  # fmt: skip
    """Return the published best other against the choice, in words and as a ratio, and the choice against
    the mean of the others.
    """
    times = evidence.published.experiment(experiment)
    chosen = (times["series"] == schedule) & (times["x"] == chunk)
    if not chosen.any() or chosen.all():
        return "–", nan, nan
    choice, others = times.loc[chosen, "seconds"].iloc[0], times[~chosen]
    best = others.loc[others["seconds"].idxmin()]
    ratio = float(best["seconds"] / choice)
    average = float(choice / np.exp(np.log(others["seconds"]).mean()))
    return f"{best['series']} {exact(best['x'])}: {percent(ratio - 1)}", ratio, average


def _least(table: pd.DataFrame, value: str) -> str:
    if table.empty:
        return "–"
    least = table.loc[table[value].idxmin()]
    return f"{least['series']} {exact(least['x'])}, {number(least[value], 4)} s"
