"""Values for the placeholders of lines: a command for each combination, and what each value changes."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from support.errors import InputError

Levels = tuple[tuple[str, str], ...]
"""The names of lists, each with one of its values."""

LINE = "command"
"""The name of the list that several lines are."""


@dataclass(frozen=True)
class Contrast:
    """What a value changes, or what two change together beyond what each does: the sum of the logarithms of
    the commands' times, each with its weight.
    """

    name: str
    weights: Mapping[str, float]
    is_interaction: bool = False


def combinations(
    lists: Sequence[Sequence[str]], ranges: Sequence[Sequence[str]], most: int
) -> list[dict[str, str]]:
    """The values of each combination of `-L NAME A,B` and `-P NAME FIRST LAST`, somewhat more than `most` at
    the most. Raises InputError.
    """
    values: dict[str, list[str]] = {}
    for name, text in lists:
        values[name] = text.split(",")
    for name, first, last in ranges:
        try:
            numbers = range(int(first), int(last) + 1)
        except ValueError as error:
            raise InputError(
                f"-P: found {name} {first} {last}, expected a name and two whole numbers"
            ) from error
        values[name] = [str(one) for one in numbers[: most + 1]]
        if not values[name]:
            raise InputError(f"-P: found {name} from {first} to {last}, expected numbers that rise")
    found = itertools.islice(itertools.product(*values.values()), most + 1)
    return [dict(zip(values, one, strict=True)) for one in found]


def filled(lines: Sequence[str], values: Sequence[Mapping[str, str]]) -> list[tuple[str, Levels]]:
    """Each line with each combination of values that makes another one, and the levels that it stands for.
    Raises InputError for a value that no line uses.
    """
    for name in values[0]:
        if not any(f"{{{name}}}" in line for line in lines):
            raise InputError(f"found values for {name}, expected {{{name}}} in a command")
    if not values[0]:
        return [(line, ()) for line in lines]
    found: dict[str, Levels] = {}
    for line in lines:
        for one in values:
            text = line
            for name, value in one.items():
                text = text.replace(f"{{{name}}}", value)
            of_line = ((LINE, line),) if len(lines) > 1 else ()
            used = tuple((name, value) for name, value in one.items() if f"{{{name}}}" in line)
            found.setdefault(text, (*of_line, *used))
    return list(found.items())


def contrasts(levels: Mapping[str, Levels]) -> list[Contrast]:
    """What each value of a list changes against its first, in the mean over all others, and what each two
    values of two lists change together; of commands that are all combinations of two lists or more, by name.
    Nothing of any others.
    """
    values: dict[str, list[str]] = {}
    for of_command in levels.values():
        for name, value in of_command:
            values.setdefault(name, [])
            if value not in values[name]:
                values[name].append(value)
    called = {frozenset(one): command for command, one in levels.items()}
    full = {frozenset(zip(values, one, strict=True)) for one in itertools.product(*values.values())}
    if len(values) < 2 or full != set(called):
        return []
    steps = [(name, first, value) for name, (first, *others) in values.items() for value in others]
    found = [_contrast([step], called) for step in steps]
    pairs = itertools.combinations(steps, 2)
    return found + [_contrast(pair, called) for pair in pairs if pair[0][0] != pair[1][0]]


Step = tuple[str, str, str]
"""A list with its first value and another one."""


def _contrast(steps: Sequence[Step], called: Mapping[frozenset[tuple[str, str]], str]) -> Contrast:
    """That of going one or two steps: the product of their signs is a command's weight."""
    weights = {command: _sign(levels, steps) for levels, command in called.items()}
    weights = {command: weight for command, weight in weights.items() if weight}
    each = 2 ** len(steps) / len(weights)
    said = " and ".join(f"{name} {value} instead of {first}" for name, first, value in steps)
    return Contrast(said, {command: each * weight for command, weight in weights.items()}, len(steps) > 1)


def _sign(levels: frozenset[tuple[str, str]], steps: Sequence[Step]) -> int:
    sign = 1
    for name, first, value in steps:
        sign *= ((name, value) in levels) - ((name, first) in levels)
    return sign
