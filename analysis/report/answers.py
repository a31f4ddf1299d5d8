"""What each part of the report asks and answers: a question, a mark with a word, and a sentence."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.claims.missing import DECIDED
from analysis.claims.summary import both_in_short, colour_of, mark, verdict_in_short
from analysis.derived.ladder import headlines
from analysis.figures import Drawn
from analysis.records.studies import Study
from analysis.statistics.verdicts import INCONCLUSIVE
from analysis.support.wording import change, count

QUESTIONS_FILE = Path(__file__).parent / "questions.toml"
TELLING = (
    "The time ", "No trend ", "Against ", "Greatest speed-up", "Least measured", "Of ", "Kept: ",
    "Ratios by turns", "Measured on ", "checkered: The time", "By the medians", "Whether the time",
)  # fmt: skip
"""What the sentence of a caption begins with that tells what came out."""
_MOST = 4
"""Comparisons that a sentence tells one by one."""


@dataclass(frozen=True)
class Answer:
    """A sign with its word, the class of both in the style sheet, and a sentence: links, anchors and texts,
    may follow it, and then the rest. `verdict` is the word at length, where there is more to say.
    """

    sign: str
    word: str
    look: str
    sentence: str = ""
    verdict: str = ""
    links: Sequence[tuple[str, str]] = ()
    rest: str = ""


@cache
def questions() -> Mapping[str, str]:
    """Return the question of each experiment that has one in words."""
    return tomllib.loads(QUESTIONS_FILE.read_text(encoding="utf-8"))


def answer(
    study: Study, experiment: str, drawn: Sequence[Drawn], claims: Sequence[Mapping[str, Any]]
) -> Answer:
    """Return what an experiment tells: by its claims, else by its comparisons, else by its caption."""
    about = [row for row in claims if experiment in row["experiments"] and not row["missing"]]
    if about:
        return of_claim(about[0])
    ladder = headlines(study, experiment) if experiment == "ladder" else []
    tables = [one.verdicts for one in drawn if one.verdicts is not None and len(one.verdicts)]
    if tables:
        found = of_comparisons(pd.concat(tables))
        return Answer(found.sign, found.word, found.look, f"{'; '.join(ladder)}.") if ladder else found
    return Answer("·", "measured", "plain", _telling(drawn[0].caption))


def of_claim(row: Mapping[str, Any]) -> Answer:
    """Return the answer that a claim's verdict is."""
    effects = [f"{one.what} {both_in_short(one)}" for one in row["effects"] if one.is_measured]
    said = verdict_in_short(row)
    told = f": {'; '.join(effects)}" if effects else ""
    word = said.partition(" at ")[0] if row["verdict"] in DECIDED else "not decided"
    return Answer(mark(row), word, colour_of(row), f"{str(row['claim']).rstrip('.')}{told}.", said)


def of_comparisons(table: pd.DataFrame) -> Answer:
    """Return the answer that the rows of a table of `verdicts.judge` are, with their `name`."""
    rows = list(table.itertuples())
    undecided = sum(row.verdict == INCONCLUSIVE for row in rows)
    sign, word, look = ("?", "not decided", "open") if undecided == len(rows) else ("✓", "decided", "plain")
    if len(set(table["verdict"])) == 1 and not undecided:
        word = str(rows[0].verdict)
    elif 0 < undecided < len(rows):
        word = f"{len(rows) - undecided} of {len(rows)} decided"
    if len(rows) <= _MOST:
        told = (f"{row.name}: {change(row)} of time, {_verdict(row.verdict)}" for row in rows)
        return Answer(sign, word, look, f"{'; '.join(told)}.")
    counts = table["verdict"].map(_verdict).value_counts()
    told = (f"{amount} {verdict}" for verdict, amount in counts.items())
    return Answer(sign, word, look, f"Of {count(len(rows), 'comparison')}: {', '.join(told)}.")


def _verdict(verdict: str) -> str:
    return "not decided" if verdict == INCONCLUSIVE else str(verdict)


def _telling(caption: str) -> str:
    """Return the sentence of a caption that tells what came out, or nothing."""
    sentences = caption.replace("). ", ").\n").replace(". ", ".\n").splitlines()
    return next((one for one in sentences if one.startswith(TELLING)), "")
