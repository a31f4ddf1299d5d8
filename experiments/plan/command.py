"""Somebody else's program at one point: its words filled in, and the files that it is made of."""

import os
import string
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from experiments.plan.benchmark_cases import filter_of
from experiments.plan.executable import UnfitError, found, program_of, require_executable
from experiments.plan.program import Program
from experiments.plan.series import SECONDS_OF_UNIT, Series
from experiments.support.digest import digest
from support.errors import InputError, nearest

SCENE, OUTPUT, FOLDER = "scene", "out", "folder"
"""Placeholders of files that are known only when the program is run, and of the question's folder."""

_LITERAL = "\0"
"""Behind a brace of the user's own: no word of a command can have it."""
_LONGEST_NAME = 60


@dataclass(frozen=True)
class Command:
    """What is run and how its time is known; every field decides what is measured.

    In all words only {scene} and {out} are left to be filled in. `instrument` is the SHA-256 of the program
    that takes the time: what another one measured is not compared.
    """

    words: tuple[str, ...]
    folder: Path
    instrument: str
    trajectory: tuple[str, ...] = ()
    pattern: str | None = None
    unit_seconds: float | None = 1.0
    benchmark: str | None = None
    prepare: tuple[str, ...] = ()
    conclude: tuple[str, ...] = ()
    fresh_folder: bool = False
    exit_codes: tuple[int, ...] = ()
    turns: bool | None = None
    rounds: int | None = None
    """How often it runs in a block, each time by itself; without a number once, or in turns."""
    refused: str = ""
    """Why it is not run at all."""
    checker: Program | None = None
    """What writes the trajectory."""
    another: str = ""
    """What that is called where it is not the program that is timed."""

    @property
    def times_itself(self) -> bool:
        """Whether the time that counts is one that the program says: it must not stand still meanwhile."""
        return self.pattern is not None or self.benchmark is not None

    @property
    def writes_trajectory(self) -> bool:
        """Whether what is timed writes its own trajectory."""
        return any("{out}" in word for word in self.words)

    @property
    def content(self) -> dict[str, object]:
        """What of it is part of an id: not where it is."""
        return {name: value for name, value in vars(self).items() if name not in _NO_CONTENT}


_NO_CONTENT = frozenset(("folder", "refused", "checker", "another"))


@dataclass(frozen=True)
class Place:
    """Where commands are run, what takes their time, and the files that any of them writes: as their words
    name them, None if each may write what it names.
    """

    folder: Path
    instrument: str
    writes: tuple[str, ...] | None = ()


def command_of(
    series: Series, key: str, values: tuple[Mapping[str, object], Mapping[str, object]], place: Place
) -> tuple[Command, Program]:
    """The series' command with values filled in, those of the run and those of its check, and the program
    that it runs.

    Raises InputError, which begins with `key`, for a placeholder that is none of the values, and for a
    program that is not there or cannot be run; one of many is then a point that fails.
    """
    if series.refused:
        return _refused(series.name, series.refused, place)
    of_run, of_check = (_known(one, place) for one in values)
    if series.trajectory and SCENE not in values[1]:
        raise InputError(f"{key}.trajectory: found without a scene, expected a table scene beside it")
    words, prepare, conclude, trajectory = (
        _filled(getattr(series, name), f"{key}.{name}", of_check if name == "trajectory" else of_run)
        for name in ("command", "prepare", "conclude", "trajectory")
    )
    name = None
    if series.benchmark is not None:
        [name] = placed(_filled((str(series.benchmark.name),), f"{key}.benchmark.name", of_run))
        words = (*words, literal(filter_of(name)))
    command = Command(
        words, place.folder, place.instrument, trajectory, series.time.stdout if series.time else None,
        SECONDS_OF_UNIT.get(series.time.unit or "") if series.time else 1.0, name, prepare, conclude,
        series.fresh_folder, series.exit_codes, series.turns,
    )  # fmt: skip
    if trajectory and command.writes_trajectory:
        raise InputError(f"{key}.trajectory: found beside {{out}} in command, expected only one of the two")
    writes = place.writes and placed(_filled(place.writes, f"{key}.writes", of_run))
    try:
        return resolved(command, replace(place, writes=writes))
    except (UnfitError, InputError) as error:
        unfit = error if isinstance(error, UnfitError) else None
        if series.is_one_of_many:
            return _refused(series.name, f"{unfit.word}: {unfit}" if unfit else str(error), place)
        raise InputError(f"{key}.{unfit.part}: {unfit.told}" if unfit else str(error)) from error


