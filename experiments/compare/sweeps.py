"""Values for the placeholders of lines: a command for each combination, and what each value changes."""

import itertools
import re
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation

from experiments.run.progress import several
from support.errors import InputError, quoted

Levels = tuple[tuple[str, str], ...]
"""The names of lists, each with one of its values."""

LINE = "command"
"""The name of the list that several lines are."""

LIST, RANGE = ("-L", "--list"), ("-P", "--range")

_PLACEHOLDER = re.compile(r"(?<!\$)\{([A-Za-z_][\w.-]*)\}")
"""`${NAME}` is a variable of the shell."""
_QUOTED = re.compile(r"'[^']*'|\"(?:\\.|[^\"\\])*\"|\\.", re.DOTALL)
_OF_GIT = re.compile(r"@\{[^}]*\}")


@dataclass(frozen=True)
class Contrast:
    """What a value changes, or what two change together beyond what each does: the sum of the logarithms of
    the commands' times, each with its weight.
    """

    name: str
    weights: Mapping[str, float]
    is_interaction: bool = False


def joined(arguments: Sequence[str]) -> list[str]:
    """The arguments, each list and range as one, whatever its values begin with. Raises InputError for one
    with too few words.
    """
    found, rest = [], list(arguments)
    while rest:
        word = rest.pop(0)
        if word.startswith("--") and rest and re.match(r"-[0-9.]", rest[0]) and not {word} & {*LIST, *RANGE}:
            word = f"{word}={rest.pop(0)}"
        least = 2 if word in LIST else 3 if word in RANGE else 0
        if len(rest) < least:
            expected = "NAME A,B" if word in LIST else "NAME FIRST LAST [STEP]"
            raise InputError(f"{word}: found {several(len(rest), 'word')} behind it, expected {expected}")
        taken = least + (word in RANGE and len(rest) > least and _number(rest[least]) is not None)
        own, rest = rest[:taken], rest[taken:]
        more = list(itertools.takewhile(_is_no_program, rest))
        if more and word in LIST and own[0] in named_in(rest):
            told = f"found {' '.join(more)} behind {own[1]}, which no program is called"
            expected = f"{word} {own[0]} {','.join(one.strip(',') for one in (own[1], *more))}"
            raise InputError(f"{word} {own[0]}: {told}; expected commas between values: {expected}")
        found.append(
            f"--{'list' if word in LIST else 'range'}={chr(0).join((word, *own))}" if least else word
        )
    return found


def _is_no_program(word: str) -> bool:
    return re.fullmatch(r"\w[\w.,/+-]*", word) is not None and shutil.which(word) is None


def combinations(asked: Sequence[str], most: int) -> list[dict[str, str]]:
    """The values of each combination of lists and ranges, as `joined` gives them. Raises InputError, also for
    more than `most`.
    """
    values: dict[str, list[str]] = {}
    for one in asked:
        option, name, *words = one.split(chr(0))
        if not _PLACEHOLDER.fullmatch(f"{{{name}}}"):
            values_of = "A,B" if option in LIST else "FIRST LAST [STEP]"
            expected = f"expected a name that begins with a letter, and then its values: {option} NAME"
            raise InputError(f"{option}: found {quoted(name)}, {expected} {values_of}")
        if name in values:
            raise InputError(f"{option}: found {name} twice, expected one list or range of each name")
        what = f"{option} {name}"
        values[name] = _listed(what, words[0]) if option in LIST else _range(what, words, most)
    number = 1
    for name, of_list in values.items():
        number *= len(of_list)
        if number > most:
            raise InputError(f"{name}: makes {number} commands, expected {most} at most")
    return [dict(zip(values, one, strict=True)) for one in itertools.product(*values.values())]


def _listed(what: str, text: str) -> list[str]:
    """What stands between commas; `\\,` is a comma. Raises InputError for none, or one that comes twice."""
    values = [one.replace("\\,", ",") for one in re.split(r"(?<!\\),", text)]
    twice = next((one for one in values if values.count(one) > 1), None)
    if twice is not None or values == [""]:
        found = "no value" if twice is None else f"{quoted(twice)} twice"
        raise InputError(f"{what}: found {found}, expected values between commas, each once")
    return values


def _range(what: str, words: Sequence[str], most: int) -> list[str]:
    """The numbers from the first to the last, a step of 1 or so much apart."""
    told = f"{what}: found {' '.join(words)}"
    numbers = [_number(one) for one in words]
    first, last, step = (*numbers, Decimal(1))[:3]
    if first is None or last is None or not step:
        raise InputError(f"{told}, expected numbers: FIRST LAST, and a STEP that is not 0")
    count = int((last - first) / step) + 1 if (last - first) / step >= 0 else 0
    if count < 1:
        raise InputError(f"{told}, expected numbers that rise, or a step below 0")
    if count > most:
        raise InputError(f"{told}, which makes {count} commands; expected {most} at most")
    width = len(words[0]) if words[0].startswith("0") and words[0].isdigit() else 0
    return [f"{first + at * step:f}".zfill(width) for at in range(count)]


def _number(text: str) -> Decimal | None:
    try:
        number = Decimal(text)
    except InvalidOperation:
        return None
    return number if number.is_finite() else None


def fill(text: str, values: Mapping[str, str]) -> str:
    """The text with the values in the places of their names."""
    return _PLACEHOLDER.sub(lambda found: values.get(found[1], found[0]), text)


def named_in(texts: Iterable[str]) -> set[str]:
    """The names whose values these texts wait for."""
    return {name for text in texts for name in _PLACEHOLDER.findall(text)}


def require_filled(what: str, line: str) -> None:
    """Raises InputError for a placeholder of a line that is left. What stands between quotes is the business
    of awk and its like, and `@{...}` that of git.
    """
    if left := named_in([_OF_GIT.sub("", _QUOTED.sub("", line))]):
        name = min(left)
        told = f"expected a list or range of that name: -L {name} A,B"
        raise InputError(f"{what}: found {{{name}}}, {told}; or quotes around braces of the command's own")


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
