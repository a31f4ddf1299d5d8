"""Paired ratios: two configurations measured in one block of the interleaving, by one session on one node."""

import numpy as np
import pandas as pd

from analysis.statistics.turns import bias, location, spread
from analysis.support.values import Floats

PAIR = ["node", "block", "session"]
"""What two records of a pair have in common: nothing else was measured together."""

_FEWEST_ROUNDS = 3
"""Of which a spread is made."""


def scaled(times: pd.DataFrame, value: str, factor: pd.Series) -> pd.DataFrame:
    """Return the times with `value` beside `steps_seconds`: that times a factor for each process, of the
    process and of each of its runs.
    """
    parts = {
        name(value): times[name("steps_seconds")] * factor
        for name in (runs_of, rounds_of)
        if name("steps_seconds") in times
    }
    return times.assign(**{value: times["steps_seconds"] * factor, **parts})


def timed_runs(times: pd.DataFrame) -> int:
    """Return how many runs were timed."""
    return int(times[runs_of("steps_seconds")].map(len).sum())


def join_replicates(times: pd.DataFrame) -> pd.DataFrame:
    """Return the times with the replicates that a block has of one point, by series and x, as one process:
    the geometric mean of theirs. What the block suffers they share, so that they are no samples of it; times
    without replicates are returned as they are.
    """
    keys = ["series", "x", *PAIR]
    if not times.duplicated(keys).any():
        return times
    logs = np.log(times["steps_seconds"]).groupby([times[key] for key in keys]).transform("mean")
    joined = times.assign(steps_seconds=np.exp(logs)).drop_duplicates(keys)
    parts = [runs_of("steps_seconds"), rounds_of("steps_seconds")]
    return joined.drop(columns=parts, errors="ignore")


def log_ratios(
    reference: pd.DataFrame,
    candidate: pd.DataFrame,
    match: tuple[str, ...] = (),
    value: str = "steps_seconds",
    by: tuple[str, ...] = (),
) -> pd.DataFrame:
    """Return a row a pair, in the order of time: the columns of `by` and of `match`, those of `PAIR`,
    `log_ratio` = ln(candidate / reference), `bias`, by how much turns make it too great, `stops`, how
    often a run of whole programs was stopped, `round`, the standard deviation of the log ratio of a round, of
    which it has so many `rounds` (NaN where not known), and the seconds of a run of either, all of its turns.
    Each group of candidates that the columns `by` tell apart is compared on its own.

    Takes a row a process on either side. Where the two took turns, each turn of the one stands beside that of
    the other in the same round, and Huber's location of the rounds' log ratios is the block's: a burst of
    noise spoils a round or two. Where they took turns through several whole runs alone, it is the median over
    the runs. Of the replicates that a block has of one configuration it takes the mean logarithm, since
    the median of several lies below a single time wherever noise is skewed. Drift from block to block cancels
    in the ratio, which is why blocks and not samples are the unit of every interval. A process without a
    partner of its own session has no ratio: the machine may have been another since.
    """
    keys = [*match, *PAIR]
    sides = _per_block(reference, keys, value), _per_block(candidate, [*by, *keys], value)
    joined = pd.merge(*sides, on=keys, suffixes=("_reference", "_candidate"))
    ratios = list(map(_block_ratio, joined["logs_reference"], joined["logs_candidate"]))
    biases = list(map(bias, joined["lost_reference"], joined["lost_candidate"]))
    stops = (joined["stops_reference"] + joined["stops_candidate"]) / 2
    spreads = list(map(_round_spread, joined["logs_reference"], joined["logs_candidate"]))
    seconds = joined[["seconds_reference", "seconds_candidate"]]
    found = joined[[*by, *keys, "at_reference"]].assign(
        log_ratio=np.array(ratios, dtype=float), bias=biases, stops=stops, round=spreads,
        rounds=joined["logs_candidate"].map(len), **seconds,
    )  # fmt: skip
    return found.sort_values(["at_reference", *PAIR], kind="stable").drop(columns="at_reference")


def narrow(times: pd.DataFrame, *keys: str, value: str = "steps_seconds") -> pd.DataFrame:
    """Return the columns `keys` and those that ratios and summaries of `value` need: the fewer a table has,
    the faster are its parts.
    """
    needed = [*keys, *PAIR, "file", "recorded_at", "lost_by_turns", "stops", value]
    needed += [runs_of(value), rounds_of(value)]
    return times[[column for column in dict.fromkeys(needed) if column in times]]


