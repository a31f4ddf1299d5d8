"""What a schema cannot say of a question: names, scenes, and what its keys ask of each other.

Each rule yields what breaks it, as the rest of a line that begins with the question's file.
"""

import re
from collections import Counter
from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from experiments.plan.claims import known_claims, published_claims
from experiments.plan.kinds import KINDS
from experiments.plan.scenes import HardCase, NoScene
from experiments.plan.series import Series
from support.errors import InputError, not_one_of

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
    """What a schema cannot say: raises InputError for the first thing that is wrong."""
    wrong = next(chain.from_iterable(rule(question) for rule in _RULES), None)
    if wrong is not None:
        raise InputError(f"{question.file}: {wrong}")


def _names(question: "Question") -> Iterator[str]:
    """A tag that reads as a number is one in a record, and no longer the name that it was; series of one name
    would be drawn as one.
    """
    named = {"file name": question.name}
    told = {"reference": question.reference} if question.reference is not None else {}
    for number, series in enumerate(question.series, start=1):
        named |= {f"series[{number}].name": series.name, f"series[{number}].label": series.label or ""}
    for number, scene in enumerate(question.scenes, start=1):
        named[f"scenes[{number}].name"] = scene.name or ""
        told |= {f"scenes[{number}].series[{at}]": name for at, name in enumerate(scene.series, start=1)}
    for key, name in named.items():
        if _NUMBER.fullmatch(name):
            yield f'{key}: found "{name}", expected a name that is no number'
    curves: Counter[object] = Counter()
    for number, series in enumerate(question.series, start=1):
        curves[series.name, series.label, series.apart] += 1
        if curves[series.name, series.label, series.apart] > 1:
            yield f'series[{number}].name: found "{series.name}" twice, expected each once'
    known = list(dict.fromkeys(series.name for series in question.series))
    for key, name in told.items():
        if name not in known:
            yield f"{key}: {not_one_of(name, known)}"


def _claim(question: "Question") -> Iterator[str]:
    known = known_claims(question.file) if question.claim is not None else []
    if question.claim is not None and question.claim not in known:
        yield f"claim: {not_one_of(question.claim, known)}"


def _possible_scenes(question: "Question") -> Iterator[str]:
    parameter = question.sweep.parameter
    for number, named in enumerate(question.scenes, start=1):
        scene, key = named.scene, "scene" if len(question.scenes) == 1 else f"scenes[{number}]"
        if isinstance(scene, NoScene):
            if not all(series.is_foreign for series in question.series):
                yield "scene: missing; expected a table, or a list scenes of several"
        elif isinstance(scene, HardCase):
            if parameter in _OF_A_SCENE:
                yield (
                    f"sweep.parameter: found {parameter} over the hard case {scene.case}, which is as it is; "
                    f"expected one of {', '.join(_OF_THE_RUN)}"
                )
        elif parameter not in _OF_A_SCENE:
            least, diameter = scene.min_velocity, 2 * scene.radius
            if scene.max_velocity < least:
                yield f"{key}.max_velocity: found {scene.max_velocity}, expected at least {least}"
            if scene.side < diameter:
                yield f"{key}.side: found {scene.side}, expected at least a disc's diameter, {diameter}"


def _what_processes_can(question: "Question") -> Iterator[str]:
    """Of other programs nothing but whole processes can be timed, and nothing but theirs has other axes."""
    parameter = question.sweep.parameter
    foreign = [series for series in question.series if series.is_foreign]
    if foreign and question.verb != "process":
        yield f'verb: found {question.verb} beside programs of others, expected "process"'
    known = (*_OF_THE_RUN, *_OF_A_SCENE)
    if parameter is not None and parameter not in known and len(foreign) < len(question.series):
        yield f"sweep.parameter: {not_one_of(parameter, known)}"
    if parameter in _PLACEHOLDERS:
        yield f"sweep.parameter: found {parameter}, a placeholder of another meaning; expected another name"
    if parameter in _OF_A_SCENE and any(isinstance(named.scene, NoScene) for named in question.scenes):
        yield f"sweep.parameter: found {parameter} without a scene, expected another name"


