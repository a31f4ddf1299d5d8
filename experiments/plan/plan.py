"""From questions to points: what would be measured, on which machine, at which scale."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from experiments.plan.blocks import orders
from experiments.plan.command import SCENE, Command, Place, command_of
from experiments.plan.point import Point
from experiments.plan.program import GENERATOR, SHORT_NAMES, Program, variants
from experiments.plan.question import NamedScene, Question, Threads
from experiments.plan.scale import Scale
from experiments.plan.scenes import AnyScene, NoScene, Scene
from experiments.plan.series import Series
from experiments.plan.site import Machine, Site
from support.errors import InputError, nearest, not_one_of

SEED = 1


@dataclass(frozen=True)
class Surroundings:
    """What a question does not say itself."""

    site: Site
    machine: Machine
    programs: Mapping[str, Program]
    scale: Scale
    seed: int = SEED


@dataclass(frozen=True)
class Experiment:
    """A question with its points; `order_seed` decides the order within blocks."""

    question: Question
    points: tuple[Point, ...]
    order_seed: str

    @property
    def name(self) -> str:
        """The question's name."""
        return self.question.name

    def block(self, block: int) -> tuple[Point, ...]:
        """The points in the order in which block number `block` runs them."""
        order = orders(len(self.points), block + 1, self.order_seed)[block]
        return tuple(self.points[index] for index in order)


def plan(question: Question, around: Surroundings) -> Experiment:
    """All points of a question.

    Raises InputError with one line for a program or variant that does not exist, and for two points that
    would measure the same thing twice.
    """
    points = [
        point
        for scene in around.scale.scenes(question)
        for point in _with_replicates(
            [
                _point(question, number, series, scene, value, around)
                for number, series in enumerate(question.series, start=1)
                if not _left_out(series, scene, around)
                for value in _values(question, _known(question, number, series, around), around)
            ],
            question,
        )
    ]
    if not points:
        raise InputError(
            f"{question.file}: sweep.limit: found {question.sweep.limit}, which leaves no value on a machine "
            f"with {around.machine.hardware_threads} hardware threads"
        )
    seen: dict[str, Point] = {}
    for point in points:
        other = seen.setdefault(point.id, point)
        if other is not point:
            raise InputError(
                f'{question.file}: series: "{point.series}" at {point.x:g} measures what "{other.series}" at '
                f"{other.x:g} measures; expected different points, or a label for one of them"
            )
    return Experiment(question, tuple(points), f"{around.seed} {question.name}")


def _with_replicates(points: Sequence[Point], question: Question) -> Iterator[Point]:
    """The points of one scene, those that all others are compared with several times.

    Of many comparisons with one and the same each is told most by a share of the time if that one has the
    square root of the others' number of replicates (Dunnett, J. Am. Stat. Assoc. 50, 1955).
    """
    replicates = round(math.sqrt(max(1, len(points) - 1)))
    for point in points:
        yield point
        if point.x in question.series[point.series_number - 1].replicated:
            for number in range(2, replicates + 1):
                yield replace(point, replicate=number)


def _left_out(series: Series, scene: NamedScene, around: Surroundings) -> bool:
    """Whether the series does not run the scene or at the scale, or may be missing and its program is."""
    if (scene.series and series.name not in scene.series) or (series.paper_only and around.scale.divisor > 1):
        return True
    program = around.programs.get(series.program)
    return series.optional and (program is None or program.sha256 is None)


def _known(question: Question, number: int, series: Series, around: Surroundings) -> Series:
    """The series, once its program and its variant are known to exist."""
    key = f"{question.file}: series[{number}]"
    if series.is_foreign:
        return series
    if series.program not in around.programs:
        raise InputError(f"{key}.program: {not_one_of(series.program, around.programs)}")
    program = around.programs[series.program]
    if program.sha256 is None or series.variant in SHORT_NAMES:
        return series
    if series.variant not in variants(program):
        known = ["a name out of `carom list --names`", *SHORT_NAMES]
        like = nearest(str(series.variant), [*SHORT_NAMES, *variants(program)])
        raise InputError(f'{key}.variant: found "{series.variant}", expected one of {", ".join(known)}{like}')
    return series


def _values(question: Question, series: Series, around: Surroundings) -> Sequence[float | None]:
    sweep, threads = question.sweep, around.machine.hardware_threads
    if sweep.parameter is None:
        return [None]
    values = [value * threads if sweep.unit else value for value in around.scale.values(series)]
    return [value for value in values if sweep.limit is None or value <= sweep.limit * threads]


