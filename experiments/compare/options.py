"""What the command line of `carom compare` asks for."""

import argparse
import itertools
import re
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from experiments.compare.benchmarks import common_cases
from experiments.plan.pattern import PatternError, groups_of
from support.command_line import Parser
from support.errors import InputError, quoted

WORDS, NEXT = "--", "--vs"
"""Before the words of the first command, and before those of each further one."""

LEAST_TIMEOUT = 60.0
"""Seconds that a run may take, whatever time there is for all of them."""

_OF_A_SHELL = re.compile(r"[^\w ./:,@%^+=-]|(?:^|\s)\w+=")
"""What a shell may act upon: anything but plain words; a word with = in front is a variable to be set."""

_SECONDS_OF = {"ms": 1e-3, "s": 1.0, "m": 60.0, "min": 60.0, "h": 3600.0}


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

    @property
    def has_shell(self) -> bool:
        """Whether a shell starts it."""
        return self.words[:2] == ("sh", "-c")


@dataclass(frozen=True)
class Asked:
    """Everything that is asked for. Times are in seconds, the margin and the error are fractions."""

    commands: tuple[Compared, ...]
    reference: str
    margin: float = 0.02
    error: float = 0.05
    seconds: float = 60.0
    most_seconds: float = 300.0
    """For one run of a command; what takes longer is stopped, and has failed."""
    warm_up: int = 0
    exit_codes: tuple[int, ...] = (0,)
    time_from: str | None = None
    time_unit: str = "s"
    turns: bool | None = None
    threads: int | None = None
    fixed_layout: bool = False
    cases: tuple[str, ...] = ()
    """Of Google Benchmarks: what all of them have; empty where whole commands are run."""
    one_sided: bool = False
    """Whether all that is asked is that nothing is slower by more than the margin."""
    setup: str | None = None
    cleanup: str | None = None
    exports: dict[str, Path] = field(default_factory=dict)
    """The files to write, by format."""
    quiet: bool = False


def parse(arguments: Sequence[str]) -> Asked:
    """Read the words behind `carom compare`. Raises InputError, or leaves like any parser."""
    words, after = list(arguments), []
    if WORDS in words:
        at = words.index(WORDS)
        words, after = words[:at], words[at + 1 :]
    options = _parser().parse_args(words)
    commands = _commands(options, _split(after))
    asked = asked_of(options, commands, _reference(options.reference, [one.name for one in commands]))
    return replace(asked, cases=common_cases(commands, options.filter)) if options.gb else asked


def asked_of(options: argparse.Namespace, commands: tuple[Compared, ...], reference: str) -> Asked:
    """What the options of `add_measuring` ask for, of these commands."""
    return Asked(
        commands=commands,
        reference=reference,
        margin=options.margin,
        error=options.error,
        seconds=options.time,
        most_seconds=options.timeout or max(LEAST_TIMEOUT, 5 * options.time),
        warm_up=options.warmup,
        exit_codes=tuple(sorted({0, *options.ignore_exit})),
        time_from=options.time_from,
        time_unit=unit_of(options.time_from) if options.time_from else "s",
        turns={"on": True, "off": False, "auto": None}[options.turns],
        threads=options.threads,
        fixed_layout=options.fixed_layout,
        setup=options.setup,
        cleanup=options.cleanup,
        exports={
            kind: path
            for kind in ("json", "csv", "markdown")
            if (path := getattr(options, f"export_{kind}")) is not None
        },
        quiet=options.quiet,
    )


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="carom compare",
        usage="carom compare [OPTIONS] 'COMMAND' 'COMMAND' ...\n"
        "       carom compare [OPTIONS] -- WORDS --vs WORDS ...",
        description="Run commands in turns until it is settled which is faster, and say so with an interval.",
        epilog="Exit codes: 0 measured, whatever came out; 1 wrong usage; 2 a command failed; 5 the first "
        "command differs from itself, so that nothing is certain.",
    )
    add = parser.add_argument
    add("lines", nargs="*", metavar="COMMAND", help="a line; only one with more than plain words has a shell")
    add("-n", "--name", action="append", default=[], metavar="NAME", help="of a command, in their order")
    add("--reference", metavar="NAME", help="what the others are compared with (default: the first)")
    told = "a line run before each run, untimed; for all, or once for each command"
    add("--prepare", action="append", default=[], metavar="COMMAND", help=told)
    add("--conclude", action="append", default=[], metavar="COMMAND", help="the same after each run")
    add("--input", type=Path, metavar="FILE", help="standard input of each run (default: nothing)")
    told = "a variable for all commands, or for the one that is called NAME"
    add("--env", action="append", default=[], metavar="[NAME:]VARIABLE=VALUE", help=told)
    told = "values for {NAME} in the lines: a command for each, or for each combination"
    add("-L", "--list", action="append", nargs=2, default=[], metavar=("NAME", "A,B"), help=told)
    told = "the same for whole numbers from A to B"
    add("-P", "--range", action="append", nargs=3, default=[], metavar=("NAME", "A", "B"), help=told)
    told = "the commands are Google Benchmarks: compare their cases, paired by name"
    add("--gb", action="store_true", help=told)
    told = "the cases whose names match (default: all)"
    add("--filter", default=".", metavar="REGEX", help=told)
    add_measuring(parser)
    return parser


