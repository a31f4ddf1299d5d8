"""How many runs a process of several contenders repeats: the classical optimum of a nested design.

The variance of what is measured falls with the processes (variance between them) and with all runs (variance
within a process). A process costs something however few runs it makes. Least is the variance for a time with

    runs = sqrt(cost of a process without its runs / cost of a run * variance within / variance between)

(W. G. Cochran, Sampling Techniques, 3rd ed., 1977, section 10.6, on subsampling).
"""

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

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
    within = statistics.fmean(statistics.variance(runs) for process in ratios for runs in process)
    of_runs = within * statistics.fmean(1 / len(process[0]) for process in ratios)
    means = [[statistics.fmean(runs) for runs in process] for process in ratios]
    of_means = statistics.fmean(statistics.variance(column) for column in zip(*means, strict=True))
    return Spread(within, max(0.0, of_means - of_runs))


def best_runs(fixed_seconds: float, run_seconds: float, variances: Spread) -> float:
    """The optimum, not rounded; infinite where processes do not differ."""
    if variances.within == 0.0:
        return 1.0
    if variances.between == 0.0 or run_seconds <= 0.0:
        return math.inf
    return math.sqrt(fixed_seconds / run_seconds * variances.within / variances.between)


def choose_runs(fixed_seconds: float, run_seconds: float, known: Spread | None, last: int = 0) -> int:
    """How many runs the next process makes, of which one takes `run_seconds` for all contenders together.

    Before anything is known the runs take as long as all else of a process. `last` is the number of runs of
    the last process, 0 before the first.
    """
    wanted = fixed_seconds / max(run_seconds, 1e-9) if known is None else best_runs(
        fixed_seconds, run_seconds, known
    )  # fmt: skip
    if known is not None and last > 0:
        wanted = min(max(wanted, last / AT_ONCE), last * AT_ONCE)
    most = min(MOST_RUNS, MOST_SECONDS / max(run_seconds, 1e-9))
    return max(1, round(min(wanted, most)))


def _ratios(process: Process) -> list[list[float]]:
    """The log ratios of each contender to the mean of all in the same run."""
    logarithms = [[math.log(max(seconds, 1e-12)) for seconds in runs] for runs in process]
    centres = [statistics.fmean(run) for run in zip(*logarithms, strict=False)]
    return [[value - centre for value, centre in zip(runs, centres, strict=False)] for runs in logarithms]
