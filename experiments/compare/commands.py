"""The commands that are compared: from lines or words to words, names and surroundings."""

import argparse
import itertools
import os
import re
import shlex
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from experiments.compare.sweeps import LINE, Levels, combinations, fill, joined, named_in, require_filled
from experiments.run.progress import several
from support.errors import InputError, quoted
from support.vocabulary import AGAIN

WORDS, NEXT = "--", "--vs"
"""Before the words of the first command, and before those of each further one."""

MOST_COMMANDS = 100
"""More are no comparison."""

_WORD = r"""(?:\$(?=[ \t]|$)|[\w./:,@%^+=-]|'[^']*'|"[^"$`\\!]*")+"""
_SIMPLE = re.compile(rf"[ \t]*{_WORD}(?:[ \t]+{_WORD})*[ \t]*")
"""A line in which a shell has nothing to do: plain words, and quotes around what is taken as it is."""
_OF_THE_SHELL = frozenset((
    ":", ".", "cd", "command", "eval", "exec", "exit", "export", "read", "set", "trap", "ulimit", "umask",
    "wait",
))  # fmt: skip
"""Commands that are no programs."""

_ASSIGNMENT = re.compile(r"([A-Za-z_]\w*)=(.*)", re.DOTALL)


@dataclass(frozen=True)
class Compared:
    """One of the commands: what it is called in tables, its words, and the line that the user wrote."""

    name: str
    words: tuple[str, ...]
    line: str
    prepare: tuple[str, ...] = ()
    conclude: tuple[str, ...] = ()
    environment: tuple[tuple[str, str], ...] = ()
    folder: Path = field(default_factory=Path.cwd)
    """Where it is run."""
    time_from: str | None = None
    """The pattern of the time that it prints."""
    levels: Levels = ()
    """The value of each list that its line has."""
    called: str = ""
    """What messages call it: as the user wrote it, or by the name that the user gave."""

    @property
    def has_shell(self) -> bool:
        """Whether a shell starts it."""
        return self.words[:2] == ("sh", "-c")


