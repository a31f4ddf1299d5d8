"""Google Benchmarks: whether programs are some, and the cases that they have in common."""

import mmap
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from experiments.plan.benchmark_cases import cases
from experiments.plan.executable import UnfitError, found, require_executable
from experiments.run.progress import warn
from support.errors import InputError


class Named(Protocol):
    """A command, as far as it matters here."""

    @property
    def name(self) -> str:
        """What it is called."""

    @property
    def words(self) -> tuple[str, ...]:
        """Its words, the program first."""

    @property
    def folder(self) -> Path:
        """Where it is run."""


_PROGRAM = b"\x7fELF"
_MARKS = (b"benchmark_list_tests", b"libbenchmark.so")
"""What stands in a program that has the library in it, or that loads it."""


def are_benchmarks(commands: Sequence[Named]) -> bool:
    """Whether all commands are programs alone, without arguments, that have Google Benchmark in them. None of
    them is run to find out.
    """
    return all(len(one.words) == 1 and _has_library(found(one.words[0], one.folder)) for one in commands)


def _has_library(program: Path) -> bool:
    try:
        with program.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
            return content[: len(_PROGRAM)] == _PROGRAM and any(content.find(mark) >= 0 for mark in _MARKS)
    except (OSError, ValueError):
        return False  # it is not there, or is empty


def common_cases(commands: Sequence[Named], pattern: str) -> tuple[str, ...]:
    """The names of the cases that match and that all have, in their order; what only some have is said.

    Raises InputError for a program that lists none, and where there is none in common.
    """
    listed = {one.name: _listed(one, pattern) for one in commands}
    common = [name for name in listed[commands[0].name] if all(name in names for names in listed.values())]
    for command, names in listed.items():
        alone = [name for name in names if name not in common]
        if alone:
            warn(f"carom: not compared, since not all have it: {', '.join(alone)} of {command}")
    if not common:
        raise InputError("--gb: found no case that all commands have, expected one at least")
    return tuple(common)


def _listed(command: Named, pattern: str) -> list[str]:
    if len(command.words) > 1:
        raise InputError(
            f"{command.name}: found words behind {command.words[0]}, expected a program alone: --gb"
        )
    program = found(command.words[0], command.folder)
    try:
        require_executable(command.words[0], command.folder)
    except UnfitError as unfit:
        raise InputError(f'{command.name}: found "{command.words[0]}", which {unfit}') from unfit
    return cases(program, pattern, f"--gb: {command.name}")
