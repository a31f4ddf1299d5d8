"""How noisy the machine was, what that allows to decide, and what to do about it; whether it has two speeds;
and how many blocks what is open would need, if its effect and its noise are as measured.
"""

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy import special

from analysis.statistics.intervals import widening_of_independent
from analysis.statistics.looks import ERROR, LOOKS, looks_up_to, next_look
from analysis.statistics.looks import share as share_of_error
from analysis.statistics.pairs import PAIR
from analysis.statistics.verdicts import INCONCLUSIVE, MARGIN
from analysis.support.values import Floats
from analysis.support.wording import count, listed, share

MOST_BLOCKS = 1000
"""Of more, an estimate would say nothing."""


def blocks_to_decide(p: float, blocks: int, family: int = 1) -> float:
    """Return at which look, beyond so many blocks, a verdict is expected; infinite if it is not in sight.

    `p` is that of the verdict best supported, over all looks and not cut at 1 (`verdicts.judge_one`). The
    statistic that it stands for grows as the error of the centre falls; it has to reach what the look asks,
    corrected for `family` claims that are open.
    """
    if blocks < LOOKS[0]:
        return LOOKS[0]
    alone = p * share_of_error(blocks)
    if not 0 < alone < 1:
        return math.inf if alone else next_look(blocks)
    per_block = -special.stdtrit(blocks - 1, alone / 2) * _error(blocks)
    for look in looks_up_to(MOST_BLOCKS):
        asked = -special.stdtrit(look - 1, ERROR * share_of_error(look) / family / 2)
        if look > blocks and per_block >= asked * _error(look):
            return look
    return math.inf


def needed_by_rows(table: pd.DataFrame, error: float) -> list[float]:
    """Return the blocks that are expected to settle each row of a table of `judge`, which was corrected to an
    `error` for all; NaN for a row that is decided.
    """
    undecided = table["verdict"] == INCONCLUSIVE
    # The forecast waits for `ERROR`: a stricter error is that of a larger family.
    family = max(1, round(int(undecided.sum()) * ERROR / error))
    return [
        blocks_to_decide(float(alone), int(blocks), family) if is_open else math.nan
        for alone, blocks, is_open in zip(table["alone"], table["blocks"], undecided, strict=True)
    ]


def _error(blocks: int) -> float:
    """Return the error of a centre in standard deviations of a block, as the interval takes it."""
    return widening_of_independent(blocks) / math.sqrt(blocks)


BURST = 4.0
LARGE_EFFECTS = (
    "trend", "scaling", "machine", "phases", "speed_against_error", "hard_cases", "counts",
)  # fmt: skip
ADVICE = (
    "close other programs, keep the machine on mains power and a fixed clock, run on bare metal or a whole "
    "node rather than a shared virtual machine, and raise the number of blocks"
)


def process_noise(times: pd.DataFrame) -> pd.DataFrame:
    """Return one row an experiment: `noise`, `bursts`, `blocks`, `needed`, `enough`, `small`.

    `noise` is the typical standard deviation of ln(time) from process to process, as a fraction: 0.01 is 1
    %. `bursts` counts the processes that took far longer than that explains. `needed` blocks would let two
    equal configurations be found equivalent 95 times in 100 (infinite for more than `MOST_BLOCKS`). `small`
    tells the experiments that are about small differences, not trends. Those with a single block or
    configuration have no estimate and are left out.
    """
    rows = []
    times = times.assign(**{key: times[key].fillna("") for key in ("label", "scene_name")})
    for experiment, group in times.groupby("experiment"):
        keys = ["series", "x", "label", "replicate", "scene_name"]
        table = group.pivot_table(index=PAIR, columns=keys, values="steps_seconds", aggfunc="median")
        # What has no partner tells nothing of the noise, and a configuration that soon failed would leave no
        # block whole.
        table = table[table.notna().sum(axis=1) > 1]
        table = table.loc[:, 2 * table.notna().sum() >= len(table)].dropna()
        if min(table.shape) < 2:
            continue
        logs = np.log(table.to_numpy())
        noise, blocks = typical_deviation(logs), len(table)
        needed, small = blocks_needed(noise), str(group["question_kind"].iloc[0]) not in LARGE_EFFECTS
        bursts = count_bursts(logs, noise)
        rows.append((experiment, noise, bursts, blocks, needed, blocks >= needed, small))
    columns = ["experiment", "noise", "bursts", "blocks", "needed", "enough", "small"]
    return pd.DataFrame(rows, columns=columns)


def typical_deviation(logs: Floats) -> float:
    """Return the standard deviation of a cell of a blocks x configurations table, without the effects of its
    block and its configuration.

    Both cancel in the difference of two blocks' differences of two configurations, whose standard deviation
    is twice that of a cell; it is estimated from the median of their absolute values over all such
    quadruples, so that bursts hardly count (after Rousseeuw and Croux, J. Am. Stat. Assoc. 88, 1993).
    """
    first, second = np.triu_indices(logs.shape[1], k=1)
    ratios = logs[:, first] - logs[:, second]
    one, other = np.triu_indices(len(ratios), k=1)
    return float(np.median(np.abs(ratios[one] - ratios[other])) / special.ndtri(0.75) / 2)


def count_bursts(logs: Floats, noise: float) -> int:
    """Return how many cells lie more than `BURST` deviations above what block and configuration explain."""
    centred = logs - np.median(logs, axis=0)
    excess = [
        centred[:, column] - np.median(np.delete(centred, column, axis=1), axis=1)
        for column in range(centred.shape[1])
    ]
    return int((np.array(excess) > BURST * np.sqrt(2) * noise).sum())


