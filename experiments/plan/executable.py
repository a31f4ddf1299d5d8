"""Files that can be run, and what a program is made of: itself, its interpreter, files among its words."""

import os
import re
import shutil
from collections.abc import Collection, Sequence
from pathlib import Path

from experiments.plan.program import Program
from experiments.plan.scenes import sha256_of
from experiments.support.digest import digest_of_hashes
from support.errors import quoted

_SCRIPT = b"#!"
_LONGEST_FIRST_LINE = 4096


class UnfitError(Exception):
    """Why a file, the `word` of a `part` of a command, cannot be run: the rest of a sentence about it."""

    word = part = ""

    @property
    def told(self) -> str:
        """What was found, with what was expected where the word names nothing."""
        where = "; expected a program" + ("" if "/" in self.word else " on PATH")
        return f'found "{self.word}", which {self}{where if str(self) == "is not there" else ""}'


def found(word: str, folder: Path) -> Path:
    """The file that a first word names: below the folder if it has a slash, else on PATH."""
    on_path = None if "/" in word else shutil.which(word)
    return (Path(on_path) if on_path else folder / word).absolute()


def require_executable(word: str, folder: Path) -> None:
    """Raises UnfitError for a first word that names nothing that can be run, as far as can be seen."""
    if "/" not in word and shutil.which(word) is None and is_file(folder / word):
        raise UnfitError(f"is not on PATH; expected ./{word}, if the file of the folder is meant")
    path = found(word, folder)
    try:
        is_there = path.exists()
    except OSError as error:
        raise UnfitError(f"cannot be looked at: {error.strerror}") from error
    if not is_there:
        raise UnfitError("is a link to nothing" if path.is_symlink() else "is not there")
    if path.is_dir():
        raise UnfitError("is a folder; expected a program")
    if not path.is_file():
        raise UnfitError("is no file; expected a program")
    if not os.access(path, os.X_OK):
        raise UnfitError("is not executable; `chmod +x` makes it so")
    asked = _interpreter(path)
    # What `env` is to look for it says itself where it does not find it.
    if asked and not _is_env(asked) and not (folder / asked[0]).is_file():
        raise UnfitError(f"begins with #! and {quoted(asked[0])}, which is not there; expected a program")


def program_of(
    commands: Sequence[Sequence[str]],
    folder: Path,
    where: Path | None,
    writes: Collection[Path] | None,
) -> Program:
    """The program that the first of these commands runs, and everything that decides what it does: the other
    commands included, each found in `folder`.

    Words name files of the folder `where`; without one only those that begin with / do. What it `writes` is
    no part of it; None if any of these files may be written, each of which counts as what it is now. Raises
    InputError for one that cannot be read.
    """
    own = [found(words[0], folder) for words in commands]
    parts = [part for path in own for part in (path, *_found_interpreter(path))]
    named = [file for words in commands for file in _named(words[1:], where)]
    named = [file for file in named if file not in (writes or ())]
    inputs = [one for one in named if is_file(one)]
    files = (*parts, *inputs)
    hashes = tuple(map(sha256_of, files))
    return Program(
        name=own[0].name,
        path=own[0],
        sha256=digest_of_hashes(hashes),
        files=files,
        hashes=hashes,
        absent=() if writes is None else tuple(file for file in named if file not in inputs),
        written=frozenset(inputs).difference(parts) if writes is None else frozenset(),
    )


def _named(words: Sequence[str], where: Path | None) -> list[Path]:
    """The files that words may name, there or not."""
    longest = os.pathconf("/", "PC_PATH_MAX")
    named = [word for word in words if word and len(os.fsencode(word)) < longest and "{scene}" not in word]
    return [(where or Path("/")) / word for word in named if where is not None or word.startswith("/")]


def is_file(path: Path) -> bool:
    """Whether it is one, as far as that can be seen."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _interpreter(path: Path) -> list[str]:
    """The words of a script's first line, as the kernel reads them; none of what is no script."""
    try:
        with path.open("rb") as file:
            first = file.readline(_LONGEST_FIRST_LINE)
    except OSError:
        return []  # whoever asks for its SHA-256 is told
    if not first.startswith(_SCRIPT):
        return []
    line = first[len(_SCRIPT) :].removesuffix(b"\n").decode(errors="replace")
    return [word for word in re.split(r"[ \t]+", line) if word]


def _is_env(words: Sequence[str]) -> bool:
    return Path(words[0]).name == "env"


def _found_interpreter(path: Path) -> tuple[Path, ...]:
    """What runs a script: the program of its first line, of `env` the one that it finds."""
    words = _interpreter(path)
    if words and _is_env(words):
        words = [word for word in words[1:] if not word.startswith("-") and "=" not in word]
    at = shutil.which(words[0]) if words else None
    return (Path(at),) if at else ()
