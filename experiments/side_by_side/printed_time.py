"""The time that a program prints, in the one group of a regular expression."""

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NoReturn

from experiments.side_by_side.stated_time import in_quotes, on_one_line
from support.errors import InputError

LONGEST_LINE = 4096
"""Bytes of a line that may hold a time."""

_MINUTE, _HOUR = 60.0, 3600.0

_LARGER = (
    r"(?:([0-9]+)[ \t]*(?:h|hrs?|hours?)(?:[ \t,]|and)*)?"
    r"(?:([0-9]+)[ \t]*(?:m|mins?|minutes?)(?:[ \t,]|and)*)?"
    r"(?:([0-9]+)[ \t]*s(?:ec(?:ond)?s?)?[ \t]*)?"
)
"""Whole hours, minutes and seconds in front of what is left."""
_BEFORE_SECONDS, _BEFORE_GROUP = re.compile(f"{_LARGER}(?=[0-9])"), re.compile(f"{_LARGER}$")
_CLOCK = re.compile(r"[1-9][0-9]*:(?:[0-9]+:)?[0-9]{2}(?:[.,][0-9]+)?$")

_NUMBER = re.compile(r"(?:[0-9]+(?:[.,][0-9]+)*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_MICRO = "\N{MICRO SIGN}\N{GREEK SMALL LETTER MU}\N{REPLACEMENT CHARACTER}"
"""Of Latin-1 it is a byte that is no UTF-8."""
_BLANK = "[ \t\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}\N{THIN SPACE}]"
_SPREAD = rf"(?:{_BLANK}*(?:\N{{PLUS-MINUS SIGN}}|\+/?-){_BLANK}*[0-9.,]+)?"
"""What may stand between a number and its unit: 12 ± 3 ms."""
_UNIT = re.compile(rf"\.?{_SPREAD}{_BLANK}*[(\[]?([{_MICRO}]?[A-Za-z]+)(?![A-Za-z_0-9\u00c0-\u00ff])[)\]]?")
_SECOND = "s(?:ec(?:ond)?s?)?"
_UNITS = (
    (_SECOND, 1.0), (f"m(?:illi)?{_SECOND}", 1e-3), (f"(?:u|micro|[{_MICRO}]){_SECOND}", 1e-6),
    (f"n(?:ano)?{_SECOND}", 1e-9), ("m(?:in(?:ute)?s?)?", _MINUTE), ("h(?:(?:ou)?rs?)?", _HOUR),
)  # fmt: skip

_AMBIGUOUS = re.compile(r"[1-9][0-9]{0,2},[0-9]{3}(?:[eE].*)?")
_BY_COMMAS = re.compile(r"[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:\.[0-9]+)?")
_BY_POINTS = re.compile(r"[1-9][0-9]{0,2}(?:(?:\.[0-9]{3})+,[0-9]+|(?:\.[0-9]{3}){2,})")
_BETWEEN_DIGITS = "[.,'_\N{RIGHT SINGLE QUOTATION MARK}\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}]"
_HAS_BEGUN = re.compile(f"(?:[0-9](?:[eE][-+]?|{_BETWEEN_DIGITS})?|(?:^|[^A-Za-z.])(?:[-.]|\N{MINUS SIGN}))$")
_GOES_ON = re.compile(f"(?:{_BETWEEN_DIGITS}|:|-|[eE][-+]?)?[0-9]")

_THOUSANDS = re.compile(r"(?:^|[^0-9.,])[1-9][0-9]{0,2} $")
_THREE_DIGITS = re.compile(r"[0-9]{3}(?:[.,][0-9]+)?")
_ONE_TO_THREE, _THREE_MORE = re.compile(r"[1-9][0-9]{0,2}"), re.compile(r" [0-9]{3}(?![0-9])")
_BLANK_BEFORE_GROUP, _BLANK_BEHIND_GROUP = re.compile(r"(?: |\\s)[+*]?\("), re.compile(r"\)(?: |\\s)")

_OTHER_UNIT = re.compile(
    rf"{_SPREAD}[ \t]*[(\[]?"
    r"(%|[A-Za-z]*/s|(?:[kKMGT]i?)?B\b|[kMG]?Hz|[kMG]s\b|[mMuUnN]?[sS]\b|[mMhHdD]\b|[afpcdk]s\b|[kwx]\b"
    r"|(?:days?|weeks?|fps|[kKMG]?ops|[tqr]ps|iterations?|items?|frames?|requests?|calls?|rows?)\b)"
)
"""What is no time, or none that is understood: a capital makes another unit of a short one."""
_IN_FRONT = re.compile(rf"(?<![A-Za-z])[(\[](?!m[)\]])([{_MICRO}]?[A-Za-z]+)[)\]][ \t]*[:=]?[ \t]*$")
"""A unit in brackets before a number, as in time [ms]: 12; neither metres nor run(s)."""
_PER_TIME = re.compile(
    r"\^?-1|\N{SUPERSCRIPT MINUS}\N{SUPERSCRIPT ONE}|/(?:s|sec\w*|min\w*|h|hours?|d|days?)\b"
)
"""What makes a rate of a time: 12 ns/day, 12 s^-1."""
_LABELS = re.compile(r"[ \t]*[=:]?[ \t]*[0-9]")
"""What may make a label of what looks like a unit: mean 12.51 min 10.22."""
_AND_MORE = re.compile(r"(?:,? | and )?(?=[0-9])")
_COLOURS = re.compile(rb"\x1b\[[0-9;]*m")
"""Of a terminal."""
_LETTERS = re.compile(r"([A-Za-z]{1,3}|[ \t]*(?:cycles?|ticks?))(?![A-Za-z])")
"""No word, as in 0:03.5elapsed, but for those that count."""


@dataclass(frozen=True)
class _Reading:
    """What stands at the beginning of a text."""

    rest: str
    number: str = ""
    """Without its unit; empty if there is none."""
    value: float | None = None
    unit: float | None = None
    """In seconds."""


@dataclass(frozen=True)
class _Group:
    """What the group of a match holds, with the line around it."""

    before: str
    text: str
    """Without blanks at its ends."""
    behind: str
    ends_match: bool
    """The pattern does not say what follows."""


def printed_time(lines: Iterable[bytes], pattern: str, unit_seconds: float | None = None) -> float:
    """The seconds at the one place of a program's output that an expression with one group matches.

    A number, and in the group or directly behind it a unit from ns to hours; or hours, minutes and seconds in
    a row, as in 1m2.5s. The number may have a decimal comma, or groups of three digits by commas or points.
    Without a unit it is in units of `unit_seconds`. Raises InputError if the expression matches at no place
    or several, takes a part of a longer number or time, or what stands there is ambiguous, no positive
    number, or without any unit.
    """
    first = last = ""
    group, number = _Group("", "", "", ends_match=False), 0
    for line, match in _matches(lines, pattern):
        first, last = (first if number else match[0]), match[0]
        group, number = _group_of(line, match), number + 1
    if number == 0:
        told = "expected one (what goes to standard error is read with `2>&1` behind the command)"
        raise InputError(f"time: '{pattern}' matches 0 lines of standard output, {told}")
    if number > 1:
        told = f"first {in_quotes(first)} and last {in_quotes(last)}, expected once"
        raise InputError(f"time: '{pattern}' matches {number} times in standard output, {told}")
    return _seconds_of(group, pattern, unit_seconds)


def half_a_digit(lines: Iterable[bytes], pattern: str) -> float:
    """Half of the last digit of the time that lines have, as a share of it; 0 where they have none."""
    texts = [_group_of(line, match).text for line, match in _matches(lines, pattern)]
    digits = re.sub(r"[eE].*|[^0-9]", "", texts[-1]) if texts else ""
    return 0.5 / int(digits) if digits.strip("0") else 0.0


def _matches(lines: Iterable[bytes], pattern: str) -> Iterator[tuple[str, re.Match[str]]]:
    """The lines that match, without colours, each with a match."""
    expression = re.compile(pattern, re.ASCII)
    for raw in lines:
        if len(raw) > LONGEST_LINE + 1:
            continue
        line = _COLOURS.sub(b"", raw.rstrip(b"\r\n")).decode(errors="replace")
        for at, match in enumerate(expression.finditer(line)):
            # An empty one is what (.*) leaves behind a first.
            if match[0] or at == 0:
                yield line, match


def _group_of(line: str, match: re.Match[str]) -> _Group:
    begin, end = match.span(1) if match[1] is not None else (len(line), len(line))
    text = line[begin:end].strip(" \t")
    begin = end if not text else line.index(text, begin)
    return _Group(line[:begin], text, line[begin + len(text) :], match.end(1) == match.end())


def _seconds_in(word: str) -> float | None:
    """What a word stands for if it is a unit. A capital makes another unit of a short one."""
    letters = re.IGNORECASE if len(word.encode()) > 2 else re.NOFLAG
    return next((seconds for name, seconds in _UNITS if re.fullmatch(name, word, letters)), None)


def _value_of(number: str) -> float | None:
    """Of a number with a point or a comma before its decimals, with the other one or none between groups of
    three digits, or with several such groups and no decimals.
    """
    if _BY_COMMAS.fullmatch(number):
        number = number.replace(",", "")
    elif _BY_POINTS.fullmatch(number):
        number = number.replace(".", "")
    try:
        value = float(number.replace(",", "."))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _read_number(text: str) -> _Reading:
    number = _NUMBER.match(text)
    if number is None:
        return _Reading(text)
    read = _Reading(text[number.end() :], number[0], _value_of(number[0]))
    unit = _UNIT.match(read.rest)
    if unit is None or (seconds := _seconds_in(unit[1])) is None:
        return read
    return replace(read, rest=read.rest[unit.end() :], unit=seconds)


def _seconds_of_larger_units(found: re.Match[str] | None) -> float:
    if found is None:
        return 0.0
    hours, minutes, seconds = (float(one or 0) for one in found.groups())
    return _HOUR * hours + _MINUTE * minutes + seconds


def _read_time(text: str) -> _Reading:
    """Of hours, minutes, seconds and less in a row, their sum."""
    larger = _BEFORE_SECONDS.match(text)
    if larger and larger[0]:
        last = _read_number(text[larger.end() :])
        least, below = (0.0, 1.0) if larger[3] else (1.0, _MINUTE if larger[2] else _HOUR)
        if last.value is not None and last.unit and least <= last.unit < below:
            # What may be thousands are decimals here, as bash's time prints them where a locale has commas.
            value = last.value / (1000 if _AMBIGUOUS.fullmatch(last.number) else 1)
            seconds = _seconds_of_larger_units(larger) + value * last.unit
            return _Reading(last.rest, larger[0] + last.number, seconds, 1.0)
    one = _read_number(text)
    if text.endswith(f"m{one.rest}"):  # metres, for all we know
        return replace(one, rest=text[len(one.number) :], unit=None)
    return one


def _says(pattern: str, letter: str, *, is_before: bool) -> bool:
    """Whether the pattern itself says this letter directly before its group, or behind it: then it knows that
    it takes a part of what stands there.
    """
    mark = "\\." if letter == "." else letter
    there = (f"{mark}(",) if is_before else (f"){mark}", f")\\{mark}")
    return letter in set(".,'_-") and any(one in pattern for one in there)


def _may_have_thousands(group: _Group, number: str, pattern: str) -> bool:
    """Whether blanks may separate the thousands of a number, of which the group takes a part: three digits
    behind one to three, or one to three before three. Not where the pattern has a blank of its own there.
    """
    return bool(
        (
            _THOUSANDS.search(group.before)
            and _THREE_DIGITS.fullmatch(number)
            and not _BLANK_BEFORE_GROUP.search(pattern)
        )
        or (
            _ONE_TO_THREE.fullmatch(number)
            and _THREE_MORE.match(group.behind)
            and not _BLANK_BEHIND_GROUP.search(pattern)
        )
    )


def _is_cut(group: _Group, read: _Reading, behind: str, pattern: str) -> bool:
    """Whether what the group takes is only a part of a longer number, or of a longer time. `behind` is what
    may go on, nothing if the pattern says what does.
    """
    before = _BEFORE_GROUP.search(group.before)
    is_of_seconds = (read.unit or 1.0) >= 1.0 or (before is not None and before[3] is not None)
    is_last = _seconds_of_larger_units(before) > 0 or _CLOCK.search(group.before + read.number)
    return bool(
        len(read.number) > len(group.text)
        or (len(read.number) == len(group.text) and _GOES_ON.match(behind))
        or (_HAS_BEGUN.search(group.before) and not _says(pattern, group.before[-1], is_before=True))
        or _may_have_thousands(group, read.number, pattern)
        or (is_of_seconds and is_last)
        or _has_more(read)
    )


def _has_more(read: _Reading) -> bool:
    """Whether a time goes on in a smaller unit, which has no more than one of the larger: 12 ms 345 us."""
    gap = _AND_MORE.match(read.rest)
    more = _read_number(read.rest[gap.end() :]) if gap else _Reading("")
    if not (read.unit and more.unit and more.value):
        return False
    return more.value * more.unit < read.unit and more.unit < read.unit


def _is_label(read: _Reading, said: float | None) -> bool:
    """Whether what looks like a unit, and not like the one that is `said`, names the number behind it."""
    next_one = _LABELS.match(read.rest)
    if not read.unit or next_one is None:
        return False
    has_unit = _read_number(read.rest[next_one.end() - 1 :]).unit is not None
    return read.unit >= _MINUTE or (bool(said) and read.unit != said and not has_unit)


def _seconds_of(group: _Group, pattern: str, unit_seconds: float | None) -> float:
    behind = "" if _says(pattern, group.behind[:1], is_before=False) else group.behind
    read = _read_time(group.text + behind)
    if read.number and _is_cut(group, read, behind, pattern):
        line = in_quotes(group.before + group.text + group.behind)
        _refuse(group, f" within a longer number in {line}, expected a pattern that takes all of it")
    in_front = _IN_FRONT.search(group.before)
    said = (in_front and _seconds_in(in_front[1])) or unit_seconds
    if read.number == group.text and _is_label(read, said):
        word = behind[: len(behind) - len(read.rest)].strip()
        told = f", behind which {word} may be its unit or the name of the next number"
        _refuse(group, f"{told}, expected a group that takes the unit, or that number on another line")
    if _AMBIGUOUS.fullmatch(read.number):
        _refuse(group, ", which is ambiguous (thousands, or decimals?), expected a decimal point")
    # Beyond the number it may take the unit, or the point of a whole number.
    is_point = group.text == f"{read.number}." and read.number.isdecimal()
    unit = read.unit or said
    seconds = (read.value or 0.0) * (unit or 1.0)
    is_time = 0 < seconds < math.inf
    if (len(read.rest) > len(behind) and not is_point) or not is_time:
        has_word = is_time and not re.search("[0-9]", read.rest)
        told = "a number, and behind it at most a unit: ns, us, ms, s, min or h"
        more = "a positive number such as 1234.5 with a unit behind it, or several as in 1 min 2.5 s"
        _refuse(group, f", expected {told if has_word else more}")
    if read.unit and (rate := _PER_TIME.match(read.rest)):
        _refuse(group, f" with {in_quotes(rate[0])} behind its unit, expected a time")
    other = None if read.unit else _OTHER_UNIT.match(behind) or (group.ends_match and _LETTERS.match(behind))
    if other:
        minutes = ", such as min where minutes are meant" if other[1] == "m" else ""
        _refuse(group, f" with the unit '{other[1].strip()}', expected a time{minutes}")
    if not unit:
        _refuse(group, " without a unit behind it, expected one such as ms, or --unit")
    return seconds


def _refuse(group: _Group, expected: str) -> NoReturn:
    raise InputError(f"time: found '{on_one_line(group.text)}'{expected}")
