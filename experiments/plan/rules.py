"""What a schema cannot say of a question: names, scenes, and what its keys ask of each other."""

import re
from typing import TYPE_CHECKING

from experiments.plan.claims import PUBLISHED_CLAIMS, require_claim
from experiments.plan.kinds import require_what_kind_needs
from experiments.plan.scenes import HardCase, NoScene
from experiments.plan.series import Series, require_both_ways, require_replicated
from support.errors import InputError, nearest, quoted

if TYPE_CHECKING:
    from experiments.plan.question import Question

_NUMBER = re.compile(r"\s*-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?\s*")
_OF_THE_RUN = ("threads", "find_chunk", "resolve_chunk", "substeps")
_OF_A_SCENE = (
    "particles", "side", "radius", "steps", "min_velocity", "max_velocity", "area_fraction", "seed",
)  # fmt: skip
_WHOLE_NUMBERS = (*_OF_THE_RUN, "particles", "steps", "seed")
_PLACEHOLDERS = ("scene", "out", "folder", "program")
_OF_SERIES = ("find_chunk", "resolve_chunk")


def require_valid(question: "Question") -> None:
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


def _require_names(question: "Question") -> None:
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


def _require_possible_scenes(question: "Question") -> None:
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


def _require_what_processes_can(question: "Question") -> None:
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


def _require_what_errors_need(question: "Question") -> None:
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


def _require_published_tolerance(question: "Question") -> None:
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


def _require_values(question: "Question", key: str, series: Series) -> None:
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
