"""A question of the study: one TOML file, read, checked and frozen."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from experiments.plan.claims import CLAIMS
from experiments.plan.kinds import kind_and_figure
from experiments.plan.rules import require_valid
from experiments.plan.scenes import AnyScene, HardCase, NoScene, Scene
from experiments.plan.series import Series, read_series
from experiments.support.schema import read_toml
from support.errors import InputError, nearest, require_text
from support.vocabulary import CONTROL

FOLDER = Path(__file__).parents[1] / "questions"

Threads = int | Literal["cores", "hardware_threads"]


@dataclass(frozen=True)
class Blocks:
    """How often the question is asked: at least `minimum` times, up to `wanted` where the budget allows."""

    minimum: int = 3
    wanted: int = 5


@dataclass(frozen=True)
class NamedScene:
    """A scene, its name where the question has several, whether it is left out at quick scale, and the names
    of the series that run it, if not all of them do.
    """

    scene: AnyScene
    name: str | None = None
    paper_only: bool = False
    series: tuple[str, ...] = ()


@dataclass(frozen=True)
class Sweep:
    """What changes along a curve. Without a parameter the curve is one point."""

    parameter: str | None = None
    x_name: str = "repetition"
    unit: Literal["hardware_threads"] | None = None
    limit: float | None = None
    constant: Literal["area_fraction"] | None = None


@dataclass(frozen=True)
class Question:
    """One question: its name is that of its file, and that of the experiment in the records."""

    name: str
    file: Path
    title: str
    kind: str
    figure: str
    scenes: tuple[NamedScene, ...]
    series: tuple[Series, ...]
    sweep: Sweep = Sweep()
    claim: str | None = None
    margin: float = 0.02
    """The least difference that matters."""
    error: float = 0.05
    """The share of studies in which any verdict of its table may be wrong."""
    reference: str | None = None
    """The series that the others are compared with, if the file says which."""
    verb: Literal["bench", "profile", "process"] = "bench"
    threads: Threads = "hardware_threads"
    bound: bool = True
    turns: bool = True
    tolerance: Literal["relative", "published"] = "relative"
    tolerance_reason: str | None = None
    substeps: int = 1
    warm_up: int = 0
    repetitions: int = 1
    errors: bool = False
    simulated: int = 0
    blocks: Blocks = Blocks()

    @property
    def writes(self) -> tuple[str, ...]:
        """The files that its programs write."""
        return tuple(word for one in self.series for word in one.writes)

    @property
    def programs(self) -> frozenset[str]:
        """The builds of the program that it cannot do without."""
        return frozenset(one.program for one in self.series if not one.is_foreign and not one.optional)


def load_question(path: Path) -> Question:
    """Read one question. Raises InputError with one line if the file is not a valid question."""
    document = read_toml(path, FOLDER / "question.schema.json")
    sweep_table = document.pop("sweep", {})
    values = {key: tuple(sweep_table.pop(key, ())) for key in ("values", "quick_values")}
    series = read_series(path, document.pop("series"), values)
    kind, figure = kind_and_figure(path, document.pop("kind", None), document.pop("figure", None))
    question = Question(
        name=path.stem,
        file=path,
        kind=kind,
        figure=figure,
        scenes=_scenes(path, document.pop("scene", None), document.pop("scenes", None)),
        sweep=Sweep(**{"x_name": sweep_table.get("parameter", Sweep.x_name), **sweep_table}),
        series=series,
        verb=document.pop("verb", "process" if any(one.is_foreign for one in series) else "bench"),
        blocks=Blocks(**document.pop("blocks", {})),
        **document,
    )
    require_valid(question)
    return question


def load_questions(folder: Path, names: Iterable[str] = ()) -> tuple[Question, ...]:
    """All questions of a folder, or those named; the control is always among them, if the folder has one.

    Raises InputError for a name that the folder does not have, and for a file that is not a valid question.
    """
    if not folder.is_dir():
        raise InputError(f"questions: found {folder}, expected a folder that is there")
    files = {path.stem: path for path in sorted(folder.glob("*.toml")) if path.name != CLAIMS}
    for path in (folder.absolute(), *files.values()):
        require_text("questions", path)
    if not files:
        raise InputError(f"{folder}: has no question in it; expected files *.toml")
    chosen = list(dict.fromkeys(names)) or list(files)
    for name in chosen:
        if name not in files:
            # Where one resembles it, all the others would only hide that one.
            like = nearest(name, files)
            expected = "the name of a question" if like else f"names out of {', '.join(files)}"
            raise InputError(f'study: found "{name}", expected {expected}{like}')
    if CONTROL in files and CONTROL not in chosen:
        chosen.append(CONTROL)
    return tuple(load_question(files[name]) for name in chosen)


def _scenes(
    path: Path, one: dict[str, Any] | None, several: list[dict[str, Any]] | None
) -> tuple[NamedScene, ...]:
    if one is not None and several is not None:
        raise InputError(f"{path}: scene: found beside scenes, expected only one of the two")
    if several is None:
        return (_named_scene(one) if one is not None else NamedScene(NoScene()),)
    named: dict[str, NamedScene] = {}
    for number, table in enumerate(several, start=1):
        key = f"scenes[{number}]"
        scene = _named_scene({"name": table.get("case"), **table})
        if scene.name is None:
            raise InputError(f"{path}: {key}.name: missing; expected a text, which tells the scenes apart")
        if scene.name in named:
            raise InputError(f'{path}: {key}.name: found "{scene.name}" twice, expected each once')
        named[scene.name] = scene
    return tuple(named.values())


def _named_scene(table: dict[str, Any]) -> NamedScene:
    beside = {key: table.pop(key) for key in ("name", "paper_only") if key in table}
    series = tuple(table.pop("series", ()))
    return NamedScene(HardCase(**table) if "case" in table else Scene(**table), series=series, **beside)


def with_blocks(question: Question, blocks: int | None) -> Question:
    """The question asked exactly `blocks` times; unchanged for None."""
    return question if blocks is None else replace(question, blocks=Blocks(blocks, blocks))
