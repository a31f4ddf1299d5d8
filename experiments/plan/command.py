"""Somebody else's program at one point: its words filled in, and the files that it is made of."""

import os
import string
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from experiments.plan.benchmark_cases import filter_of
from experiments.plan.executable import UnfitError, found, program_of, require_executable
from experiments.plan.program import Program
from experiments.plan.series import Manner, Series, literal
from experiments.support.digest import digest
from support.errors import InputError, not_one_of

SCENE, OUTPUT, FOLDER = "scene", "out", "folder"
"""Placeholders of files that are known only when the program is run, and of the question's folder."""

_LONGEST_NAME = 60


@dataclass(frozen=True)
class Command(Manner):
    """What is run and how its time is known; every field decides what is measured.

    Its words are templates, as `placed` takes them: only {scene} and {out} are left to be filled in.
    `instrument` is the SHA-256 of the program that takes the time: what another one measured is not compared.
    """

    words: tuple[str, ...]
    folder: Path
    instrument: str
    trajectory: tuple[str, ...] = ()
    refused: str = ""
    """Why it is not run at all."""
    checker: Program | None = None
    """What writes the trajectory."""
    another: str = ""
    """What that is called where it is not the program that is timed."""

    @property
    def writes_trajectory(self) -> bool:
        """Whether what is timed writes its own trajectory."""
        return placed(self.words) != placed(self.words, output=Path())

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
    manner = series.manner | {"prepare": prepare, "conclude": conclude}
    if series.benchmark is not None:
        [manner["benchmark"]] = placed(_filled((series.benchmark,), f"{key}.benchmark.name", of_run))
        words = (*words, literal(filter_of(manner["benchmark"])))
    command = Command(words, place.folder, place.instrument, trajectory, **manner)
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
    """The words of templates, with the files in their places; a file that is not known keeps its name."""
    files = {SCENE: scene or f"{{{SCENE}}}", OUTPUT: output or f"{{{OUTPUT}}}"}
    return tuple(word.format_map(files) for word in words)


def _known(values: Mapping[str, object], place: Place) -> dict[str, str]:
    """Placeholders with their values, as templates have them; those of files come later."""
    told = ((name, f"{one:.12g}" if isinstance(one, float) else str(one)) for name, one in values.items())
    files = {name: f"{{{name}}}" for name in (SCENE, OUTPUT) if SCENE in values}
    known = {name: literal(one) for name, one in told if name != SCENE}
    return known | files | {FOLDER: literal(os.fspath(place.folder))}


def _filled(words: Sequence[str], key: str, known: Mapping[str, str]) -> tuple[str, ...]:
    """Templates with the values in the place of the placeholders, but for those of files."""
    return tuple("".join(_parts(word, key, known)) for word in words)


def _parts(word: str, key: str, known: Mapping[str, str]) -> Iterator[str]:
    try:
        for text, name, form, conversion in string.Formatter().parse(word):
            yield literal(text)
            if name is not None and (name not in known or form or conversion):
                raise InputError(f"{key}: {not_one_of(f'{{{name}}}', [f'{{{one}}}' for one in known])}")
            yield known[name] if name is not None else ""
    except ValueError as error:
        raise InputError(f'{key}: found "{word}": {error}; {{{{ stands for a brace') from error
