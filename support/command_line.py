"""What the command lines of both packages have in common: one line for a mistake, and exit codes."""

import argparse
import contextlib
import io
import math
import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NoReturn, TextIO

from support.errors import InputError, Interrupted, cannot

_RESULT = "standard output"


class Parser(argparse.ArgumentParser):
    """Wrong usage is one line and exit code 1, as for every other bad input."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong and leave."""
        tell(f"carom: {message} (see `{self.prog} --help`)")
        raise SystemExit(1)

    def print_help(self, file: Any = None) -> None:  # noqa: ANN401 - as its base has it
        """Print the help. Raises what `print_lines` does."""
        print_lines([self.format_help().removesuffix("\n")], file or sys.stdout)


class Once(argparse.Action):
    """Stores a value, and takes no second one: the first would be dropped without a word."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: object,
        option: str | None = None,
    ) -> None:
        """Raises like the parser for a second value."""
        given = vars(namespace).setdefault("given", set())
        if option is not None and self.dest in given:
            parser.error(f"found {option} twice, expected it once")
        given.add(self.dest)
        setattr(namespace, self.dest, values)


def number_above_zero(text: str, unit: str) -> float:
    """The number of a word that says how many units. Raises what the parser makes a line of."""
    with contextlib.suppress(ValueError):
        if 0 < (number := float(text)) < math.inf:
            return number
    raise argparse.ArgumentTypeError(f"found {text}, expected a number of {unit} above 0")


def print_anything() -> None:
    """Tell what a locale has no letters for in another way; what a closed stream has no place for, nobody."""
    if sys.stderr is None:
        sys.stderr = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - for good
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def tell(text: str) -> None:
    """One line on standard error. Where that is full, or its reader is gone, nobody is told."""
    try:
        # A line that tells how far it is may stand there.
        print(f"\r\x1b[K{text}" if can_draw() else text, file=sys.stderr, flush=True)
    except OSError:
        _forget(sys.stderr)


def can_draw() -> bool:
    """Whether standard error is a terminal on which a line can be drawn anew."""
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    return is_terminal and os.environ.get("TERM", "dumb") not in ("dumb", "")


def print_lines(lines: Iterable[str], stream: TextIO | None) -> None:
    """Print them. Raises InputError for a closed stream, and OSError that says that it was not a file."""
    if stream is None:
        raise InputError("standard output: is closed, expected a place for the result")
    try:
        print(*lines, sep="\n", file=stream, flush=True)
    except BrokenPipeError as error:
        _forget(stream)
        raise InputError("standard output: its reader is gone, expected a place for the result") from error
    except OSError as error:
        _forget(stream)
        raise OSError(error.errno, error.strerror, _RESULT) from error


def _forget(stream: TextIO) -> None:
    """Let what is still to be written go nowhere: Python would complain once more at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def exit_code_of(verb: Callable[[], int], kept: str = "") -> int:
    """Run a verb; return its exit code, 1 for what a user is to mend, told in one line, and 128 and the
    number of a signal that stopped it. `kept` says what becomes of what is finished then.
    """
    try:
        code = verb()
        if sys.stdout is not None:
            sys.stdout.flush()  # here, so that what cannot be written is told below
        return code
    except InputError as error:
        tell(f"carom: {error}")
        return 1
    except BrokenPipeError:
        _forget(sys.stdout)  # whoever read the output, say `head`, has seen enough
        return 1
    except OSError as error:
        # The disk is full, or a folder cannot be written: nothing that is finished suffers from it.
        tell(f"carom: {cannot(error)}{f'; {kept}' if kept and error.filename != _RESULT else ''}")
        return 1
    except Interrupted as stopped:
        tell(f"\nstopped: {kept}")
        return 128 + stopped.signal_number