def resolved(command: Command, place: Place) -> tuple[Command, Program]:
    """The command with its first words found, and the program that it runs. Raises UnfitError for a word that
    names none, and InputError.
    """
    parts: dict[str, Any] = {}
    for name in ("words", "prepare", "conclude", "trajectory"):
        if not (words := getattr(command, name)):
            continue
        [first] = placed(words[:1])
        try:
            require_executable(first, place.folder)
        except UnfitError as unfit:
            unfit.word, unfit.part = first, "command" if name == "words" else name
            raise
        parts[name] = (literal(os.fspath(found(first, place.folder))), *words[1:])
    made_of = {name: placed(words) for name, words in parts.items()}
    trajectory, folder = made_of.pop("trajectory", ()), None if command.fresh_folder else place.folder
    writes = None if place.writes is None else {place.folder / word for word in place.writes}
    program = program_of([*made_of.values()], place.folder, folder, writes)
    if trajectory:
        parts["checker"] = program_of([trajectory], place.folder, folder, writes)
        parts["another"] = _another(placed(command.words), trajectory, place.folder)
    return replace(command, **parts), program


def _refused(name: str, reason: str, place: Place) -> tuple[Command, Program]:
    """What stands for a program that is not run: a point of its own, which fails."""
    command = Command((name,), place.folder, place.instrument, refused=reason)
    return command, Program(name, place.folder, digest(reason))


def _another(words: Sequence[str], trajectory: Sequence[str], folder: Path) -> str:
    """What the command of a trajectory is called where it is not the timed program; else nothing."""
    timed, other = (_lead(one, folder) for one in (words, trajectory))
    if timed == other:
        return ""
    return " ".join((Path(other[0]).name, *other[1:]))[:_LONGEST_NAME]


def _lead(words: Sequence[str], folder: Path) -> tuple[str, ...]:
    """The words that say what is run: the program, and behind one that is not the user's own, which may be
    an interpreter, what it is to run.
    """
    program = found(words[0], folder)
    if program.is_relative_to(folder):
        return (os.fspath(program),)
    first = next((at for at, word in enumerate(words) if at and not word.startswith("-")), len(words) - 1)
    return (os.fspath(program), *words[1 : first + 1])


def placed(words: Sequence[str], scene: Path | None = None, output: Path | None = None) -> tuple[str, ...]:
    """The words with the files in their places."""
    files = {"{scene}": scene, "{out}": output}
    for name, path in files.items():
        words = [word if path is None else word.replace(name, literal(os.fspath(path))) for word in words]
    return tuple(word.replace(_LITERAL, "") for word in words)


def literal(text: str) -> str:
    """The text, as one in which no placeholder is left to be filled in."""
    for name in (SCENE, OUTPUT):
        text = text.replace(f"{{{name}}}", f"{{{_LITERAL}{name}}}")
    return text


def _known(values: Mapping[str, object], place: Place) -> dict[str, str]:
    """Placeholders with their values; those of files come later."""
    told = ((name, f"{one:.12g}" if isinstance(one, float) else str(one)) for name, one in values.items())
    files = {name: f"{{{name}}}" for name in (SCENE, OUTPUT) if SCENE in values}
    return {name: one for name, one in told if name != SCENE} | files | {FOLDER: os.fspath(place.folder)}


def _filled(words: Sequence[str], key: str, known: Mapping[str, str]) -> tuple[str, ...]:
    """The words with the placeholders in the place of their values, but for those of files, of which only
    these are left.
    """
    return tuple(_filled_word(word, key, known) for word in words)


def _filled_word(word: str, key: str, known: Mapping[str, str]) -> str:
    try:
        parts = list(string.Formatter().parse(word))
    except ValueError as error:
        raise InputError(f'{key}: found "{word}": {error}; {{{{ stands for a brace') from error
    filled, text = "", ""  # up to the last file, and since
    for plain, name, form, conversion in parts:
        text += plain
        if name is None:
            continue
        if name not in known or form or conversion:
            expected = f"one of {', '.join(f'{{{one}}}' for one in known)}{nearest(name, known)}"
            raise InputError(f'{key}: found "{{{name}}}", expected {expected}')
        if name in (SCENE, OUTPUT):
            filled, text = filled + literal(text) + known[name], ""
        else:
            text += known[name]
    return filled + literal(text)