def blocks_needed(noise: float, margin: float = MARGIN, rate: float = 0.95) -> float:
    """Return the planned look at which two equal configurations come out equivalent at the given rate;
    infinite if `MOST_BLOCKS` are too few, of which an estimate would say nothing. `noise` is per process.
    """
    looks = looks_up_to(MOST_BLOCKS)
    return next((look for look in looks if equivalence_rate(noise, look, margin) >= rate), np.inf)


def needed_said(needed: float) -> str:
    """Return a number of blocks needed in words."""
    return f"{needed:.0f}" if np.isfinite(needed) else f"more than {MOST_BLOCKS}"


def equivalence_rate(noise: float, blocks: int, margin: float = MARGIN) -> float:
    """Return how often the interval of a look finds two equal configurations equivalent, of normal noise that
    does not depend on itself.

    The centre of the log ratios is normal and their deviation, independent of it, a scaled chi; the rate is
    the chance that the interval of the look lies within the margin, averaged over quantiles of the deviation
    and of the autocorrelation that they seem to have.
    """
    true_error = noise * np.sqrt(2 / blocks)
    squares = 2 * special.gammaincinv((blocks - 1) / 2, (np.arange(200) + 0.5) / 200)
    chances = special.ndtri((np.arange(20) + 0.5) / 20)
    widenings = np.array([widening_of_independent(blocks, chance) for chance in chances])
    half_width = (
        special.stdtrit(blocks - 1, 1 - ERROR * share_of_error(blocks) / 2)
        * true_error
        * np.outer(widenings, np.sqrt(squares / (blocks - 1)))
    )
    room = np.maximum(np.log1p(margin) - half_width, 0)
    return float((2 * special.ndtr(room / max(true_error, 1e-12)) - 1).mean())


def warning(noise: pd.DataFrame, settled: Collection[str] = ()) -> str | None:
    """Return the warning to show, with what to do, when an experiment about small differences was too noisy
    for the margin and its verdicts are not `settled` all the same; None if none was.
    """
    asked = noise[noise["small"].astype(bool)]
    short = asked[~asked["enough"].astype(bool) & ~asked["experiment"].isin(list(settled))]
    if short.empty:
        return None
    worst = short.loc[short["needed"].idxmax()]
    said = f"The worst is {worst['experiment']!r}: the time of a process varies by {share(worst['noise'], 1)}"
    others = " The verdicts of the others stand." if len(short) < len(asked) else ""
    return (
        f"The machine was too noisy to settle differences of {share(MARGIN)} in {len(short)} of {len(asked)} "
        f"experiments about small ones: {listed(short['experiment'])}. {said}, with "
        f"{count(worst['bursts'], 'burst')}, which needs {needed_said(worst['needed'])} blocks; "
        f"{worst['blocks']} were run.{others} To do better: {ADVICE}."
    )


FEWEST_TIMES = 8
FACTOR = 1.25
EXPLAINED = 0.94
"""The share of the variance of ln(time) between the two groups: 0.64 for a normal distribution cut at its
middle, more for few times by chance; this is exceeded in about 1 normal sample in 100."""


@dataclass(frozen=True)
class Levels:
    """Two levels of a time: the slower is `factor` times the faster, and has `slow` of `times` values; the
    machine changed between them `changes` times.
    """

    factor: float
    slow: int
    times: int
    changes: int


def levels(times: ArrayLike) -> Levels | None:
    """Return the two levels of times of the same thing, given in the order in which they were measured; None
    if it is not clear that they are two.

    The times are parted where the two groups differ most (Otsu, IEEE Trans. Syst. Man Cybern. 9, 1979). They
    are two levels if that explains at least `EXPLAINED` of the variance, each has two times or more, and the
    levels are a factor of `FACTOR` apart.
    """
    logs = np.log(np.asarray(times, dtype=float))
    if len(logs) < FEWEST_TIMES or np.ptp(logs) == 0:
        return None
    ordered = np.sort(logs)
    sizes = np.arange(2, len(logs) - 1)
    gaps = np.array([ordered[size:].mean() - ordered[:size].mean() for size in sizes])
    between = gaps**2 * sizes * (len(logs) - sizes) / len(logs) ** 2
    best = int(between.argmax())
    if between[best] < EXPLAINED * logs.var() or gaps[best] < np.log(FACTOR):
        return None
    slow = logs > (ordered[sizes[best] - 1] + ordered[sizes[best]]) / 2
    changes = int((slow[1:] != slow[:-1]).sum())
    return Levels(float(np.exp(gaps[best])), int(slow.sum()), len(logs), changes)


def shifting(times: ArrayLike) -> bool:
    """Tell whether times of the same thing, in the order in which they were measured, are of a speed that
    shifts: a factor of `FACTOR` apart, and neighbours more alike than chance would have it.

    That is von Neumann's ratio, of the mean square of successive differences to the variance, at 1 %, of
    ranks, so that bursts hardly count (Bartels, J. Am. Stat. Assoc. 77, 1982).
    """
    values = np.asarray(times, dtype=float)
    count = len(values)
    if count < FEWEST_TIMES or np.quantile(values, 0.9) < FACTOR * np.quantile(values, 0.1):
        return False
    ranks = pd.Series(values).rank().to_numpy()
    ratio = (np.diff(ranks) ** 2).mean() / ranks.var()
    deviation = np.sqrt(4 * (count - 2) / (count**2 - 1))
    return bool(ratio < 2 + special.ndtri(0.01) * deviation)


def in_order(processes: pd.DataFrame) -> Floats:
    """Return the times of processes in the order in which they were measured."""
    ordered = processes.sort_values(["recorded_at", "block", "position"], kind="stable")
    return ordered["steps_seconds"].to_numpy(dtype=float)
