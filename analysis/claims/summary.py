"""A claim and its verdict in few words: for the terminal, for tables and for the figure of all claims."""

from collections.abc import Mapping
from math import isfinite
from typing import Any

from analysis.claims.missing import DECIDED
from analysis.claims.outcome import FAILS, HOLDS, IN_DIRECTION, PLAIN, Verdict
from analysis.statistics.intervals import FEWEST
from analysis.statistics.verdicts import Ratio
from analysis.support.wording import NO_BREAK, count, number

MARKS = {HOLDS: "✓", IN_DIRECTION: "✓", FAILS: "✗"}
LOOKS = {HOLDS: "holds", IN_DIRECTION: "in_direction", FAILS: "fails"}
UNDECIDED, UNMEASURED = "?", "–"
TOO_FEW_BLOCKS = "too few blocks for an interval"
_ON_THE_MARGIN = 0.005
"""An effect so near to the margin is on it: to settle on which side would take thousands of blocks."""
_IN_FULL = 100
"""From this per cent on a change has no decimals."""


def mark(row: Mapping[str, Any]) -> str:
    """Return the sign of a row's verdict, in brackets if it was reached elsewhere than the claim was made."""
    verdict = row["verdict"]
    if verdict in PLAIN:
        return f"({MARKS[PLAIN[verdict]]})"
    return MARKS.get(verdict, UNMEASURED if row["missing"] else UNDECIDED)


def colour_of(row: Mapping[str, Any]) -> str:
    """Return what a verdict is drawn as, wherever it was reached: holds, in_direction, fails or open."""
    return LOOKS.get(PLAIN.get(row["verdict"], row["verdict"]), "open")


def verdict_in_short(row: Mapping[str, Any]) -> str:
    """Return the verdict of a row of `evaluate` in few words; of one that is open, what is known and what it
    lacks.
    """
    said = str(row["said"]).partition(" (claimed")[0]
    if row["verdict"] in DECIDED:
        return said
    if row["missing"]:
        return "not measured"
    if row["verdict"] == Verdict.OTHER_SCALE:
        return said
    if 0 < row["blocks"] < FEWEST:
        return f"not decided: {TOO_FEW_BLOCKS}"
    if not row["blocks"]:
        return "cannot be decided here"
    effect = first_effect(row)
    known = _known_in_short(effect) if effect is not None else ""
    if isfinite(row["needed"]):
        more = count(int(row["needed"]) - row["blocks"], "more block")
        return f"{known}; {more} may decide" if known else f"not decided: about {more}"
    return known or "not decided: not in sight"


def _known_in_short(effect: Ratio) -> str:
    """Return what an interval says although it reaches across the margin."""
    if effect.is_exponent or not effect.has_interval:
        return ""
    most = f"{100 * max(abs(effect.low - 1), abs(effect.high - 1)):.1f}{NO_BREAK}%"
    lies_on_it = any(abs(effect.ratio - end) <= _ON_THE_MARGIN for end in effect.within)
    return f"on the margin, at most {most}" if lies_on_it else f"at most {most}"


def change_in_short(effect: Ratio) -> str:
    """Return what was measured of an effect, e.g. `−10.0 % [−14.7, −5.0]`; an en dash without records."""
    if not effect.is_measured:
        return UNMEASURED
    estimate = _one(effect, effect.ratio, unit=True)
    if not effect.has_interval:
        return f"{estimate} ({TOO_FEW_BLOCKS})"
    low, high = (_one(effect, end) for end in (effect.low, effect.high))
    return f"{estimate} [{low}, {high}]"


def published_in_short(effect: Ratio) -> str:
    """Return what the study measured of an effect, an en dash for what it gives no number of."""
    return _one(effect, effect.published, unit=True) if isfinite(effect.published) else UNMEASURED


def both_in_short(effect: Ratio) -> str:
    """Return what was measured of an effect and what the study measured of it, as part of a sentence."""
    theirs = published_in_short(effect) if isfinite(effect.published) else "no number"
    return f"{change_in_short(effect)} here, {theirs} published"


def _one(effect: Ratio, ratio: float, *, unit: bool = False) -> str:
    if effect.is_exponent:
        return number(ratio, 3)
    change = 100 * (ratio - 1)
    text = f"{change:+.{0 if abs(change) >= _IN_FULL else 1}f}".replace("-", "−")
    return f"{text}{NO_BREAK}%" if unit else text


def first_effect(row: Mapping[str, Any]) -> Ratio | None:
    """Return the first effect of a row that was measured, None without one."""
    return next((one for one in row["effects"] if one.is_measured), None)