def add_measuring(parser: argparse.ArgumentParser) -> None:
    """The options of how to measure, whatever is compared."""
    add = parser.add_argument
    add("--margin", type=_fraction, default=0.02, metavar="2%", help="the least difference that matters")
    add("--error", type=_fraction, default=0.05, metavar="5%", help="how often any verdict may be wrong")
    add("--time", type=_duration, default=60.0, metavar="60s", help="measure so long at most")
    told = "stop a run that takes longer (default: five times --time, a minute at least)"
    add("--timeout", type=_duration, metavar="300s", help=told)
    add("--warmup", type=_count, default=0, metavar="N", help="untimed runs before each timed one")
    add("--setup", metavar="COMMAND", help="a line for a shell, run once before everything")
    add("--cleanup", metavar="COMMAND", help="the same after everything, whatever happened")
    add("--ignore-exit", type=_codes, default=(), metavar="1,2", help="exit codes that are fine beside 0")
    told = "a regular expression with one group: the time that a command prints, in the unit behind it"
    add("--time-from", type=_pattern, metavar="REGEX", help=told)
    told = "stop the others while one runs, a slice of time each; auto: unless a command minds it"
    add("--turns", choices=("auto", "on", "off"), default="auto", help=told)
    told = "OMP_NUM_THREADS and the binding of a study (default: your own environment)"
    add("--threads", type=_count, metavar="N", help=told)
    told = "leave addresses and the size of the environment as they are; else each block varies them"
    add("--fixed-layout", action="store_true", help=told)
    for kind in ("json", "csv", "markdown"):
        add(f"--export-{kind}", type=Path, metavar="FILE", help=f"write the result as {kind}, too")
    add("-q", "--quiet", action="store_true", help="print the result alone")