def block_curves(processes: pd.DataFrame) -> pd.DataFrame:
    """Return ln(seconds) of each block (rows, by `PAIR`, in the order of time) at each x (columns), NaN where
    a block lacks an x.

    Where those of a block took turns, each turn is compared with the mean of its round first, and a point is
    Huber's location of what is left, above that of the rounds: a burst of noise spoils a round or two.
    """
    table = _per_block(narrow(processes, "x"), ["x", *PAIR], "steps_seconds").sort_values([*PAIR, "x"])
    ln = table.groupby(PAIR)["logs"].transform(lambda logs: _curve(list(logs)))
    return table.assign(ln=ln).pivot(index=PAIR, columns="x", values="ln")


def _curve(logs: list[Floats]) -> list[float]:
    if len({len(one) for one in logs}) > 1:
        return list(map(_middle, logs))
    rounds = np.stack(logs).mean(axis=0)
    return [location(one - rounds) + location(rounds) for one in logs]


def ratios_of(
    processes: pd.DataFrame, column: str, reference: object, candidate: object, match: tuple[str, ...] = ()
) -> pd.DataFrame:
    """Return `log_ratios` of the processes with one value in a column against those with another."""
    processes = narrow(processes, column, *match)
    sides = [processes[processes[column] == value] for value in (reference, candidate)]
    return log_ratios(sides[0], sides[1], match)


def without_partner(runs: pd.DataFrame) -> pd.DataFrame:
    """Return the runs, a row each, that are in no ratio: of what they are compared with, nothing was measured
    in their block by their session.

    Compared are the series of a scene at one x, or the values of x where a single series has that x.
    """
    scene = runs["scene_name"].fillna("")
    place = [scene, runs["x"]]
    several = runs["series"].groupby(place).transform("nunique") > 1
    together = [scene, *(runs[key] for key in PAIR)]
    beside = runs["series"].groupby([*together, runs["x"]]).transform("nunique")
    along = runs["x"].groupby(together).transform("nunique")
    has_others = several | (runs["x"].groupby(scene).transform("nunique") > 1)
    return runs[has_others & (beside.where(several, along) < 2)]


def _per_block(processes: pd.DataFrame, keys: list[str], value: str) -> pd.DataFrame:
    """Return what each block has beside its `keys`: `logs` of its rounds, or of its runs, the time `at` which
    it was recorded, the `seconds` of a run, the share of its time `lost` by turns, and its `stops`.
    """
    runs = processes.get(runs_of(value), processes[value])
    rounds = processes.get(rounds_of(value), runs)
    parts = [one if len(np.atleast_1d(one)) else run for one, run in zip(rounds, runs, strict=True)]
    logs = [np.log(np.atleast_1d(np.asarray(one, dtype=float))) for one in parts]
    seconds = [float(np.mean(one)) for one in runs]
    at = processes.get("recorded_at", processes["block"])
    told = {"lost": processes.get("lost_by_turns", np.nan), "stops": processes.get("stops", np.nan)}
    table = processes[keys].assign(logs=logs, at=at, seconds=seconds, **told)
    if not table.duplicated(keys).any():
        return table
    means = dict.fromkeys(("seconds", "lost", "stops"), "mean")
    return table.groupby(keys).agg({"logs": _of_replicates, "at": "min", **means}).reset_index()


def _of_replicates(logs: pd.Series) -> Floats:
    """Return the mean of the replicates' logs, by round if they have as many, else of their medians."""
    if len({len(one) for one in logs}) > 1:
        logs = logs.map(lambda one: np.array([np.median(one)]))
    return np.mean(np.stack(list(logs)), axis=0)


def _block_ratio(reference: Floats, candidate: Floats) -> float:
    if len(reference) == len(candidate):
        return location(candidate - reference)
    return _middle(candidate) - _middle(reference)


def _round_spread(reference: Floats, candidate: Floats) -> float:
    """Return the robust standard deviation of the log ratio of a round; NaN of fewer than three."""
    if min(len(reference), len(candidate)) < _FEWEST_ROUNDS:
        return np.nan
    if len(reference) == len(candidate):
        return spread(candidate - reference)
    return float(np.hypot(spread(reference), spread(candidate)))


def _middle(logs: Floats) -> float:
    return float(np.log(np.median(np.exp(logs))))


def rounds_of(value: str) -> str:
    """Return the name of the column that holds the value of each turn of a process in its order, empty where
    it took none.
    """
    return f"{value}_of_rounds"


def runs_of(value: str) -> str:
    """Return the name of the column that holds the value of each of a process's runs in their order; the
    column `value` has their median.
    """
    return f"{value}_of_runs"
