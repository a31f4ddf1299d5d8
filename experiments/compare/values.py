"""Values of options: shares, times, numbers. Each raises what the parser makes a line of."""

import argparse
import re
from collections.abc import Callable
from pathlib import Path

_SECONDS_OF = {"ms": 1e-3, "s": 1.0, "m": 60.0, "min": 60.0, "h": 3600.0}
_MOST_DIGITS = 6

SHORTEST_SLICE, LONGEST_SLICE = 1e-3, 10.0
"""Seconds that a command may run before the next one does."""


def _typed(convert: Callable[[str], float], expected: str, text: str) -> float:
    try:
        return convert(text)
    except (ValueError, KeyError) as error:
        raise argparse.ArgumentTypeError(f"found {text}, expected {expected}") from error


def file(text: str) -> Path:
    """A place for a file."""
    if not text or text.endswith("/"):
        raise argparse.ArgumentTypeError(
            f"found {text or 'nothing'}, which is no name of a file, expected one"
        )
    return Path(text)


def fraction(text: str) -> float:
    """A share below a half, with or without a sign of per cent."""

    def convert(value: str) -> float:
        number = float(value.removesuffix("%")) / (100 if value.endswith("%") else 1)
        if not 0 < number < 0.5:
            raise ValueError
        return number

    return _typed(convert, "a share such as 2% or 0.02, above 0 and below 50%", text)


def duration(text: str) -> float:
    """Seconds, of a number with a unit or without."""

    def convert(value: str) -> float:
        parts = re.fullmatch(r"([0-9.]+)\s*(ms|s|min|m|h)?", value)
        if parts is None or not 0 < float(parts[1]) < 1e6:
            raise ValueError
        return float(parts[1]) * _SECONDS_OF[parts[2] or "s"]

    return _typed(convert, "a time such as 60s or 5min", text)


def turns(text: str) -> tuple[bool | None, float | None]:
    """Whether there are turns, None where it is to be found out, and how long a slice is, if that is said."""
    words: dict[str, bool | None] = {"auto": None, "on": True, "off": False}
    if text in words:
        return words[text], None
    try:
        seconds = duration(text)
    except argparse.ArgumentTypeError:
        seconds = 0.0
    if not SHORTEST_SLICE <= seconds <= LONGEST_SLICE:
        expected = "auto, on, off or the length of a slice, 1ms to 10s"
        raise argparse.ArgumentTypeError(f"found {text}, expected {expected}")
    return True, seconds


def unit(text: str) -> str:
    """A unit with the letter u where it is written with a Greek one."""
    return re.sub("[\N{MICRO SIGN}\N{GREEK SMALL LETTER MU}]", "u", text)


def count(text: str, least: int = 0) -> int:
    """A whole number, of at most six digits."""
    if not (text.isascii() and text.isdigit()) or len(text) > _MOST_DIGITS or int(text) < least:
        raise argparse.ArgumentTypeError(f"found {text}, expected a whole number from {least} on")
    return int(text)


def positive(text: str) -> int:
    """A whole number of at least 1."""
    return count(text, 1)


def codes(text: str) -> tuple[int, ...]:
    """Exit codes between commas."""
    if not re.fullmatch(r"\d{1,3}(,\d{1,3})*", text) or any(int(one) > 255 for one in text.split(",")):
        raise argparse.ArgumentTypeError(f"found {text}, expected exit codes between commas, 0 to 255")
    return tuple(int(one) for one in text.split(","))
