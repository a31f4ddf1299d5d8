"""A ratio with the interval that decides, and the verdict against a margin stated beforehand: faster, slower,
equivalent or inconclusive.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import inf, isfinite, nan
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analysis.statistics.intervals import FEWEST, measure
from analysis.statistics.looks import ERROR, seen, share
from analysis.statistics.turns import spread, unstopped
from analysis.support.values import Floats, Interval

MARGIN = 0.02
INCONCLUSIVE = "inconclusive"
EXPONENT = "exponent"


def within_margin(margin: float) -> tuple[float, float]:
    """Return the ratios between which no difference matters."""
    return 1 / (1 + margin), 1 + margin


@dataclass(frozen=True, kw_only=True)
class Ratio:
    """A ratio, candidate / reference, of times if `what` does not name something else; NaN if it was not
    measured. `low` and `high` are its 95 % interval, which decides and is shown, without end where none is
    known; it rests on so many `blocks`. Between the two ratios of `within` no difference matters. `published`
    is the same as the study tells it, NaN where it tells no number.

    `p` is the smallest error at which the interval decides, over all looks and not cut at 1; in a table it is
    corrected over the rows, and `alone` is p before that. `not_faster`, `not_slower` and `not_equivalent` are
    those at which it has no part in what such a verdict says, whatever else it reaches into; `any_faster` and
    `any_slower` those at which it lies wholly on that side of 1, by however little.
    """

    what: str = ""
    ratio: float = nan
    low: float = 0.0
    high: float = inf
    blocks: int = 0
    p: float = 1.0
    verdict: str = INCONCLUSIVE
    alone: float = 1.0
    not_faster: float = 1.0
    not_slower: float = 1.0
    not_equivalent: float = 1.0
    any_faster: float | None = None
    any_slower: float | None = None
    within: tuple[float, float] = within_margin(MARGIN)
    published: float = nan
    totals: float = nan
    """The ratio of all the time that the two took, in which rare slow turns count in full."""
    start: float = nan
    """The standard deviation of a block's log ratio, beyond what its rounds explain: what a start draws."""
    round: float = nan
    """That of a round's log ratio."""

    @property
    def is_exponent(self) -> bool:
        """Whether it is no ratio of times but the exponent of a curve, which is 1 for a straight line."""
        return self.what == EXPONENT

    @property
    def is_measured(self) -> bool:
        """Whether there are records of it."""
        return isfinite(self.ratio)

    @property
    def has_interval(self) -> bool:
        """Whether there were enough blocks for an interval."""
        return isfinite(self.high)

    def told_as(self, other: "Ratio") -> "Ratio":
        """Return it under the name of another, beside what is published of that."""
        return replace(self, what=other.what, published=other.published)

    def scaled(self, factor: float) -> "Ratio":
        """Return it with all its p-values times a factor."""
        known = {name: getattr(self, name) for name in _P_VALUES}
        return replace(self, **{name: factor * p for name, p in known.items() if p is not None})


_P_VALUES = [field.name for field in fields(Ratio) if field.name in ("p", "alone") or "_" in field.name]
COLUMNS = [field.name for field in fields(Ratio) if field.name not in ("what", "within", "published")]


def of_row(row: Mapping[Any, Any] | pd.Series, **more: Any) -> Ratio:  # noqa: ANN401
    """Return a row of a table of `judge` as the ratio that it was."""
    return Ratio(**({name: row[name] for name in COLUMNS} | more))


def ratio_of(log_ratio: Interval, **more: Any) -> Ratio:  # noqa: ANN401
    """Return the ratio of a logarithm with its interval."""
    ratio, low, high = np.exp(log_ratio).tolist()
    return Ratio(ratio=ratio, low=low, high=high, **more)