def split_off(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """The arguments before `--`, and those behind it, which belong to commands."""
    at = list(arguments).index(WORDS) if WORDS in arguments else len(arguments)
    return joined(arguments[:at]), list(arguments[at + 1 :])


@dataclass(frozen=True)
class _Written:
    """What is written for one command, and the values of the lists that it has."""

    line: str
    words: tuple[str, ...]
    """Those behind `--`, where there is no line."""
    levels: Levels
    values: Mapping[str, str]
    at: int
    """The number of the line."""


def commands_of(options: argparse.Namespace, words_behind: Sequence[str]) -> tuple[Compared, ...]:
    """The commands that the options give as lines, or that stand as words behind `--`. Raises InputError."""
    split = _split(words_behind)
    if options.lines and split:
        raise InputError(f"found commands as lines and as words behind {WORDS}, expected only one of the two")
    written = _written(options, split)
    if not 1 < len(written) <= MOST_COMMANDS:
        told = f"expected two or more to compare, {MOST_COMMANDS} at most"
        raise InputError(f"found {several(len(written), 'command')}, {told}")
    read = [(dict[str, str](), one.words) if one.words else words_of(one.line) for one in written]
    called = _names(options, written)
    names = called if options.name else names_of([words for _, words in read], called)
    prepare, conclude = (
        [_words_beside(_given(options, key, written, at)) for at in range(len(written))]
        for key in ("prepare", "conclude")
    )
    return tuple(
        Compared(
            name,
            _with_input(words, options.input, one.values),
            one.line,
            prepare[at],
            conclude[at],
            environment=_environment(options.env, one.values, name, names, of_line),
            levels=one.levels,
            time_from=options.time_from and fill(options.time_from, one.values),
            called=called[at],
        )
        for at, (one, name, (of_line, words)) in enumerate(zip(written, names, read, strict=True))
    )


def _written(options: argparse.Namespace, split: Sequence[Sequence[str]]) -> list[_Written]:
    """Each line with each combination of values that changes anything of it. Raises InputError for a value
    that nothing uses, and for a placeholder that has none.
    """
    lines = [shlex.join(words) for words in split] or options.lines
    combined = combinations([*options.list, *options.range], MOST_COMMANDS)
    of_all = [*options.env, str(options.input or ""), options.time_from or ""]
    beside = [getattr(options, key) for key in ("name", "prepare", "conclude")]
    found: dict[object, _Written] = {}
    for at, line in enumerate(lines):
        own = [one[at] if len(one) == len(lines) else " ".join(one) for one in beside]
        for values in combined:
            used = named_in([line, *own, *of_all])
            levels = tuple((name, value) for name, value in values.items() if name in used)
            of_line = ((LINE, line),) if len(lines) > 1 and values else ()
            words = tuple(fill(word, values) for word in split[at]) if split else ()
            text = shlex.join(words) if words else fill(line, values)
            key = (text, *(fill(one, values) for one in (*own, *of_all))) if values else at
            found.setdefault(key, _Written(text, words, (*of_line, *levels), dict(levels), at))
    for name, value in ((name, value) for values in combined for name, value in values.items()):
        if inner := named_in([value]) & set(combined[0]):
            told = f"found {quoted(value)} as a value of {name}, in which {{{min(inner)}}} is not filled in"
            raise InputError(f"{told}; expected values without placeholders, then the commands")
    for name in combined[0]:
        if not any(name in one.values for one in found.values()):
            others = sorted(named_in(lines) - set(combined[0]))
            lacking = f" and no values for {{{others[0]}}}" if others else ""
            raise InputError(f"found values for {name}{lacking}, expected {{{name}}} in a command")
    for one in found.values():
        for variable in options.env:
            require_filled("--env", fill(variable, one.values))
        if not split:
            require_filled(one.line, one.line)
    return list(found.values())


def _names(options: argparse.Namespace, written: Sequence[_Written]) -> list[str]:
    """What the commands are called. Raises InputError for names that are not as many, or not told apart."""
    if not options.name:
        names = [_called(one, written) for one in written]
        _require_names(names, "found")
        return names
    number = len(options.name)
    if number == len({one.at for one in written}):
        names = [fill(options.name[one.at], one.values) for one in written]
    elif number == len(written):
        names = list(options.name)
    else:
        told = f"found {number} names for {several(len(written), 'command')}, expected one for each"
        raise InputError(told)
    for name in names:
        require_filled("-n", name)
    _require_names(names, "-n: found")
    return names


def _called(one: _Written, all_of_them: Sequence[_Written]) -> str:
    """Its line, with the values of lists that others of the same line differ in."""
    if not one.values or sum(other.line == one.line for other in all_of_them) == 1:
        return one.line
    return f"{one.line} ({', '.join(f'{name} {value}' for name, value in one.values.items())})"


def _split(words: Sequence[str]) -> list[list[str]]:
    """The words of each command. Raises InputError for one that has none."""
    parts = [list(part) for is_next, part in itertools.groupby(words, NEXT.__eq__) if not is_next]
    if words and len(parts) != list(words).count(NEXT) + 1:
        raise InputError(f"found {NEXT} with no word of a command on one side, expected words on both")
    return parts


def words_of(line: str) -> tuple[dict[str, str], tuple[str, ...]]:
    """The words of a line in which a shell has nothing to do, with the variables that it sets in front; else
    those of a shell that reads it. Raises InputError for an empty one.
    """
    if not line.strip():
        raise InputError("found an empty line, expected a command")
    if not _SIMPLE.fullmatch(line):
        return {}, ("sh", "-c", line)
    words, variables = shlex.split(line), dict[str, str]()
    while words and (found := _ASSIGNMENT.fullmatch(words[0])):
        variables[found[1]] = found[2]
        del words[0]
    # What stands in quotes may be a word of a shell, such as `eval`.
    is_program = bool(words) and (
        shutil.which(words[0]) is not None or (words == line.split() and words[0] not in _OF_THE_SHELL)
    )
    return (variables, tuple(words)) if is_program else ({}, ("sh", "-c", line))


def words_in(text: str) -> list[str]:
    """All words of a line for a shell, or of a script."""
    try:
        return shlex.split(re.sub("[;|&<>()]", " ", text), comments=True)
    except ValueError:
        return text.split()


def _words_beside(line: str) -> tuple[str, ...]:
    """The words of a line that is run before or after; none of an empty one."""
    if not line:
        return ()
    variables, words = words_of(line)
    return ("sh", "-c", line) if variables else words


def names_of(commands: Sequence[Sequence[str]], lines: Sequence[str]) -> list[str]:
    """What commands are called without names: by the words in which they differ, or else by their lines."""
    as_many = len({len(words) for words in commands}) == 1
    if as_many and not any(words[:2] == ("sh", "-c") for words in commands):
        at = [k for k in range(len(commands[0])) if len({words[k] for words in commands}) > 1]
        named = [" ".join(_short(words[k]) for k in at) for words in commands]
        if len(set(named)) == len(named) and not any(map(_is_number, named)):
            return named
    return list(lines)


_SHORT_PATH = 3
"""Parts of a path that is told whole, the root among them."""


def _short(word: str) -> str:
    """The last two parts of a path."""
    parts = Path(word).parts
    if "/" not in word or word.startswith("./") or (word.startswith("/") and len(parts) <= _SHORT_PATH):
        return word.removeprefix("./")
    return os.fspath(Path(*parts[-2:]))


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _require_names(names: Sequence[str], found: str) -> None:
    for name in names:
        if not name.strip() or not name.isprintable():
            raise InputError(f"{found} {quoted(name)}, expected a name on one line: -n gives it")
        if _is_number(name):
            raise InputError(f"{found} {quoted(name)}, expected a name that is no number: -n gives it")
        if name.removesuffix(AGAIN) != name and name.removesuffix(AGAIN) in names:
            told = f"which the control is called; expected a name without{AGAIN}"
            raise InputError(f"{found} {quoted(name)}, {told}")
        if list(names).count(name) > 1:
            raise InputError(f"found {quoted(name)} twice, expected a name for each command: -n gives them")


def reference_of(asked: str | None, names: Sequence[str]) -> str:
    """What the others are compared with: the first if nothing is asked for. Raises InputError."""
    if asked is not None and asked not in names:
        raise InputError(f"--reference: found {quoted(asked)}, expected one of {', '.join(names)}")
    return asked or names[0]


def _given(options: argparse.Namespace, key: str, written: Sequence[_Written], at: int) -> str:
    """The line that is run before or after a command's runs; empty where there is none. Raises InputError for
    lines that are not as many as commands.
    """
    lines, one = getattr(options, key), written[at]
    number = len({other.at for other in written})
    if len(lines) not in (0, 1, number, len(written)):
        told = f"found {len(lines)} for {several(len(written), 'command')}, expected one, or one for each"
        raise InputError(f"--{key}: {told}")
    if not lines:
        return ""
    line = fill(lines[0 if len(lines) == 1 else one.at if len(lines) == number else at], one.values)
    require_filled(f"--{key}", line)
    return line


def _environment(
    settings: Sequence[str],
    values: Mapping[str, str],
    own: str,
    names: Sequence[str],
    of_line: dict[str, str],
) -> tuple[tuple[str, str], ...]:
    """The variables of one command, those in front of its line last."""
    found: dict[str, str] = {}
    for setting in (fill(one, values) for one in settings):
        name, colon, rest = setting.partition(":")
        is_of_one = bool(colon) and name in names
        variable = _ASSIGNMENT.fullmatch(rest if is_of_one else setting)
        if variable is None:
            is_no_name = colon and _ASSIGNMENT.fullmatch(rest)
            told = "expected VARIABLE=VALUE or NAME:VARIABLE=VALUE"
            told = f"expected one of {', '.join(names)} before the colon" if is_no_name else told
            raise InputError(f"--env: found {quoted(setting)}, {told}")
        if not is_of_one or name == own:
            found[variable[1]] = variable[2]
    return tuple(sorted({**found, **of_line}.items()))


def _with_input(words: tuple[str, ...], asked: Path | None, values: Mapping[str, str]) -> tuple[str, ...]:
    """The words, behind a shell that opens the file and becomes the command."""
    if asked is None:
        return words
    file = Path(fill(str(asked), values))
    require_filled("--input", str(file))
    if not (file.is_file() or file.is_char_device()):
        no_folder = ", no folder" if file.is_dir() else ""
        raise InputError(f"--input: found {file}, expected a file that is there{no_folder}")
    return ("sh", "-c", f'exec "$@" < {shlex.quote(str(file.absolute()))}', "sh", *words)
