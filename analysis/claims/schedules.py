"""Claims that one choice is the one to make: no other that was measured is faster."""

from dataclasses import replace
from math import inf, nan

import numpy as np
import pandas as pd

from analysis.claims.entry import Evidence
from analysis.claims.family import both
from analysis.claims.outcome import FAILS, OPEN, TOO_FEW, Outcome, judged, no_records, told, unmeasured
from analysis.statistics.looks import ERROR
from analysis.statistics.pairs import PAIR, log_ratios
from analysis.statistics.verdicts import INCONCLUSIVE, MARGIN, Ratio, judge, judge_one, of_row, within_margin
from analysis.support.wording import blocks, change, count, number

ONE_THREAD = "on a single thread a schedule shares nothing out: needs 2 hardware threads"
EFFECTS = ("best other", "against the others")
NOT_BETTER = {
    "equivalent": "equivalent to the others on average: it does not matter which is chosen",
    "slower": "slower than the others on average",
    "not faster": "not faster than the others on average by more than the margin",
}


def nothing_faster(pairs: pd.DataFrame, margin: float = MARGIN) -> Outcome:
    """Test that no alternative is faster by more than the margin; `pairs` has `name` and `log_ratio` =
    ln(alternative / choice). Its effect is the fastest alternative, by its name.

    That nothing is faster needs evidence against every alternative (an intersection of tests, each at 5 %);
    that something is faster is Holm-corrected over the alternatives.
    """
    table = judge(pairs, ["name"], margin)
    fastest = table.loc[table["ratio"].idxmin()]
    best, others = of_row(fastest, what=fastest["name"], within=within_margin(margin)), len(table)
    faster, fewest = table[table["verdict"] == "faster"], int(table["blocks"].min())
    if len(faster):
        why = f"faster by more than {100 * margin:g} %: {', '.join(faster['name'])}"
        return Outcome(FAILS, why=why, p=float(faster["p"].min()), blocks=fewest, effects=(best,))
    undecided = int((table["not_faster"] > ERROR).sum())
    verdict = INCONCLUSIVE if undecided else "not faster"
    row = Ratio(blocks=fewest, p=float(table["not_faster"].max()), verdict=verdict)
    why = f"not settled against {undecided} of {others} others; {TOO_FEW}"
    found = judged(row, "not faster", unsettled=why)
    why = found.why or f"none of {others} others is faster by more than {100 * margin:g} %"
    ahead = table["not_equivalent"].where(table["ratio"] < 1, inf)
    against = float(ahead.min()) * others if undecided else None
    return replace(found, why=why, against=against, effects=(best,))


def best_schedule(evidence: Evidence, experiment: str, axis: str, schedule: str, chunk: int) -> Outcome:
    """Test that a schedule is the one to choose, which says two things: that no other one measured is faster,
    and that choosing matters, so that it is faster than the others on average. If that is by
    less than the margin, so does the claim hold.

    Were the first enough, the claim would hold where all schedules tie; a tie refutes claims about two
    choices, and so it does here. The average is that of the log ratios within each block.
    """
    processes = evidence.study.times_of(experiment)
    published = list(map(unmeasured, EFFECTS, _published(evidence, experiment, schedule, chunk)))
    if processes.empty:
        return no_records(experiment, effects=published)
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
    average = judge_one(-table.mean(axis=1), margin).told_as(published[1])
    seconds = number(float(np.median(chosen["steps_seconds"])))
    threads = count(int(chosen["threads"].iloc[0]), "thread")
    found = nothing_faster(pairs, margin)
    (best,) = found.effects
    other = f"best other, {best.what}: {change(best)} of time, {blocks(best)}"
    measured = f"{schedule} {chunk}: {seconds} s on {threads}; {other}"
    found = replace(found, measured=measured, effects=(best.told_as(published[0]),))
    said = f"against the others on average {change(average)} of time, {blocks(average)}"
    matters = judged(average, "faster", said)
    if matters.verdict == FAILS:
        matters = replace(matters, why=NOT_BETTER[told(average, "faster")])
    return both([found, matters])


def _published(evidence: Evidence, experiment: str, schedule: str, chunk: int) -> tuple[float, float]:
    """Return the published best other against the choice, and the choice against the mean of the others."""
    times = evidence.published.experiment(experiment)
    chosen = (times["series"] == schedule) & (times["x"] == chunk)
    if not chosen.any() or chosen.all():
        return nan, nan
    choice, others = float(times.loc[chosen, "seconds"].iloc[0]), times.loc[~chosen, "seconds"]
    return float(others.min() / choice), float(choice / np.exp(np.log(others).mean()))
