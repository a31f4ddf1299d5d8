"""Somebody else's program at one point: its words filled in, and the files that it is made of."""

import os
import shutil
import string
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.program import Program
from experiments.plan.scenes import sha256_of
from experiments.plan.series import SECONDS_OF_UNIT, Series
from experiments.support.digest import digest_of_hashes
from experiments.support.errors import InputError, nearest

SCENE, OUTPUT = "scene", "out"
"""Placeholders of files that are known only when the program is run."""

_SCRIPT = b"#!"
_LONGEST_FIRST_LINE = 4096


@dataclass(frozen=True)
class Command:
    """What is run and how its time is known; every field decides what is measured.

    In `words` and `trajectory` only {scene} and {out} are left to be filled in. `instrument` is the SHA-256
    of the program that takes the time: what another one measured is not compared.
    """

    words: tuple[str, ...]
    folder: Path
    instrument: str
    trajectory: tuple[str, ...] = ()
    pattern: str | None = None
    unit_seconds: float = 1.0
    benchmark: str | None = None

    @property
    def times_itself(self) -> bool:
        """Whether the time that counts is one that the program says: it must not stand still meanwhile."""
        return self.pattern is not None or self.benchmark is not None


def command_of(
    series: Series,
    key: str,
    folder: Path,
    values: tuple[Mapping[str, object], Mapping[str, object]],
    instrument: str,
) -> tuple[Command, Program]:
    """The series' command with values filled in, those of the run and those of its check, and the program
    that it runs.

    Raises InputError, which begins with `key`, for a placeholder that is none of the values, and for a
    program that is not there or cannot be run.
    """
    known, checked = (
        {name: "{scene}" if name == SCENE else _text(value) for name, value in one.items()} for one in values
    )
    words = _filled(series.command, f"{key}.command", known)
    if not series.is_one_of_many:
        _require_executable(words[0], f"{key}.command", folder)
    program = _program(words, folder)
    trajectory = _filled(series.trajectory, f"{key}.trajectory", {**checked, OUTPUT: "{out}"})
    if trajectory:
        if SCENE not in checked:
            raise InputError(f"{key}.trajectory: found without a scene, expected a table scene beside it")
        if not series.is_one_of_many:
            _require_executable(trajectory[0], f"{key}.trajectory", folder)
        trajectory = (os.fspath(_found(trajectory[0], folder)), *trajectory[1:])
    benchmark = series.benchmark
    return Command(
        words=(os.fspath(program.path), *words[1:]),
        folder=folder,
        instrument=instrument,
        trajectory=trajectory,
        pattern=series.time.stdout if series.time else None,
        unit_seconds=SECONDS_OF_UNIT[series.time.unit] if series.time else 1.0,
        benchmark=_filled((str(benchmark.name),), f"{key}.benchmark.name", known)[0] if benchmark else None,
    ), program


def placed(words: Sequence[str], scene: Path | None = None, output: Path | None = None) -> tuple[str, ...]:
    """The words with the files in their places."""
    files = {"{scene}": scene, "{out}": output}
    for name, path in files.items():
        words = [word if path is None else word.replace(name, os.fspath(path)) for word in words]
    return tuple(words)


def _text(value: object) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _filled(words: Sequence[str], key: str, known: Mapping[str, str]) -> tuple[str, ...]:
    filled = []
    for word in words:
        try:
            parts = list(string.Formatter().parse(word))
        except ValueError as error:
            raise InputError(f'{key}: found "{word}": {error}; {{{{ stands for a brace') from error
        text = ""
        for literal, name, form, conversion in parts:
            text += literal
            if name is None:
                continue
            if name not in known or form or conversion:
                raise InputError(
                    f'{key}: found "{{{name}}}", expected one of {", ".join(f"{{{one}}}" for one in known)}'
                    f"{nearest(name, known)}"
                )
            text += known[name]
        filled.append(text)
    return tuple(filled)


def _found(word: str, folder: Path) -> Path:
    """The file that a first word names: below the folder if it has a slash, else on PATH."""
    return (folder / word if "/" in word else Path(shutil.which(word) or word)).absolute()


def _require_executable(word: str, key: str, folder: Path) -> None:
    found = _found(word, folder)
    if not found.exists():
        where = "a program" if "/" in word else "a program on PATH"
        raise InputError(f'{key}: found "{word}", which is not there; expected {where}')
    if found.is_dir():
        raise InputError(f'{key}: found "{word}", which is a folder; expected a program')
    if not os.access(found, os.X_OK):
        raise InputError(f'{key}: found "{word}", which is not executable; `chmod +x` makes it so')


def _program(words: Sequence[str], folder: Path) -> Program:
    path = _found(words[0], folder)
    others = [folder / word for word in words[1:] if word and len(word) < os.pathconf("/", "PC_PATH_MAX")]
    files = (path, *_interpreter(path), *(file for file in others if _is_file(file)))
    return Program(path.name, path, digest_of_hashes([sha256_of(file) for file in files]), files)


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _interpreter(path: Path) -> tuple[Path, ...]:
    """What runs a script: the program of its first line, of `env` the one that it finds."""
    with path.open("rb") as file:
        first = file.readline(_LONGEST_FIRST_LINE)
    if not first.startswith(_SCRIPT):
        return ()
    words = first[len(_SCRIPT) :].decode(errors="replace").split()
    if words and Path(words[0]).name == "env":
        words = [word for word in words[1:] if not word.startswith("-") and "=" not in word]
    found = shutil.which(words[0]) if words else None
    return (Path(found),) if found else ()