def _what_is_measured_beside(question: "Question") -> Iterator[str]:
    """What is measured beside times is measured by one verb, and a kind that judges it needs it."""
    for key, default, verbs in (
        ("repetitions", 1, ("bench", "profile")),
        ("errors", False, ("bench",)),
        ("simulated", 0, ("profile",)),
    ):
        if getattr(question, key) != default and question.verb not in verbs:
            yield f"{key}: found for verb {question.verb}, expected for {' or '.join(verbs)} only"
    kind = KINDS[question.kind]
    if kind.errors and not question.errors:
        yield f"errors: missing; expected true for kind {question.kind}"
    if kind.sweep not in (None, question.sweep.parameter):
        yield f"sweep.parameter: expected {kind.sweep} for kind {question.kind}"
    for key in ("kind", "figure"):
        name = getattr(question, key)
        if len(question.scenes) != 1 and not KINDS[name].scenes:
            several = ", ".join(sorted(name for name, kind in KINDS.items() if kind.scenes))
            yield f"scenes: found several for {key} {name}, expected one, or one of the kinds {several}"


def _published_tolerance(question: "Question") -> Iterator[str]:
    """A published claim is about the published program, and so about its tolerance, unless that cannot be."""
    is_published, has_reason = question.tolerance == "published", question.tolerance_reason is not None
    if question.claim in published_claims() and not is_published and not has_reason:
        yield (
            f"tolerance: found {question.tolerance} for a published claim, expected "
            '"published", or a tolerance_reason'
        )
    if is_published and has_reason:
        yield "tolerance_reason: found beside the published tolerance, which needs none"


def _both_ways(question: "Question") -> Iterator[str]:
    """Each of the kind ways is measured by turns and apart."""
    for number, one in enumerate(question.series if question.kind == "ways" else (), start=1):
        if not any(other.name == one.name and other.apart != one.apart for other in question.series):
            missing = f"another one {'without' if one.apart else 'with'} apart = true for kind ways"
            yield f'series[{number}]: found "{one.name}" once, expected {missing}'


def _blocks_and_sweep(question: "Question") -> Iterator[str]:
    sweep, blocks = question.sweep, question.blocks
    if blocks.wanted < blocks.minimum:
        yield f"blocks.wanted: found {blocks.wanted}, expected at least {blocks.minimum}"
    if sweep.parameter == "substeps" and question.substeps != 1:
        yield "substeps: found beside a sweep of it, expected only one of the two"
    for key, only in (("unit", "threads"), ("limit", "threads"), ("constant", "particles")):
        if getattr(sweep, key) is not None and sweep.parameter != only:
            yield f"sweep.{key}: found for {sweep.parameter}, expected for {only} only"


def _values(question: "Question") -> Iterator[str]:
    for number, series in enumerate(question.series, start=1):
        for rule in (_values_of, _replicated):
            yield from (f"series[{number}].{wrong}" for wrong in rule(series, question))


def _values_of(series: Series, question: "Question") -> Iterator[str]:
    parameter, unit = question.sweep.parameter, question.sweep.unit
    if parameter in ("particles", "side") and series.quick_values == series.values:
        yield f"quick_values: missing; expected the values of {parameter} at quick scale"
    if parameter is None and series.values:
        yield "values: found values, expected none without a sweep"
    if parameter is not None and not series.values:
        yield f"values: missing; expected the values of {parameter}"
    if parameter in _OF_SERIES and getattr(series, parameter) is not None:
        yield f"{parameter}: found beside a sweep of it, expected only one of the two"
    for value in (*series.values, *series.quick_values):
        if not unit and parameter in _WHOLE_NUMBERS and value != int(value):
            yield f"values: found {value}, expected whole numbers"


def _replicated(series: Series, question: "Question") -> Iterator[str]:
    """What has replicates is measured at either scale, and only one figure draws those of a block as one
    sample.
    """
    if series.replicated and question.figure != "schedule":
        yield f"replicated: found for figure {question.figure}, expected for schedule only"
    if series.replicated and question.sweep.unit is not None:
        yield "replicated: found beside sweep.unit, expected only one of the two"
    for name in ("values", "quick_values"):
        for value in series.replicated:
            if value not in getattr(series, name):
                yield f"replicated: found {value:g}, expected one of its {name}"


_RULES = (
    _names, _claim, _possible_scenes, _what_processes_can, _what_is_measured_beside, _published_tolerance,
    _both_ways, _blocks_and_sweep, _values,
)  # fmt: skip
