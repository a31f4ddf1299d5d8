"""The one exception that a user is meant to see, and the hint that goes with a misspelt name."""

import difflib
import json
import os
from collections.abc import Collection, Iterable
from pathlib import Path


class InputError(Exception):
    """Bad input; its text is the one line that the user gets on standard error."""


class Interrupted(BaseException):
    """A signal asked the study to stop. No `Exception`, so that nothing takes it for a failed point."""

    def __init__(self, signal_number: int) -> None:
        super().__init__(f"stopped by signal {signal_number}")
        self.signal_number = signal_number


def quoted(found: str) -> str:
    """What was found, between quotes and on one line, whatever characters it has."""
    return json.dumps(found, ensure_ascii=False)


def require_text(what: str, path: Path) -> None:
    """Raises InputError for a path that is no line of text in UTF-8, as records and reports hold it."""
    if not os.fspath(path).isprintable():
        found = os.fspath(path).encode("unicode_escape").decode("ascii")
        raise InputError(f'{what}: found "{found}", expected a path that is a line of text in UTF-8')


def nearest(found: str, names: Iterable[str]) -> str:
    """`; did you mean "x"?` where one of `names` resembles `found`, else the empty string."""
    matches = difflib.get_close_matches(found, list(names), n=1)
    return f'; did you mean "{matches[0]}"?' if matches else ""


def not_one_of(found: str, names: Collection[str]) -> str:
    """What was found in the place of one of these names, and the nearest of them."""
    return f"found {quoted(found)}, expected one of {', '.join(names)}{nearest(found, names)}"


def cannot(error: OSError) -> str:
    """What the system refused, in one line: the file, the reason, what was expected."""
    path = error.filename2 or error.filename or "a file"
    return f"{path}: {error.strerror or error}, expected a writable place with room"
