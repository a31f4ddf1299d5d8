"""What the command line of `carom compare` asks for."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from experiments.compare import values
from experiments.compare.benchmarks import are_benchmarks, common_cases
from experiments.compare.commands import Compared, commands_of, reference_of, split_off
from experiments.run.progress import warn
from support.command_line import Parser
from support.errors import InputError

EXPORTS = ("json", "csv", "markdown", "html")
"""The formats of files."""

LEAST_TIMEOUT = 60.0
"""Seconds that a run may take, whatever time there is for all of them."""


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
    slice_seconds: float | None = None
    """How long one runs before the next does; the program's own rule without it."""
    in_a_row: int = 1
    """Runs of each command that count as one."""
    threads: int | None = None
    fixed_layout: bool = False
    cases: tuple[str, ...] = ()
    """Of Google Benchmarks: what all of them have; empty where whole commands are run."""
    one_sided: bool = False
    """Whether all that is asked is that nothing is slower by more than the margin."""
    many: int = 1
    """Of so many calls together a slower one may be called slower wrongly in no more than the error."""
    setup: str | None = None
    cleanup: str | None = None
    exports: dict[str, Path] = field(default_factory=dict)
    """The files to write, by format."""
    earlier: Path | None = None
    """A file of what earlier calls measured, which is gone on with."""
    quiet: bool = False


def parse(arguments: Sequence[str]) -> Asked:
    """Read the words behind `carom compare`. Raises InputError, or leaves like any parser."""
    own, words = split_off(arguments)
    options = _parser().parse_args(own)
    commands = commands_of(options, words)
    asked = asked_of(options, commands, reference_of(options.reference, [one.name for one in commands]))
    return replace(asked, cases=cases_of(options, commands), earlier=options.append)


def cases_of(options: argparse.Namespace, commands: Sequence[Compared]) -> tuple[str, ...]:
    """The cases to compare, if the commands are Google Benchmarks, and nobody says that they are none.
    Raises InputError.
    """
    is_asked = options.gb is True or options.filter is not None
    if options.gb is None and not is_asked and not options.time_from and are_benchmarks(commands):
        warn("carom: these are Google Benchmarks: their cases are compared (`--no-gb`: whole programs)")
        is_asked = True
    return common_cases(commands, options.filter or ".") if is_asked else ()


def asked_of(options: argparse.Namespace, commands: tuple[Compared, ...], reference: str) -> Asked:
    """What the options of `add_measuring` ask for, of these commands. Raises InputError for two that exclude
    each other.
    """
    turns, slice_seconds = options.turns
    if options.time_from and turns:
        told = "of commands that time themselves, which would count their pauses"
        raise InputError(f"--turns: found turns, {told}; expected off or auto")
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
        time_unit=values.unit_of(options.time_from) if options.time_from else "s",
        turns=turns,
        slice_seconds=slice_seconds,
        threads=options.threads,
        fixed_layout=options.fixed_layout,
        setup=options.setup,
        cleanup=options.cleanup,
        exports={kind: path for kind in EXPORTS if (path := getattr(options, f"export_{kind}")) is not None},
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
    add(
        "lines",
        nargs="*",
        metavar="COMMAND",
        help="a command line; a shell runs it only if it has more than plain words",
    )
    add(
        "-n",
        "--name",
        action="append",
        default=[],
        metavar="NAME",
        help="name of a command; given once for each, in their order",
    )
    add("--reference", metavar="NAME", help="what the others are compared with (default: the first)")
    told = "a command line that runs before each run, untimed; given once for all commands, or once for each"
    add("--prepare", action="append", default=[], metavar="COMMAND", help=told)
    add("--conclude", action="append", default=[], metavar="COMMAND", help="the same after each run")
    add("--input", type=Path, metavar="FILE", help="standard input of each run (default: nothing)")
    told = "a variable for all commands, or for the one that is called NAME"
    add("--env", action="append", default=[], metavar="[NAME:]VARIABLE=VALUE", help=told)
    told = "values for {NAME} in the lines: a command for each, or for each combination"
    add("-L", "--list", action="append", nargs=2, default=[], metavar=("NAME", "A,B"), help=told)
    told = "the same for whole numbers from A to B"
    add("-P", "--range", action="append", nargs=3, default=[], metavar=("NAME", "A", "B"), help=told)
    told = "go on with what earlier calls measured, and keep all in this file"
    add("--append", type=Path, metavar="FILE", help=told)
    add_measuring(parser)
    return parser


def add_measuring(parser: argparse.ArgumentParser) -> None:
    """The options of how to measure, whatever is compared."""
    add = parser.add_argument
    add(
        "--margin", type=values.fraction, default=0.02, metavar="2%", help="the least difference that matters"
    )
    add(
        "--error", type=values.fraction, default=0.05, metavar="5%", help="how often any verdict may be wrong"
    )
    add("--time", type=values.duration, default=60.0, metavar="60s", help="the longest time to measure")
    told = "stop a run that takes longer (default: five times --time, a minute at least)"
    add("--timeout", type=values.duration, metavar="300s", help=told)
    add("--warmup", type=values.count, default=0, metavar="N", help="untimed runs before each timed one")
    add("--setup", metavar="COMMAND", help="a command line for a shell that runs once, before everything")
    add("--cleanup", metavar="COMMAND", help="the same after everything, whatever happened")
    add(
        "--ignore-exit",
        type=values.codes,
        default=(),
        metavar="1,2",
        help="exit codes that are fine beside 0",
    )
    told = "a regular expression with one group: the time that a command prints, in the unit behind it"
    add("--time-from", type=values.pattern, metavar="REGEX", help=told)
    told = "the commands are Google Benchmarks, whose cases are paired by name (default: it is found out)"
    add("--gb", action=argparse.BooleanOptionalAction, help=told)
    add("--filter", metavar="REGEX", help="the cases whose names match (default: all)")
    told = (
        "length of a turn: one command runs, the others are stopped; off: nothing is stopped; auto: nothing "
        "that a stop makes slower or ends in another way"
    )
    add("--turns", type=values.turns, default=(None, None), metavar="auto|50ms|off", help=told)
    told = "OMP_NUM_THREADS and the binding of a study (default: your own environment)"
    add("--threads", type=values.positive, metavar="N", help=told)
    told = "leave addresses and the size of the environment as they are; else each block varies them"
    add("--fixed-layout", action="store_true", help=told)
    for kind in EXPORTS:
        also = ("--html",) if kind == "html" else ()
        add(f"--export-{kind}", *also, type=Path, metavar="FILE", help=f"also write the result as {kind}")
    add("-q", "--quiet", action="store_true", help="print the result alone")