def judge(pairs: pd.DataFrame, by: list[str], margin: float = MARGIN, error: float = ERROR) -> pd.DataFrame:
    """Return one row a group of `by`: the fields of its `Ratio`, Holm-corrected over the whole table.

    *faster*: the interval lies below 1 / (1 + margin); *slower*: above 1 + margin; *equivalent*: between the
    two. A verdict is wrong only where the interval misses the truth, in at most 5 % of all, wherever that
    lies: the smallest effect that matters is a region, not two tests at 5 % each (Schuirmann, J.
    Pharmacokinet. Biopharm. 15, 1987, whose 90 % interval errs in 5 % on either side; Westlake, Biometrics
    32, 1976, whose 95 % interval is used here). `p` is corrected over the looks (see `looks`), as the
    interval is, and over the rows (Holm, Scand. J. Stat. 6, 1979). What is not established, and anything from
    fewer than `FEWEST` blocks, is *inconclusive*. The pairs of a group are in the order of time. With another
    `error` than 5 % the intervals are of its level.
    """
    groups = pairs.groupby(by, sort=True)
    rows = [
        dict(zip(by, key, strict=True)) | vars(judge_pairs(group, margin, error)) for key, group in groups
    ]
    return corrected(pd.DataFrame(rows, columns=[*by, *COLUMNS]), error)


def corrected(table: pd.DataFrame, error: float = ERROR) -> pd.DataFrame:
    """Return the table with p-values Holm-corrected and verdicts withdrawn where they no longer stand."""
    p = holm(table["p"])
    verdicts = np.where(np.array(p) <= error, table["verdict"], INCONCLUSIVE)
    return table.assign(p=p, verdict=verdicts)


def judge_pairs(pairs: pd.DataFrame, margin: float = MARGIN, error: float = ERROR) -> Ratio:
    """Return the ratio of the rows of `pairs.log_ratios`, with what they tell of turns and stops."""
    turns = {"biases": pairs.get("bias"), "stops": pairs.get("stops")}
    found = judge_one(pairs["log_ratio"], margin, error, **turns)
    if "round" not in pairs or len(pairs) < FEWEST:
        return found
    pairs = pairs.iloc[: found.blocks]
    totals = pairs["seconds_candidate"].sum() / pairs["seconds_reference"].sum()
    of_round = float(np.sqrt((pairs["round"] ** 2).median()))
    explained = (pairs["round"] ** 2 / pairs["rounds"]).median()
    start = float(np.sqrt(max(0.0, spread(np.asarray(pairs["log_ratio"])) ** 2 - explained)))
    return replace(found, totals=float(totals), round=of_round, start=start if of_round == of_round else nan)


