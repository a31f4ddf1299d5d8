"""Which cases a Google Benchmark has: it lists them, and whatever else it prints is none of them."""

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from experiments.support import process
from support.errors import InputError, quoted

_LIST_SECONDS = 60.0
_OF_NO_CASE = "^$"
"""A filter that matches no case: each has a name."""


def cases(
    words: Sequence[str],
    pattern: str,
    key: str,
    folder: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> list[str]:
    """The names of the cases that a filter matches, in their order, of the program that the words run.

    A loader or a log may print lines of its own before the list. They are printed for a filter that matches
    nothing as well; and for one that matches a single name only a name is a line more. Raises InputError,
    which begins with `key`, where there is no case, or where it cannot be told which lines are names.
    """

    def lines(of_filter: str) -> Sequence[str]:
        """What it prints for a filter, without blank lines."""
        asked = [*words, "--benchmark_list_tests=true", f"--benchmark_filter={of_filter}"]
        done = process.run(asked, environment, _LIST_SECONDS, folder)
        if done.exit_code != 0:
            raise InputError(f"{key}: asked for its cases by --benchmark_list_tests: {done.reason}")
        if done.dropped:
            raise InputError(f"{key}: found a list of cases that is far too long, expected some MB at most")
        return [line.removesuffix("\r") for line in done.output.split("\n") if line.strip()]

    listed = lines(pattern)
    noise = lines(_OF_NO_CASE) if listed else []
    names = list(listed)
    if noise and Counter(noise) == Counter(listed):
        # It prints the same whatever the filter: what is left are the names without any doubt.
        names = [line for line in listed if _matches(pattern, line) and not re.search(r"\s", line)]
    elif noise:
        candidates = [line for line in dict.fromkeys(listed) if line not in noise]
        names = [line for line in candidates if _is_case(lines, line, len(noise))]
    if not names:
        beside = f"; it prints {quoted(noise[0])} whatever the filter" if noise else _broken(pattern)
        raise InputError(f"{key}.filter: found {quoted(pattern)}, which no case matches{beside}")
    for name in names:
        if "\N{REPLACEMENT CHARACTER}" in name:
            raise InputError(f"{key}: found the case {quoted(name)}, whose name is no UTF-8")
    return names


def filter_of(name: str) -> str:
    """The option that has only one case run, its variants as in NAME/8/real_time included."""
    return f"--benchmark_filter=^{escaped(name)}(/|$)"


def escaped(name: str) -> str:
    """A regular expression for the plain text, by extended and by ECMAScript rules alike: of brackets that
    close, the former know no escape.
    """
    return re.sub(r"([\\.+*?()|\[{^$])", r"\\\1", name)


def _is_case(lines_of: Callable[[str], Sequence[str]], name: str, noise: int) -> bool:
    """Whether a filter for that name alone adds that line, and no other, to what is printed anyway."""
    lines = lines_of(f"^{escaped(name)}$")
    return name in lines and len(lines) - noise == lines.count(name)


def _matches(pattern: str, line: str) -> bool:
    """Whether a filter matches, as far as Python's regular expressions are those of the library."""
    try:
        return "(?" in pattern or "[[" in pattern or re.search(pattern, line) is not None
    except re.error:
        return True


def _broken(pattern: str) -> str:
    """What is wrong with a filter, by Python's rules; nothing of one that is right."""
    try:
        re.compile(pattern)
    except re.error as error:
        return f": as a regular expression it has a fault: {error}"
    return ""
