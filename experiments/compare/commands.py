"""The commands that are compared: from lines or words to words, names and surroundings."""

import argparse
import re
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from experiments.compare.sweeps import Levels, combinations, filled
from support.errors import InputError, quoted
from support.vocabulary import AGAIN

WORDS, NEXT = "--", "--vs"
"""Before the words of the first command, and before those of each further one."""

MOST_COMMANDS = 100
"""More are no comparison."""

_OF_A_SHELL = re.compile(r"[^\w ./:,@%^+=-]|(?:^|\s)\w+=")
"""What a shell may act upon: anything but plain words; a word with = in front is a variable to be set."""


@dataclass(frozen=True)
class Compared:
    """One of the commands: what it is called, its words, and the line that the user wrote."""

    name: str
    words: tuple[str, ...]
    line: str
    prepare: tuple[str, ...] = ()
    conclude: tuple[str, ...] = ()
    environment: tuple[tuple[str, str], ...] = ()
    folder: Path = field(default_factory=Path.cwd)
    """Where it is run."""
    levels: Levels = ()
    """The value of each list that its line has."""

    @property
    def has_shell(self) -> bool:
        """Whether a shell starts it."""
        return self.words[:2] == ("sh", "-c")


def split_off(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """The arguments before `--`, and those behind it, which belong to commands."""
    at = list(arguments).index(WORDS) if WORDS in arguments else len(arguments)
    return list(arguments[:at]), list(arguments[at + 1 :])


def commands_of(options: argparse.Namespace, words_behind: Sequence[str]) -> tuple[Compared, ...]:
    """The commands that the options give as lines, or that stand as words behind `--`. Raises InputError."""
    split = _split(words_behind)
    if options.lines and split:
        raise InputError(f"found commands as lines and as words behind {WORDS}, expected only one of the two")
    swept = combinations(options.list, options.range, MOST_COMMANDS)
    levels: list[Levels] = [()] * len(split)
    if split:
        texts = [(shlex.join(words), tuple(words)) for words in split]
    else:
        lines = filled(options.lines, swept)
        texts, levels = [(line, words_of(line)) for line, _ in lines], [one for _, one in lines]
    if not 1 < len(texts) <= MOST_COMMANDS:
        told = f"expected two or more to compare, {MOST_COMMANDS} at most"
        raise InputError(f"found {_commands_said(len(texts))}, {told}")
    names = options.name or names_of([words for _, words in texts], [line for line, _ in texts])
    if len(names) != len(texts):
        raise InputError(f"found {len(names)} names for {_commands_said(len(texts))}, expected one for each")
    _require_names(names)
    before, after = (_beside(options, key, len(texts)) for key in ("prepare", "conclude"))
    own = _environments(options.env, names)
    return tuple(
        Compared(
            name, _with_input(words, options.input), line, before[at], after[at], own[name], levels=levels[at]
        )
        for at, (name, (line, words)) in enumerate(zip(names, texts, strict=True))
    )


def _split(words: Sequence[str]) -> list[list[str]]:
    """The words of each command. Raises InputError for one that has none."""
    if not words:
        return []
    parts: list[list[str]] = [[]]
    for word in words:
        if word == NEXT:
            parts.append([])
        else:
            parts[-1].append(word)
    if not all(parts):
        raise InputError(f"found {NEXT} with no word of a command on one side, expected words on both")
    return parts


def words_of(line: str) -> tuple[str, ...]:
    """The words of a line that has plain words only; else those of a shell that reads it."""
    if not line.strip():
        raise InputError("found an empty line, expected a command")
    return ("sh", "-c", line) if _OF_A_SHELL.search(line) else tuple(line.split())


def names_of(commands: Sequence[Sequence[str]], lines: Sequence[str]) -> list[str]:
    """What commands are called without names: by the words in which they differ, or else by their lines."""
    as_many = len({len(words) for words in commands}) == 1
    if as_many and not any(words[:2] == ("sh", "-c") for words in commands):
        at = [k for k in range(len(commands[0])) if len({words[k] for words in commands}) > 1]
        named = [" ".join(_short(words[k]) for k in at) for words in commands]
        if len(set(named)) == len(named) and not any(map(_is_number, named)):
            return named
    return list(lines)


def _short(word: str) -> str:
    """The last two parts of a path."""
    return (
        "/".join(Path(word).parts[-2:])
        if "/" in word and not word.startswith("./")
        else word.removeprefix("./")
    )


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _require_names(names: Sequence[str]) -> None:
    for name in names:
        if not name.strip() or not name.isprintable():
            raise InputError(f"-n: found {quoted(name)}, expected a name on one line")
        if _is_number(name):
            raise InputError(f"-n: found {quoted(name)}, expected a name that is no number")
        if name.removesuffix(AGAIN) != name and name.removesuffix(AGAIN) in names:
            told = f"which the control is called; expected a name without{AGAIN}"
            raise InputError(f"-n: found {quoted(name)}, {told}")
        if list(names).count(name) > 1:
            raise InputError(f"found {quoted(name)} twice, expected a name for each command: -n gives them")


def reference_of(asked: str | None, names: Sequence[str]) -> str:
    """What the others are compared with: the first if nothing is asked for. Raises InputError."""
    if asked is not None and asked not in names:
        raise InputError(f"--reference: found {quoted(asked)}, expected one of {', '.join(names)}")
    return asked or names[0]


def _beside(options: argparse.Namespace, key: str, commands: int) -> list[tuple[str, ...]]:
    """The words that are run before or after each command's runs."""
    lines = getattr(options, key)
    if len(lines) not in (0, 1, commands):
        raise InputError(
            f"--{key}: found {len(lines)} for {_commands_said(commands)}, expected one, or one for each"
        )
    words = [words_of(line) for line in lines] or [()]
    return words * commands if len(words) == 1 else words


def _environments(settings: Sequence[str], names: Sequence[str]) -> dict[str, tuple[tuple[str, str], ...]]:
    """The variables of each command."""
    own: dict[str, dict[str, str]] = {name: {} for name in names}
    for setting in settings:
        name, colon, rest = setting.partition(":")
        whose = [name] if colon and name in own else list(names)
        variable, equals, value = (rest if colon and name in own else setting).partition("=")
        if not equals or not re.fullmatch(r"[A-Za-z_]\w*", variable):
            raise InputError(
                f"--env: found {quoted(setting)}, expected VARIABLE=VALUE or NAME:VARIABLE=VALUE"
            )
        for one in whose:
            own[one][variable] = value
    return {name: tuple(sorted(variables.items())) for name, variables in own.items()}


def _with_input(words: tuple[str, ...], file: Path | None) -> tuple[str, ...]:
    """The words, behind a shell that opens the file and becomes the command."""
    if file is None:
        return words
    if not file.is_file():
        raise InputError(f"--input: found {file}, expected a file that is there")
    return ("sh", "-c", f'exec "$@" < {shlex.quote(str(file.absolute()))}', "sh", *words)


def _commands_said(number: int) -> str:
    return f"{number} command{'' if number == 1 else 's'}"
