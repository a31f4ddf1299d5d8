"""A question of the study: one TOML file, read, checked and frozen."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from experiments.plan.claims import CLAIMS, PUBLISHED_CLAIMS, require_claim
from experiments.plan.kinds import kind_and_figure, require_what_kind_needs
from experiments.plan.scenes import AnyScene, HardCase, NoScene, Scene
from experiments.plan.series import Series, read_series, require_both_ways, require_replicated
from experiments.support.errors import InputError, nearest, quoted, require_text
from experiments.support.schema import read_toml

FOLDER = Path(__file__).parents[1] / "questions"
CONTROL = "control"
_NUMBER = re.compile(r"\s*-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?\s*")
_OF_THE_RUN = ("threads", "find_chunk", "resolve_chunk", "substeps")
_OF_A_SCENE = (
    "particles", "side", "radius", "steps", "min_velocity", "max_velocity", "area_fraction", "seed",
)  # fmt: skip
_WHOLE_NUMBERS = (*_OF_THE_RUN, "particles", "steps", "seed")
_PLACEHOLDERS = ("scene", "out", "folder", "program")
_OF_SERIES = ("find_chunk", "resolve_chunk")

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
    _require_valid(question)
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
        raise InputError(f"{path}: scene: found beside scenes, expected either")
    if one is not None:
        return (_named_scene(one),)
    if several is None:
        return (NamedScene(NoScene()),)
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


def _require_valid(question: Question) -> None:
    """What a schema cannot say: raises InputError for the first thing that is wrong, as the ones below do."""
    file, sweep, blocks = question.file, question.sweep, question.blocks
    if blocks.wanted < blocks.minimum:
        raise InputError(f"{file}: blocks.wanted: found {blocks.wanted}, expected at least {blocks.minimum}")
    _require_names(question)
    if question.claim is not None:
        require_claim(file, question.claim)
    _require_possible_scenes(question)
    _require_what_processes_can(question)
    _require_what_errors_need(question)
    _require_published_tolerance(question)
    if question.kind == "ways":
        require_both_ways(file, question.series)
    if sweep.parameter == "substeps" and question.substeps != 1:
        raise InputError(f"{file}: substeps: found beside a sweep of it, expected either")
    for key, only in (("unit", "threads"), ("limit", "threads"), ("constant", "particles")):
        if getattr(sweep, key) is not None and sweep.parameter != only:
            raise InputError(f"{file}: sweep.{key}: found for {sweep.parameter}, expected for {only} only")
    for number, series in enumerate(question.series, start=1):
        _require_values(question, f"series[{number}]", series)


def _require_names(question: Question) -> None:
    """A tag that reads as a number is one in a record, and no longer the name that it was; series of one name
    would be drawn as one.
    """
    named = {"file name": question.name}
    for number, series in enumerate(question.series, start=1):
        named |= {f"series[{number}].name": series.name, f"series[{number}].label": series.label or ""}
    for number, scene in enumerate(question.scenes, start=1):
        named[f"scenes[{number}].name"] = scene.name or ""
    for key, name in named.items():
        if _NUMBER.fullmatch(name):
            raise InputError(f'{question.file}: {key}: found "{name}", expected a name that is no number')
    curves = [(series.name, series.label, series.apart) for series in question.series]
    for number, (name, *others) in enumerate(curves, start=1):
        if (name, *others) in curves[: number - 1]:
            raise InputError(
                f'{question.file}: series[{number}].name: found "{name}" twice, expected each once'
            )
    known = list(dict.fromkeys(series.name for series in question.series))
    told = {"reference": question.reference} if question.reference is not None else {}
    for number, scene in enumerate(question.scenes, start=1):
        told |= {
            f"scenes[{number}].series[{place}]": name for place, name in enumerate(scene.series, start=1)
        }
    for key, name in told.items():
        if name not in known:
            expected = f"one of {', '.join(known)}{nearest(name, known)}"
            raise InputError(f"{question.file}: {key}: found {quoted(name)}, expected {expected}")


def _require_possible_scenes(question: Question) -> None:
    parameter = question.sweep.parameter
    for number, named in enumerate(question.scenes, start=1):
        scene, key = named.scene, "scene" if len(question.scenes) == 1 else f"scenes[{number}]"
        if isinstance(scene, NoScene):
            if not all(series.is_foreign for series in question.series):
                raise InputError(
                    f"{question.file}: scene: missing; expected a table, or a list scenes of several"
                )
        elif isinstance(scene, HardCase):
            if parameter in _OF_A_SCENE:
                raise InputError(
                    f"{question.file}: sweep.parameter: found {parameter} over the hard case {scene.case}, "
                    f"which is as it is; expected one of {', '.join(_OF_THE_RUN)}"
                )
        elif parameter not in _OF_A_SCENE:
            if scene.max_velocity < scene.min_velocity:
                raise InputError(
                    f"{question.file}: {key}.max_velocity: found {scene.max_velocity}, "
                    f"expected at least {scene.min_velocity}"
                )
            if scene.side < 2 * scene.radius:
                raise InputError(
                    f"{question.file}: {key}.side: found {scene.side}, expected at least a disc's diameter, "
                    f"{2 * scene.radius}"
                )


def _require_what_processes_can(question: Question) -> None:
    """Of other programs nothing but whole processes can be timed, and nothing but theirs has other axes."""
    file, parameter = question.file, question.sweep.parameter
    foreign = [series for series in question.series if series.is_foreign]
    if foreign and question.verb != "process":
        raise InputError(f'{file}: verb: found {question.verb} beside programs of others, expected "process"')
    known = (*_OF_THE_RUN, *_OF_A_SCENE)
    if parameter is not None and parameter not in known and len(foreign) < len(question.series):
        raise InputError(
            f"{file}: sweep.parameter: found {quoted(parameter)}, expected one of {', '.join(known)}"
            f"{nearest(parameter, known)}"
        )
    if parameter in _PLACEHOLDERS:
        told = "which is a placeholder of another meaning; expected another name"
        raise InputError(f"{file}: sweep.parameter: found {quoted(parameter)}, {told}")
    if parameter in _OF_A_SCENE and any(isinstance(named.scene, NoScene) for named in question.scenes):
        raise InputError(f"{file}: sweep.parameter: found {parameter} without a scene, expected another name")
    if question.verb == "process":
        for key, default in (("repetitions", 1), ("errors", False), ("simulated", 0)):
            if getattr(question, key) != default:
                raise InputError(f"{file}: {key}: found for whole processes, expected for verb bench only")


def _require_what_errors_need(question: Question) -> None:
    """What is measured beside times is measured by one verb, and a kind that judges it needs it."""
    file = question.file
    if question.errors and question.verb != "bench":
        raise InputError(f"{file}: errors: found for verb {question.verb}, expected for bench only")
    if question.simulated and question.verb != "profile":
        raise InputError(f"{file}: simulated: found for verb {question.verb}, expected for profile only")
    has = {
        "errors": question.errors,
        "sweep": question.sweep.parameter,
        "scenes": len(question.scenes),
    }
    require_what_kind_needs(file, question.kind, question.figure, has)


def _require_published_tolerance(question: Question) -> None:
    """A published claim is about the published program, and so about its tolerance, unless that cannot be."""
    if (
        question.claim in PUBLISHED_CLAIMS
        and question.tolerance != "published"
        and question.tolerance_reason is None
    ):
        raise InputError(
            f"{question.file}: tolerance: found {question.tolerance} for a published claim, expected "
            '"published", or a tolerance_reason'
        )
    if question.tolerance == "published" and question.tolerance_reason is not None:
        raise InputError(
            f"{question.file}: tolerance_reason: found beside the published tolerance, which needs none"
        )


def _require_values(question: Question, key: str, series: Series) -> None:
    parameter = question.sweep.parameter
    if parameter in ("particles", "side") and series.quick_values == series.values:
        raise InputError(
            f"{question.file}: {key}.quick_values: missing; expected the values of {parameter} at quick scale"
        )
    if parameter is None and series.values:
        raise InputError(f"{question.file}: {key}.values: found values, expected none without a sweep")
    if parameter is not None and not series.values:
        raise InputError(f"{question.file}: {key}.values: missing; expected the values of {parameter}")
    require_replicated(question.file, key, series, question.figure, question.sweep.unit)
    if parameter in _OF_SERIES and getattr(series, parameter) is not None:
        raise InputError(f"{question.file}: {key}.{parameter}: found beside a sweep of it, expected either")
    if question.sweep.unit or parameter not in _WHOLE_NUMBERS:
        return
    for value in (*series.values, *series.quick_values):
        if value != int(value):
            raise InputError(f"{question.file}: {key}.values: found {value}, expected whole numbers")


def with_blocks(question: Question, blocks: int | None) -> Question:
    """The question asked exactly `blocks` times; unchanged for None."""
    return question if blocks is None else replace(question, blocks=Blocks(blocks, blocks))