def _commands(options: argparse.Namespace, split: Sequence[Sequence[str]]) -> tuple[Compared, ...]:
    if options.lines and split:
        raise InputError(f"found lines and words behind {WORDS}, expected either")
    swept = _combinations(options)
    if split:
        texts = [(shlex.join(words), tuple(words)) for words in split]
    else:
        texts = [(line, words_of(line)) for line in _filled(options.lines, swept)]
    if len(texts) < 2:
        raise InputError(f"found {_commands_said(len(texts))}, expected two or more to compare")
    names = options.name or names_of([words for _, words in texts], [line for line, _ in texts])
    if len(names) != len(texts):
        raise InputError(f"found {len(names)} names for {_commands_said(len(texts))}, expected one for each")
    _require_names(names)
    before, after = (_beside(options, key, len(texts)) for key in ("prepare", "conclude"))
    own = _environments(options.env, names)
    return tuple(
        Compared(name, _with_input(words, options.input), line, before[at], after[at], own[name])
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
        if list(names).count(name) > 1:
            raise InputError(f"found {quoted(name)} twice, expected a name for each command: -n gives them")


def _reference(asked: str | None, names: Sequence[str]) -> str:
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


def _combinations(options: argparse.Namespace) -> list[dict[str, str]]:
    """The values of each combination of the lists."""
    values: dict[str, list[str]] = {}
    for name, text in options.list:
        values[name] = text.split(",")
    for name, first, last in options.range:
        try:
            values[name] = [str(one) for one in range(int(first), int(last) + 1)]
        except ValueError as error:
            raise InputError(
                f"-P: found {name} {first} {last}, expected a name and two whole numbers"
            ) from error
        if not values[name]:
            raise InputError(f"-P: found {name} from {first} to {last}, expected numbers that rise")
    return [dict(zip(values, one, strict=True)) for one in itertools.product(*values.values())]


def _filled(lines: Sequence[str], combinations: Sequence[dict[str, str]]) -> list[str]:
    """Each line with each combination of values. Raises InputError for a value that no line uses."""
    for name in combinations[0]:
        if not any(f"{{{name}}}" in line for line in lines):
            raise InputError(f"found values for {name}, expected {{{name}}} in a command")
    filled = []
    for line in lines:
        for values in combinations:
            text = line
            for name, value in values.items():
                text = text.replace(f"{{{name}}}", value)
            filled.append(text)
    return list(dict.fromkeys(filled)) if combinations[0] else filled


def _commands_said(number: int) -> str:
    return f"{number} command{'' if number == 1 else 's'}"


def unit_of(pattern: str) -> str:
    """The unit that stands behind the group of a pattern; seconds where none does."""
    behind = re.search(r"\)\s*(?:\\s\S?)?\s*(ns|us|ms|s)\b", pattern)
    return behind[1] if behind else "s"


def _pattern(text: str) -> str:
    try:
        groups = groups_of(text)
    except PatternError as error:
        raise argparse.ArgumentTypeError(
            f"found {quoted(text)}, expected a regular expression that is allowed: {error}"
        ) from error
    if groups != 1:
        raise argparse.ArgumentTypeError(
            f"found {quoted(text)} with {groups} groups, expected one around the number"
        )
    return text


def _typed(convert: Callable[[str], float], expected: str, text: str) -> float:
    try:
        return convert(text)
    except (ValueError, KeyError) as error:
        raise argparse.ArgumentTypeError(f"found {text}, expected {expected}") from error


def _fraction(text: str) -> float:
    def convert(value: str) -> float:
        number = float(value.removesuffix("%")) / (100 if value.endswith("%") else 1)
        if not 0 < number < 0.5:
            raise ValueError
        return number

    return _typed(convert, "a share such as 2% or 0.02, above 0 and below 50%", text)


def _duration(text: str) -> float:
    def convert(value: str) -> float:
        parts = re.fullmatch(r"([0-9.]+)\s*(ms|s|min|m|h)?", value)
        if parts is None or not 0 < float(parts[1]) < 1e6:
            raise ValueError
        return float(parts[1]) * _SECONDS_OF[parts[2] or "s"]

    return _typed(convert, "a time such as 60s or 5min", text)


def _count(text: str) -> int:
    if not (text.isascii() and text.isdigit()) or len(text) > 6:
        raise argparse.ArgumentTypeError(f"found {text}, expected a whole number")
    return int(text)


def _codes(text: str) -> tuple[int, ...]:
    if not re.fullmatch(r"\d{1,3}(,\d{1,3})*", text) or any(int(one) > 255 for one in text.split(",")):
        raise argparse.ArgumentTypeError(f"found {text}, expected exit codes between commas, 0 to 255")
    return tuple(int(one) for one in text.split(","))