def _point(
    question: Question,
    number: int,
    series: Series,
    named: NamedScene,
    value: float | None,
    around: Surroundings,
) -> Point:
    parameter, scene, x = question.sweep.parameter, named.scene, 0 if value is None else value
    run: dict[str, Any] = {
        "threads": _threads(question.threads, around.machine),
        "substeps": question.substeps,
        "find_chunk": series.find_chunk,
        "resolve_chunk": series.resolve_chunk,
    }
    if parameter in run:
        x = run[parameter] = max(1, round(x))
    elif parameter in Scene.__dataclass_fields__ or parameter == "area_fraction":
        assert isinstance(scene, Scene)
        scene = _swept(question, scene, parameter, x)
    command, program = None, around.programs.get(series.program)
    if series.is_foreign:
        of_run = {"threads": run["threads"], "substeps": run["substeps"]}
        command, program = _command(question, number, series, (scene, of_run, x), around)
    assert program is not None
    openmp = around.site.binding.environment(run["threads"], around.machine, bound=question.bound)
    run |= {"scene": scene, "program": program, "command": command, "openmp": tuple(sorted(openmp.items()))}
    return point_of(question, (number, series), around, x, scene_name=named.name, **run)


def point_of(
    question: Question,
    numbered: tuple[int, Series],
    around: Surroundings,
    x: float,
    **run: Any,  # noqa: ANN401 - the fields of a point that only its run decides
) -> Point:
    """The point of a series, which has a number in its question, at a place of its sweep."""
    number, series = numbered
    simulated = around.scale.simulated(question)
    return Point(
        experiment=question.name, series=series.name, series_number=number, label=series.label, replicate=1,
        x_name=question.sweep.x_name, x=x, scale=around.scale.name, site=around.site.name,
        machine=around.machine, variant=series.variant, simulated=simulated, apart=series.apart,
        **{name: getattr(question, name) for name in _OF_QUESTION}, **run,
    )  # fmt: skip


_OF_QUESTION = (
    "kind", "figure", "claim", "margin", "error", "reference", "verb", "tolerance", "warm_up", "repetitions",
    "errors",
)  # fmt: skip
"""What all points of a question have in common with it."""


def _command(
    question: Question,
    number: int,
    series: Series,
    at: tuple[AnyScene, dict[str, Any], float],
    around: Surroundings,
) -> tuple[Command, Program]:
    """The series' command at a point, of which these are the scene, what else it says of the run, and x."""
    scene, of_run, x = at
    parameter = question.sweep.parameter
    beginning = scene.beginning if isinstance(scene, Scene) else scene
    values, checked = (
        _placeholders(one, {**of_run, "x": _plain(x), **({parameter: _plain(x)} if parameter else {})})
        for one in (scene, beginning)
    )
    if parameter == "steps":
        checked["x"] = checked["steps"]
    instrument = str(around.programs[GENERATOR].sha256)
    key = f"{question.file}: series[{number}]"
    place = Place(question.file.parent.absolute(), instrument, question.writes)
    return command_of(series, key, (values, checked), place)


def _placeholders(scene: AnyScene, others: dict[str, Any]) -> dict[str, object]:
    """What words may say of a point; the file of its scene is known only later."""
    if isinstance(scene, NoScene):
        return others
    of_scene = asdict(scene) if isinstance(scene, Scene) else {"case": scene.case}
    return {**others, SCENE: "", **of_scene}


def _plain(value: float) -> float | int:
    return int(value) if value == int(value) else value


def _swept(question: Question, scene: Scene, parameter: str, value: float) -> Scene:
    """The scene with one parameter changed; the side follows where the question keeps the area fraction."""
    if parameter == "area_fraction":
        return scene.with_area_fraction(value)
    whole = parameter in ("particles", "steps", "seed")
    changed: dict[str, Any] = {parameter: int(value) if whole else value}
    swept = replace(scene, **changed)
    if question.sweep.constant == "area_fraction":
        swept = swept.with_area_fraction(scene.area_fraction)
    if swept.max_velocity < swept.min_velocity:
        raise InputError(
            f"{question.file}: sweep.values: found {parameter} {value:g}, which makes max_velocity "
            f"{swept.max_velocity:g} less than min_velocity {swept.min_velocity:g}"
        )
    return swept


def _threads(threads: Threads, machine: Machine) -> int:
    """A number asked for is cut to what the machine has: only a sweep of threads goes beyond."""
    if isinstance(threads, int):
        return min(threads, machine.hardware_threads)
    return machine.cores if threads == "cores" else machine.hardware_threads
