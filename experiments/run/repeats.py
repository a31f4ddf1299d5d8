"""How many runs a process of several contenders repeats: the optimum of a nested design.

The variance of what is measured is that between processes plus that within a process over its runs; it falls
with the processes, of which each costs something however few runs it makes (W. G. Cochran, Sampling
Techniques, 3rd ed., 1977, section 10.6, on subsampling). The interval of few processes is wider than their
variance tells, so that from 6 to 48 of them it narrows about as fast as their number grows, and not as its
root. Least is therefore the variance times the square of what a process costs.
"""

import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from experiments.plan.point import PROCESS, Point
from experiments.results.store import Key
from experiments.run.costs import Costs
from support.vocabulary import COUNTS

MOST_RUNS = 30
"""In a process: more would tell of one process alone."""

MOST_SECONDS = 3.0
"""Of the runs of a process, unless one lasts longer: a study looks at its time between processes."""

FEWEST_PROCESSES = 3
"""From which on the variances are estimated."""

AT_ONCE = 2.0
"""The factor by which the number of runs changes at most: variances of a few processes are rough."""

Process = Sequence[Sequence[float]]
"""For each contender, the seconds of its runs in the process, in their order."""


@dataclass(frozen=True)
class Spread:
    """Variances of the log ratios of contenders, within processes and between them; neither is negative."""

    within: float
    between: float


def spread(processes: Sequence[Process]) -> Spread | None:
    """The variances of log ratios, pooled over the contenders; None if too few processes tell them.

    A contender's ratio is taken to the geometric mean of all contenders in the same run. Processes without a
    second run, or with fewer than two contenders, say nothing. All of them have the same contenders.
    """
    ratios = [_ratios(one) for one in processes if len(one) > 1 and min(map(len, one)) > 1]
    if len(ratios) < FEWEST_PROCESSES:
        return None
    within = statistics.fmean(_variance(runs) for process in ratios for runs in process)
    of_runs = within * statistics.fmean(1 / len(process[0]) for process in ratios)
    means = [[statistics.fmean(runs) for runs in process] for process in ratios]
    of_means = statistics.fmean(_variance(column) for column in zip(*means, strict=True))
    return Spread(within, max(0.0, of_means - of_runs))


def best_runs(fixed_seconds: float, run_seconds: float, variances: Spread) -> float:
    """The optimum, not rounded: where (between + within / runs) (fixed + runs run)^2 is least."""
    within, between = variances.within, variances.between
    if within == 0.0:
        return 1.0
    cost = fixed_seconds / max(run_seconds, 1e-9)
    if between == 0.0:
        return cost
    # 2 between runs^2 + within runs - within cost = 0, the root that does not cancel.
    return 2 * within * cost / (within + math.sqrt(within * (within + 8 * between * cost)))


def choose_runs(fixed_seconds: float, run_seconds: float, known: Spread | None, last: int = 0) -> int:
    """How many runs the next process makes, of which one takes `run_seconds` for all contenders together.

    Before anything is known the runs take as long as all else of a process, and there are two where they fit,
    without which nothing ever is known. `last` is the number of runs of
    the last process, 0 before the first.
    """
    if known is None:
        wanted = max(2.0, fixed_seconds / max(run_seconds, 1e-9))
    else:
        wanted = best_runs(fixed_seconds, run_seconds, known)
    if known is not None and last > 0:
        wanted = min(max(wanted, last / AT_ONCE), last * AT_ONCE)
    most = min(MOST_RUNS, MOST_SECONDS / max(run_seconds, 1e-9))
    return max(1, round(min(wanted, most)))


def process_runs(group: Sequence[Point], seen: Mapping[Key, Sequence[float]], costs: Costs) -> int:
    """How many timed runs the next process of these points makes, by what is known of their times: `seen` are
    the runs of earlier processes, by point and block. One where nothing is known of a point.
    """
    if (
        len(group) < 2
        or group[0].verb == PROCESS
        or group[0].kind == COUNTS
        or not all(map(costs.knows, group))
    ):
        return 1
    blocks = sorted(block for point, block in seen if point == group[0].id)
    processes = [[seen.get((point.id, block), ()) for point in group] for block in blocks]
    whole = [process for process in processes if all(process)]
    fixed, run = (sum(map(cost, group)) for cost in (costs.fixed, costs.run))
    return choose_runs(fixed, run, spread(whole), len(whole[-1][0]) if whole else 0)


def _variance(values: Sequence[float]) -> float:
    """The sample variance, in floating point: exact fractions would take seconds of a short study."""
    centre = statistics.fmean(values)
    return math.fsum((value - centre) ** 2 for value in values) / (len(values) - 1)


def _ratios(process: Process) -> list[list[float]]:
    """The log ratios of each contender to the mean of all in the same run."""
    logarithms = [[math.log(max(seconds, 1e-12)) for seconds in runs] for runs in process]
    centres = [statistics.fmean(run) for run in zip(*logarithms, strict=False)]
    return [[value - centre for value, centre in zip(runs, centres, strict=False)] for runs in logarithms]
