"""How many runs a process of several contenders makes: so many that most of its time is in the clock."""

from collections.abc import Sequence

from experiments.plan.point import PROCESS, Point
from experiments.run.costs import Costs
from support.vocabulary import COUNTS

IN_THE_CLOCK = 3.0
"""Seconds of timed runs for each second that a process takes besides. The rounds of turns are the data, and a
process is one draw of where its memory lies: with turns of a few steps its ratio is hardly any better from
some hundred rounds on."""

MOST_RUNS = 30
"""In a process: more would tell of one process alone."""

FIRST_RUNS = 3
"""At most in a first block, before which what a process takes besides is a guess."""

MOST_SECONDS = 3.0
"""Of the runs of a process, unless one lasts longer: a study looks at its time between processes."""


def choose_runs(fixed_seconds: float, run_seconds: float) -> int:
    """How many runs a process makes, of which one takes `run_seconds` for all contenders together."""
    one = max(run_seconds, 1e-9)
    return max(1, round(min(IN_THE_CLOCK * fixed_seconds / one, MOST_RUNS, MOST_SECONDS / one)))


def process_runs(group: Sequence[Point], costs: Costs) -> int:
    """How many timed runs the next process of these points makes, by what is known of their times; one where
    nothing is known of a point.
    """
    known = all(map(costs.knows, group))
    if len(group) < 2 or group[0].verb == PROCESS or group[0].kind == COUNTS or not known:
        return 1
    runs = choose_runs(sum(map(costs.fixed, group)), sum(map(costs.run, group)))
    return runs if all(map(costs.has_measured, group)) else min(runs, FIRST_RUNS)