def judge_one(
    log_ratios: ArrayLike,
    margin: float = MARGIN,
    error: float = ERROR,
    *,
    once: bool = False,
    biases: ArrayLike | None = None,
    stops: ArrayLike | None = None,
) -> Ratio:
    """Return one comparison standing alone.

    The log ratios are in the order of time; those up to the last planned look count. `once`: how many values
    there are was settled before the first of them, and each has a seed of its own: they are looked at once,
    the whole of the error is this look's, and none depends on the one before. `biases`: by how much each log
    ratio is too great because of how it was measured, NaN where not known. Where half of them are known, and
    the middle of the means of each two is more than two of its standard errors from 0, the verdict has to
    stand with and without it, and the interval reaches over both: turns of every second block begin at other
    steps, so that unlike steps leave the mean of two. `stops`: how often a run of the programs was stopped;
    where some blocks have far more, the ratio is that of no stops at all (see `turns`).
    """
    values = np.asarray(log_ratios, dtype=float)
    values = values if once else seen(values)
    if stops is not None and len(values) >= FEWEST:
        values, factor = unstopped(values, np.asarray(stops, dtype=float)[: len(values)])
        if factor > 1:
            return _judged(values, margin, error, once, factor)
    known = np.empty(0) if biases is None else np.asarray(biases, dtype=float)[: len(values)]
    known = known[~np.isnan(known)]
    row = _judged(values, margin, error, once)
    of_two = known[: known.size // 2 * 2].reshape(-1, 2).mean(axis=1)
    if not 0 < len(values) <= 2 * known.size or not _is_sure(of_two):
        return row
    return _both(row, _judged(values - np.median(of_two), margin, error, once))


def _is_sure(biases: Floats) -> bool:
    """Whether their middle is none by chance; the error of a median is that of a mean times a fourth more."""
    if len(biases) < 2:
        return False
    error = np.sqrt(np.pi / 2) * biases.std(ddof=1) / np.sqrt(len(biases))
    return bool(abs(np.median(biases)) > 2 * error)


def _judged(values: Floats, margin: float, error: float, once: bool, factor: float = 1.0) -> Ratio:
    part = 1.0 if once else share(len(values))
    found = measure(values, independent=once, factor=factor)
    ratio = ratio_of(found.interval(1 - error * part), blocks=len(values))
    return _decided(ratio, found.p_value, margin, part, error)


def _decided(
    ratio: Ratio, p_value: Callable[[float, Any], float], margin: float, part: float, error: float = ERROR
) -> Ratio:
    """Return the ratio with its verdict and its p-values over all looks, given the one-sided p-value of "it
    is not on that side of a bound", of one look alone, which has that `part` of the error.

    They are doubled: at most `error` is where the two-sided interval lies within what the verdict says.
    """
    bound, blocks = np.log1p(margin), ratio.blocks
    one_sided = {"faster": p_value(-bound, "less"), "slower": p_value(bound, "greater")}
    denied = {"not_faster": p_value(-bound, "greater"), "not_slower": p_value(bound, "less")}
    support = {**one_sided, "equivalent": max(denied.values())}
    best = min(support, key=lambda verdict: support[verdict])
    p = two_sided(support[best], blocks, part)
    others = {
        **denied,
        "not_equivalent": min(one_sided.values()),
        "any_faster": p_value(0.0, "less"),
        "any_slower": p_value(0.0, "greater"),
    }
    told: Any = {name: two_sided(one, blocks, part) for name, one in others.items()}
    verdict = best if p <= error else INCONCLUSIVE
    return replace(ratio, verdict=verdict, p=p, alone=p, within=within_margin(margin), **told)


def _both(one: Ratio, other: Ratio) -> Ratio:
    """Return what both say: the hull of their intervals, the greater of their p-values."""
    greater = {name: max(getattr(one, name), getattr(other, name)) for name in ("high", *_P_VALUES)}
    verdict = one.verdict if one.verdict == other.verdict else INCONCLUSIVE
    return replace(one, **greater, low=min(one.low, other.low), verdict=verdict)


def judge_unpaired(reference: ArrayLike, candidate: ArrayLike, margin: float = MARGIN) -> Ratio:
    """Return candidate / reference from the times of a process each, of two sets that were not interleaved,
    as on two machines.

    Uses Welch's t on the logarithms. Whatever changed between the two measurements besides the programs (the
    machine's mood on that day) is not in the interval: only interleaving can see it. `blocks` is the smaller
    number of processes.
    """
    first, second = np.log(np.asarray(reference, dtype=float)), np.log(np.asarray(candidate, dtype=float))
    fewest = min(len(first), len(second))
    estimate = float(second.mean() - first.mean()) if fewest else nan
    if fewest < 2:
        return Ratio(ratio=float(np.exp(estimate)), blocks=fewest)
    from scipy import stats  # takes half a second to load, and is seldom needed

    def p_value(shift: float, alternative: str) -> float:
        return float(stats.ttest_ind(second - shift, first, equal_var=False, alternative=alternative).pvalue)

    part = share(fewest)
    shown = stats.ttest_ind(second, first, equal_var=False).confidence_interval(1 - ERROR * part)
    ratio = ratio_of(Interval(estimate, float(shown.low), float(shown.high)), blocks=fewest)
    return replace(_decided(ratio, p_value, margin, part), any_faster=None, any_slower=None)


def error_of_picked(candidates: int) -> float:
    """Return the error of one of all comparisons between so many candidates, for `judge_one`: who compares
    the best of them with another has picked one of all pairs. All together may err in 5 % (Bonferroni).
    """
    return ERROR / max(1, candidates * (candidates - 1) // 2)


def two_sided(p: float, blocks: int, part: float | None = None) -> float:
    """Return the p-value at which the two-sided interval decides what a one-sided test gives `p` for, over
    all looks, or over that `part` of the error; 1 from fewer than `FEWEST` blocks. It is not cut at 1, so
    that it tells how far a verdict is.
    """
    return 2 * p / (share(blocks) if part is None else part) if blocks >= FEWEST else 1.0


def holm(p_values: Sequence[float] | pd.Series) -> list[float]:
    """Return the p-values adjusted by Holm's step-down method, in the order given."""
    p = np.asarray(p_values, dtype=float)
    order = np.argsort(p)
    adjusted = np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1)).clip(max=1.0)
    result = np.empty_like(p)
    result[order] = adjusted
    return [float(value) for value in result]
