"""Scenes: what the generator is asked for, and the files made from it."""

import hashlib
import math
import os
import stat
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from support.errors import InputError
from support.files import write_text

CHECKED_STEPS = 20
"""How many steps of a generated scene are checked before it is timed; of a hard case all are."""

_DIGITS = 12
"""How many of a scene's SHA-256 stand in the name of its file."""


class _Named:
    @property
    def arguments(self) -> tuple[str, ...]:
        """What `carom generate` is given."""
        return ()

    @property
    def name(self) -> str:
        """The arguments in one word."""
        return "-".join(argument.lstrip("-") for argument in self.arguments)


@dataclass(frozen=True)
class Scene(_Named):
    """The arguments of `carom generate`: discs at random in a square box."""

    particles: int
    side: float
    radius: float
    steps: int
    min_velocity: float
    max_velocity: float
    seed: int = 1
    placement: str = "overlapping"
    isotropic: bool = False

    @property
    def area_fraction(self) -> float:
        """N pi r^2 / L^2."""
        return self.particles * math.pi * self.radius**2 / self.side**2

    @property
    def arguments(self) -> tuple[str, ...]:
        """N L R STEPS VMIN VMAX --seed S and what is not the default, as the program reads them."""
        lengths = (self.particles, self.side, self.radius, self.steps, self.min_velocity, self.max_velocity)
        words = (*(f"{value:.12g}" for value in lengths), "--seed", str(self.seed))
        if self.placement != Scene.placement:
            words += ("--placement", self.placement)
        return (*words, "--isotropic") if self.isotropic else words

    def with_area_fraction(self, fraction: float) -> "Scene":
        """The same discs in the box, of whole-numbered side, that they fill to about `fraction`."""
        side = self.radius * math.sqrt(self.particles * math.pi / fraction)
        return replace(self, side=max(round(side), math.ceil(2 * self.radius)))

    def shrunk(self, divisor: int) -> "Scene":
        """A `divisor`-th of the discs on a `divisor`-th of the area: the same physics, only less of it."""
        if divisor == 1:
            return self
        particles = max(1, round(self.particles / divisor))
        side = self.side * math.sqrt(particles / self.particles)
        return replace(self, particles=particles, side=max(round(side), math.ceil(2 * self.radius)))

    @property
    def beginning(self) -> "Scene":
        """As much of it as is checked."""
        return replace(self, steps=min(self.steps, CHECKED_STEPS))


@dataclass(frozen=True)
class HardCase(_Named):
    """A scene that the program knows by name, of one size only; `carom generate --cases` lists them."""

    case: str

    @property
    def arguments(self) -> tuple[str, ...]:
        """--case NAME, as the program reads it."""
        return ("--case", self.case)


@dataclass(frozen=True)
class NoScene(_Named):
    """What a question has that is not about discs."""


AnyScene = Scene | HardCase | NoScene


@dataclass(frozen=True)
class SceneFile:
    """A generated scene: its path ends in the first digits of `sha256`."""

    path: Path
    sha256: str


class SceneFolder:
    """The generated scenes below a results folder, each made when it is first needed.

    A file's name holds the generator's arguments and the beginning of the SHA-256 of its content, so that a
    torn or edited file is noticed and made again. Another generator program empties the folder.
    """

    def __init__(self, folder: Path, temporary: Path, generator_sha256: str) -> None:
        self.folder = folder
        self.temporary = temporary
        self._known: dict[AnyScene, SceneFile] = {}
        marker = folder / "generator"
        if marker.is_file() and marker.read_bytes().decode(errors="replace").strip() == generator_sha256:
            return
        folder.mkdir(parents=True, exist_ok=True)
        for path in folder.glob("*.in"):
            path.unlink()
        write_text(marker, generator_sha256 + "\n", temporary)

    def get(self, scene: AnyScene, generate: Callable[[AnyScene, Path], None]) -> SceneFile:
        """The scene's file; `generate` writes it to a temporary path if it is missing or damaged."""
        if scene not in self._known:
            self._known[scene] = self._find(scene) or self._make(scene, generate)
        return self._known[scene]

    def _find(self, scene: AnyScene) -> SceneFile | None:
        for path in self.folder.glob(f"{scene.name}-{_DIGITS * '?'}.in"):
            sha256 = sha256_of(path)
            if path.stem.endswith(f"-{sha256[:_DIGITS]}"):
                return SceneFile(path, sha256)
            path.unlink()
        return None

    def _make(self, scene: AnyScene, generate: Callable[[AnyScene, Path], None]) -> SceneFile:
        temporary = self.temporary / f"{scene.name}.in"
        generate(scene, temporary)
        sha256 = sha256_of(temporary)
        path = self.folder / f"{scene.name}-{sha256[:_DIGITS]}.in"
        temporary.replace(path)
        return SceneFile(path, sha256)


def sha256_of(path: Path) -> str:
    """The SHA-256 of a file, 64 hexadecimal digits. Raises InputError if it cannot be read."""
    try:
        # A pipe without a writer would be waited for.
        with open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise InputError(f"{path}: is no file that can be read from its beginning to its end")
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
