"""Google Benchmarks: whether commands run some, and the cases that they have in common."""

import mmap
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from experiments.compare.commands import Compared, words_in
from experiments.plan.benchmark_cases import cases
from experiments.plan.executable import UnfitError, found, require_executable
from experiments.run.progress import about, several, warn
from support.errors import InputError

if TYPE_CHECKING:
    from experiments.compare.options import Asked

_PROGRAM = b"\x7fELF"
_MARKS = (b"benchmark_list_tests", b"libbenchmark.so")
"""What stands in a program that has the library in it, or that loads it."""

_WRAPPERS = frozenset((
    "env", "taskset", "numactl", "nice", "ionice", "chrt", "stdbuf", "setarch", "nohup", "prlimit", "sudo",
    "time", "timeout",
))  # fmt: skip
"""Programs that become the one among their words, or start it alone."""
_BEHIND_INPUT = 4
"""The place of a command's first word behind a shell that opens its input (commands.py)."""
_ELSEWHERE = ("--benchmark_list_tests", "--help", "--version")
"""Words with which a Google Benchmark measures nothing."""
_TIME, _FILTER, _OUT = "--benchmark_min_time", "--benchmark_filter=", "--benchmark_out="
_VARIABLE = "BENCHMARK_FILTER="

_BLOCKS, _SHORTEST, _LONGEST = 14, 0.01, 0.1
"""So many blocks are to find room, if a case has so many seconds each time, at least and at most."""


@dataclass(frozen=True)
class Call:
    """A Google Benchmark among the words of a command, at a place; what is before it starts it."""

    words: tuple[str, ...]
    at: int

    @property
    def arguments(self) -> tuple[str, ...]:
        """What stands behind it."""
        return self.words[self.at + 1 :]

    @property
    def filter(self) -> str | None:
        """The one that its own arguments have, or the library's variable, as `env` may set it before it."""
        given = [one.removeprefix(_FILTER) for one in self.arguments if one.startswith(_FILTER)]
        around = [one.removeprefix(_VARIABLE) for one in self.words[: self.at] if one.startswith(_VARIABLE)]
        return next(iter((given or around)[-1:]), None)


def call_of(command: Compared) -> Call | None:
    """The Google Benchmark that a command runs with arguments of its own, alone or behind a program that
    becomes it, as `taskset` does. None of them is run to find out.
    """
    words = command.words
    if "-S" in words[1:-1] and os.path.basename(words[0]) == "env":  # noqa: PTH119 - a word
        split = words.index("-S")
        words = (*words[:split], *words_in(words[split + 1]), *words[split + 2 :])
    at = _BEHIND_INPUT if words[:2] == ("sh", "-c") and len(words) > _BEHIND_INPUT else 0
    if os.path.basename(words[at]) in _WRAPPERS:  # noqa: PTH119 - a word
        at = next((k for k, word in enumerate(words) if _is_benchmark(word, command.folder)), 0)
    call = Call(words, at)
    is_run = _is_benchmark(words[at], command.folder) and not set(call.arguments).intersection(_ELSEWHERE)
    return call if is_run and not any(one.startswith(_ELSEWHERE[0]) for one in call.arguments) else None


def _is_benchmark(word: str, folder: Path) -> bool:
    """Whether it is one. Carom itself loads the library, too, and is none."""
    program = found(word, folder)
    return not program.resolve().name.startswith("carom") and _has_library(program)


def _has_library(program: Path) -> bool:
    try:
        with program.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
            return content[: len(_PROGRAM)] == _PROGRAM and any(content.find(mark) >= 0 for mark in _MARKS)
    except (OSError, ValueError):
        return False  # it is not there, or is empty


def common_cases(commands: Sequence[Compared], pattern: str | None) -> tuple[str, ...]:
    """The names of the cases that match and that all have, in their order; what only some have is said.

    Raises InputError for a program that lists none, and where there is none in common.
    """
    listed = [_listed(one, pattern) for one in commands]
    common = [name for name in listed[0] if all(name in names for names in listed)]
    for command, names in zip(commands, listed, strict=True):
        alone = [name for name in names if name not in common]
        if alone:
            warn(f"carom: not compared, since not all have it: {', '.join(alone)} of {command.called}")
    if not common:
        raise InputError("--gb: found no case that all commands have, expected one at least")
    return tuple(common)


def _listed(command: Compared, pattern: str | None) -> list[str]:
    call, first = call_of(command), command.words[0]
    try:
        require_executable(first, command.folder)
    except UnfitError as unfit:
        raise InputError(f'{command.called}: found "{first}", which {unfit}') from unfit
    if command.has_shell and call is None:
        told = f"{command.called}: is a line for a shell, which hands no arguments on to a Google Benchmark"
        raise InputError(f"{told}; expected the program with its arguments alone, or --no-gb")
    around = {**os.environ, **dict(command.environment)}
    own = (call and call.filter) or around.get(_VARIABLE.rstrip("="))
    if written := [one for one in command.words if one.startswith(_OUT)]:
        told = f"{command.called}: found {written[0]}, which every call of it would write anew"
        raise InputError(f"{told}; expected none: --export-json keeps all times")
    if pattern and own:
        told = f"--filter: found {pattern} beside {_FILTER}{own} of {command.called}"
        raise InputError(f"{told}, expected one of the two")
    words = (os.fspath(found(first, command.folder)), *command.words[1:])
    try:
        return cases(words, pattern or own or ".", command.called, command.folder, around)
    except InputError as error:
        raise InputError(
            str(error).replace(
                f"{command.called}.filter: ",
                f"{command.called}: {'--filter' if pattern else _FILTER.rstrip('=')}: ",
            )
        ) from error


def quick(asked: "Asked", number: int) -> tuple[Compared, ...]:
    """The commands of so many cases, each of which has as long a time as leaves room for many blocks, where
    its own words do not say how long; says where they leave room for none.
    """
    calls = number * (len(asked.commands) + 1)
    own = f"{_TIME}={min(_LONGEST, max(_SHORTEST, asked.seconds / (_BLOCKS * calls))):.3g}"
    quicker = tuple(
        one if any(word.startswith(_TIME) for word in one.words) else replace(one, words=(*one.words, own))
        for one in asked.commands
    )
    longest = max(_seconds(one) for one in quicker)
    if (takes := calls * (_LONGER * longest + _START)) > asked.seconds:
        block = f"one block of {several(number, 'case')} takes {about(takes)}"
        warn(f"carom: {block}: --time and {_TIME} say how long")
    return quicker


def _seconds(command: Compared) -> float:
    """What a case is to take, by the words of its command; 0 where they say another thing."""
    given = [word.partition("=")[2].removesuffix("s") for word in command.words if word.startswith(_TIME)]
    try:
        return float(given[-1])
    except (ValueError, IndexError):
        return 0.0


_LONGER, _START = 1.5, 0.03
"""How much longer a case takes, since it seeks a number of iterations first; seconds to start its program."""
