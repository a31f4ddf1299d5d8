"""The first screen of a study: what was decided, in sentences, and beside the figure what it rests on."""

from collections.abc import Mapping, Sequence
from typing import Any

from analysis.claims.missing import DECIDED
from analysis.claims.summary import (
    UNDECIDED,
    both_in_short,
    colour_of,
    first_effect,
    mark,
    verdict_in_short,
)
from analysis.derived.ladder import headlines
from analysis.figures import Drawn
from analysis.records.studies import Study
from analysis.report.answers import Answer
from analysis.report.words import tell
from analysis.statistics.pairs import log_ratios
from analysis.statistics.verdicts import Ratio, judge_one
from analysis.support.wording import change, count, number
from support.vocabulary import CONTROL

MOST_SENTENCES = 6
_ONE_BY_ONE = 3
"""Claims that hold are told one by one up to so many."""


def sentences(study: Study, rows: Sequence[Mapping[Any, Any]], drawn: Sequence[Drawn]) -> list[Answer]:
    """Return a sentence for each verdict that changed something: what does not hold first; what holds as
    published one by one if it is little, else in one sentence; what is open in one. Each row has the `anchor`
    that it leads to.
    """
    decided = [row for row in rows if row["verdict"] in DECIDED]
    changed = [row for row in decided if colour_of(row) != "holds"]
    changed.sort(key=lambda row: colour_of(row) != "fails")
    holds = [row for row in decided if colour_of(row) == "holds"]
    said = [_of_claim(row) for row in changed]
    said += [_of_claim(row) for row in holds] if len(holds) <= _ONE_BY_ONE else [_of_all(holds)]
    fastest = [one.removesuffix(" (faster)") for one in headlines(study) if one.endswith("(faster)")]
    said += [Answer("✓", "faster", "holds", f"The fastest variant: {fastest[0]}.")] if fastest else []
    if not rows:
        said += _of_comparisons(drawn)
    left = len(said) - MOST_SENTENCES
    more = [Answer("…", "", "plain", f"{count(left, 'more verdict')} below.")] if left > 0 else []
    return [*said[:MOST_SENTENCES], *more, *_open(rows)]


def _of_all(holds: Sequence[Mapping[Any, Any]]) -> Answer:
    elsewhere = sum(mark(row).startswith("(") for row in holds)
    where = f", {elsewhere} of them on other threads or at another scale than claimed" if elsewhere else ""
    links = [(row["anchor"], row["name"]) for row in holds]
    return Answer("✓", "holds", "holds", f"{count(len(holds), 'claim')}{where}:", links=links, rest=".")


def _of_claim(row: Mapping[Any, Any]) -> Answer:
    effect = first_effect(row)
    told = "." if effect is None else f": {both_in_short(effect)}."
    claim = (row["anchor"], row["claim"].rstrip("."))
    return Answer(mark(row), verdict_in_short(row), colour_of(row), links=[claim], rest=told)


def _of_comparisons(drawn: Sequence[Drawn]) -> list[Answer]:
    """Return a sentence for each comparison that came out faster or slower, without claims about any."""
    return [
        Answer("✓", row.verdict, "holds", f"{row.name}: {change(row)} of time.")
        for one in drawn
        if one.verdicts is not None and one.entry.experiment != CONTROL
        for row in one.verdicts.itertuples()
        if row.verdict in ("faster", "slower")
    ]


def _open(rows: Sequence[Mapping[Any, Any]]) -> list[Answer]:
    still_open = [row for row in rows if row["verdict"] not in DECIDED and not row["missing"]]
    if not still_open:
        return []
    one = len(still_open) == 1
    text = f"{count(len(still_open), 'claim')} {'is' if one else 'are'} measured, and pale below."
    return [Answer(UNDECIDED, "not decided", "open", text)]


def beside(study: Study, states: Mapping[str, int]) -> list[tuple[str, str]]:
    """Return machine, time, control and the share decided, as names and values; `states` as of `tally`."""
    verdict, row = control_of(study)
    is_virtual = bool(study.runs["virtualised"].iloc[0])
    return [
        ("Machine", tell("machine", study=study, is_virtual=is_virtual)),
        ("Measured", _time(study)),
        ("Control", tell("control_in_short", verdict=verdict, row=row)),
        *([("Decided", tell("decided", states=states))] if sum(states.values()) else []),
    ]


def _time(study: Study) -> str:
    """Return the days of the first and the last record, and how long the processes took."""
    days = dict.fromkeys(str(end)[:10] for end in study.runs["recorded_at"].agg(["min", "max"]))
    minutes = float(study.runs["process_seconds"].sum()) / 60
    return f"{' to '.join(days)}; {number(minutes, 2)} min of processes; {study.scale} scale"


def control_of(study: Study) -> tuple[str, Ratio]:
    """Return what came of the control, one variant under two labels, and its ratio: the
    verdict, `off` where it is within the margin but its interval leaves out 0, or nothing without records.
    """
    sides = [part for _, part in study.times_of(CONTROL).groupby("label")]
    if len(sides) != 2:
        return "", Ratio()
    row = judge_one(log_ratios(*sides)["log_ratio"])
    is_off = row.verdict == "equivalent" and not row.low <= 1 <= row.high
    return "off" if is_off else row.verdict, row
