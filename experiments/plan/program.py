"""The carom program as this package knows it: its command line and its exit codes, nothing else."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from experiments.plan.scenes import AnyScene, sha256_of
from experiments.plan.site import Site
from experiments.support import process
from experiments.support.digest import digest_of_hashes
from support.errors import InputError

CHECK_FAILED = 2

GENERATOR = "gcc"
"""The build that makes the scenes, whichever is measured."""

BESIDE = {
    "gcc-libomp": "gcc/carom-libomp",
    "clang-in-gcc": "gcc/carom-libomp clang/carom-variants.so",
}
"""What the builds of a site make besides: g++'s code with the OpenMP runtime of clang++, where clang++ is,
and that program with the variants of clang++'s build in place of its own.
"""

SHORT_NAMES = ("auto", "fastest")
"""What the program understands beside the names of its variants: the fastest for the scene at hand, and the
one that is the fastest for all but the smallest scenes.
"""


@dataclass(frozen=True)
class Program:
    """One build of the program, or somebody else's; without a SHA-256 where it is not built."""

    name: str
    path: Path
    sha256: str | None
    files: tuple[Path, ...] = ()
    """What it is made of, where that is more than the one file."""
    hashes: tuple[str, ...] = ()
    """Of each of these files, as it was first seen."""
    absent: tuple[Path, ...] = ()
    """Words that could be files, and are none: it is not to make one of them, unless that is said."""
    written: frozenset[Path] = frozenset()
    """Files that may be written by what is measured: what they hold now says nothing of it."""
    library: Path | None = None
    """One of its files: the variants of another build, which it runs in place of its own."""

    @property
    def hash_of(self) -> dict[Path, str | None]:
        """The hash of each file that it is made of."""
        return dict(zip(self.sources, self.hashes or (self.sha256,), strict=True))

    def require_unchanged(self) -> None:
        """Raises InputError for the first of its files that is not what it was."""
        for file, sha256 in self.hash_of.items():
            if file not in self.written and sha256_of(file) != sha256:
                told = f"{file}: was built anew while the study ran; run the study again to go on with it"
                writes = ", or say `writes` where it is written by what is measured"
                raise InputError(told + (writes if file != self.path else ""))

    def require_nothing_made(self) -> None:
        """Raises InputError for the first file among its words that is there now, and was not."""
        made = next((file for file in self.absent if file.is_file()), None)
        if made is not None:
            raise InputError(f"{made}: is written by what is measured, expected it in `writes` of its series")

    @property
    def sources(self) -> tuple[Path, ...]:
        """Every file that it is made of."""
        return self.files or (self.path,)

    @property
    def remedy(self) -> str:
        """What to say of a program that is not built."""
        file = next((file for file in self.sources if not file.is_file()), self.path)
        compiler = " COMPILER=clang" if file.parent.name == "clang" else ""
        return f"{file}: is not built; build it with `make build{compiler}`"

    @property
    def variants_of(self) -> tuple[str, ...]:
        """The option that names its library, if it has one."""
        return ("--variants-of", str(self.library)) if self.library is not None else ()


def find_programs(site: Site, build: Path) -> dict[str, Program]:
    """The site's programs by name; those below `build` that are not built have no SHA-256."""
    found = {}
    for name, words in (BESIDE | dict(site.programs)).items():
        path, *more = files = tuple(build.resolve() / relative for relative in words.split())
        hashes = tuple(sha256_of(file) for file in files) if all(file.is_file() for file in files) else ()
        sha256 = digest_of_hashes(hashes) if hashes else None
        found[name] = Program(name, path, sha256, files, hashes, library=more[0] if more else None)
    return found


@cache
def variants(program: Program) -> tuple[str, ...]:
    """The names of the program's variants. Raises InputError if it is not built or does not answer."""
    if program.sha256 is None:
        raise InputError(program.remedy)
    done = process.run([str(program.path), "list", "--names"], time_limit=60)
    names = tuple(done.output.split())
    if done.exit_code != 0 or not names:
        raise InputError(f"{program.path}: `list --names` gave no names: {done.reason}")
    return names


@cache
def build_of(program: Program) -> dict[str, Any]:
    """How a build of Carom was made, as in a record's provenance. Raises InputError if it does not say."""
    done = process.run([str(program.path), "doctor", "--build"], time_limit=60)
    try:
        return dict(json.loads(done.output))
    except (ValueError, TypeError) as error:
        told = f"`doctor --build` does not say how it was built: {done.reason}"
        raise InputError(f"{program.path}: {told}") from error


def generate(program: Program, scene: AnyScene, path: Path) -> None:
    """Write a scene file. Raises InputError with the program's own words if it refuses."""
    command = [str(program.path), "generate", *scene.arguments, "--output", str(path)]
    done = process.run(command, time_limit=600)
    if done.exit_code != 0:
        raise InputError(f"scene {' '.join(scene.arguments)}: {done.reason}")


def check_command(program: Program, scene: Path, tolerance: str, *what: object) -> tuple[str, ...]:
    """The command that verifies every step on a scene: of so many threads and `--variant` one, or of what
    another program wrote, `--trajectory` a file.
    """
    words = (str(program.path), "check", str(scene), *map(str, what), "--tolerance", tolerance)
    return (*words, *program.variants_of)


def tag_arguments(tags: Mapping[str, str | int | float]) -> tuple[str, ...]:
    """What the record is to remember, as `--tag KEY=VALUE`."""
    return tuple(word for key, value in tags.items() for word in ("--tag", f"{key}={value}"))
