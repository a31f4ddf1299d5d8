"""Sentences of captions, generated from the data."""

from collections.abc import Iterable

import pandas as pd

from analysis.statistics.pairs import timed_runs, without_partner
from analysis.statistics.trends import growth, linearity, minimum
from analysis.support.values import Interval
from analysis.support.wording import change, count, exact, interval, interval_of, listed

MEDIANS = "Dots are medians, bars their 95 % bootstrap intervals"
PROCESSES = "A dot is the median of one process"
SCENES = "A dot is the geometric mean over the seeds in one block"


def opening(times: pd.DataFrame, subject: str, dots: str = MEDIANS) -> str:
    """Say what is drawn, on which scene and threads, from how many processes, blocks and sessions."""
    fixed = [
        f"{name} = {exact(times[column].iloc[0])}"
        for name, column in (("N", "particles"), ("L", "side"), ("r", "radius"), ("steps", "steps"))
        if times[column].nunique() == 1
    ]
    if times["threads"].nunique() == 1:
        fixed.append(count(int(times["threads"].iloc[0]), "thread"))
    nouns = {"file": "process", "block": "block", "session": "session"}
    processes, blocks, sessions = (count(times[of].nunique(), noun) for of, noun in nouns.items())
    runs = count(timed_runs(times), "timed run")
    return (
        f"{subject[0].upper()}{subject[1:]} ({', '.join(fixed)}). {dots}: {processes} in {blocks} and "
        f"{sessions}, {runs}, none left out.{_alone(times)}{_kind_of_time(times)}"
    )


def _alone(times: pd.DataFrame) -> str:
    """Say which processes are in no ratio; nothing if all of them are."""
    lone = without_partner(times)
    if lone.empty:
        return ""
    return (
        f" In no ratio: {by_series(lone)}, beside which their session measured nothing to compare them with "
        "in that block."
    )


def differing(names: Iterable[str], table: pd.DataFrame) -> str:
    """Say each ratio of a table, with its name and its verdict."""
    rows = zip(names, table.itertuples(), strict=True)
    return "; ".join(f"{name} {change(row)} ({row.verdict})" for name, row in rows)


def by_series(runs: pd.DataFrame) -> str:
    """Return how many runs there are of each series, in words."""
    return listed(f"{number} of {series}" for series, number in runs.groupby("series").size().items())


def time_axis(times: pd.DataFrame) -> str:
    """Return what the axis of the times is called."""
    return "time, s" if (times["kind"] == "process").any() else "time of the steps, s"


def _kind_of_time(times: pd.DataFrame) -> str:
    """Say which times they are, if not those of the steps."""
    processes = times[times["kind"] == "process"]
    if processes.empty:
        return ""
    own = sorted(processes.loc[processes["time_from"] != "outside", "series"].unique())
    stated = f"; those of {listed(own)} are what the program says itself" if own else ""
    # Which series had no turns where others did, and why.
    alone = processes.dropna(subset=["undisturbed"]).drop_duplicates("series")
    said = "; ".join(f"{row.series} ({row.undisturbed})" for row in alone.sort_values("series").itertuples())
    pause = f" Measured without a pause, in a stretch of its own instead of in turns: {said}." if said else ""
    return f" Times are of whole processes, from outside{stated}.{pause}"


def growth_sentence(times: pd.DataFrame) -> str:
    """Say how the time changes over the whole range, with the fitted exponent."""
    if times["x"].nunique() < 2:
        return ""
    trend = growth(times)
    verdict = {"grows": "The time grows", "falls": "The time falls", "flat": "The time stays the same"}
    said = verdict.get(trend.change.verdict, "No trend is settled")
    return (
        f" {said}: {change(trend.change)} from {exact(trend.first)} to {exact(trend.last)}"
        f"{_with('; fitted exponent', trend.exponent)}."
    )


def linear_sentence(times: pd.DataFrame) -> str:
    """Say whether the time is a straight line, with the exponent over a fixed cost."""
    line = linearity(times)
    if not line.is_measured:
        return growth_sentence(times)
    said = {"linear": "The time is linear", "not linear": "The time is not linear"}
    verdict = said.get(line.verdict, "Whether the time is linear is not settled")
    return f" {verdict}: exponent {interval_of(line, 'ratio')} over a fixed cost."


def minimum_sentence(times: pd.DataFrame) -> str:
    """Say where the time is least, and how far it falls before and rises after."""
    if times["x"].nunique() < 3:
        return growth_sentence(times)
    least = minimum(times)
    where = f"{exact(least.lowest)}{_with('; break point', least.break_point)}"
    return (
        f" The time is least at {where}; against it {change(least.fall)} at the smallest and "
        f"{change(least.rise)} at the largest ({least.fall.verdict})."
    )


def _with(words: str, value: Interval) -> str:
    return "" if pd.isna(value.estimate) else f"{words} {interval(value)}"
