"""From questions to points: what would be measured, on which machine, at which scale."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from experiments.plan.blocks import orders
from experiments.plan.command import SCENE, Command, Place, command_of
from experiments.plan.point import PROCESS, Point
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
    curves = [Curve(question, *numbered, around) for numbered in enumerate(question.series, start=1)]
    points = [
        point
        for scene in around.scale.scenes(question)
        for point in _with_replicates(
            [
                curve.point(scene, value)
                for curve in curves
                if not curve.is_left_out(scene)
                for value in curve.values()
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


_OF_QUESTION = (
    "kind", "figure", "claim", "margin", "error", "reference", "verb", "tolerance", "warm_up", "repetitions",
    "errors",
)  # fmt: skip
"""What all points of a question have in common with it."""


@dataclass(frozen=True)
class Curve:
    """A series, the `number` of it in its question, and where it is measured."""

    question: Question
    number: int
    series: Series
    around: Surroundings

    @property
    def key(self) -> str:
        """What a line about it begins with."""
        return f"{self.question.file}: series[{self.number}]"

    def is_left_out(self, scene: NamedScene) -> bool:
        """Whether it does not run the scene or at the scale, or may be missing and its program is."""
        series, around = self.series, self.around
        is_for_others = bool(scene.series) and series.name not in scene.series
        if is_for_others or (series.paper_only and around.scale.divisor > 1):
            return True
        program = around.programs.get(series.program)
        return series.optional and (program is None or program.sha256 is None)

    def values(self) -> Sequence[float | None]:
        """What it is measured at. Raises InputError where its program or its variant is not known."""
        self._require_known()
        sweep, threads = self.question.sweep, self.around.machine.hardware_threads
        if sweep.parameter is None:
            return [None]
        values = [value * threads if sweep.unit else value for value in self.around.scale.values(self.series)]
        return [value for value in values if sweep.limit is None or value <= sweep.limit * threads]

    def _require_known(self) -> None:
        series, programs = self.series, self.around.programs
        if series.is_foreign:
            return
        if series.program not in programs:
            raise InputError(f"{self.key}.program: {not_one_of(series.program, programs)}")
        program = programs[series.program]
        if program.library and self.question.verb == PROCESS:
            told = "a program that runs another's variants, expected that one where whole processes are timed"
            raise InputError(f'{self.key}.program: found "{series.program}", {told}')
        if program.sha256 is None or series.variant in (*SHORT_NAMES, *variants(program)):
            return
        known = ", ".join(["a name out of `carom list --names`", *SHORT_NAMES])
        like = nearest(str(series.variant), [*SHORT_NAMES, *variants(program)])
        raise InputError(f'{self.key}.variant: found "{series.variant}", expected one of {known}{like}')

    def point(self, named: NamedScene, value: float | None) -> Point:
        """The point on a scene, at a value of the sweep."""
        question, series, around = self.question, self.series, self.around
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
            command, program = self._command(scene, of_run, x)
        assert program is not None
        openmp = around.site.binding.environment(run["threads"], around.machine, bound=question.bound)
        run |= {"scene": scene, "program": program, "command": command}
        return self.point_at(x, scene_name=named.name, openmp=tuple(sorted(openmp.items())), **run)

    def point_at(self, x: float, **run: Any) -> Point:  # noqa: ANN401 - what only its run decides
        """The point at a place of the sweep, with the fields that only its run decides."""
        question, series, around = self.question, self.series, self.around
        return Point(
            experiment=question.name, series=series.name, series_number=self.number, label=series.label,
            replicate=1, x_name=question.sweep.x_name, x=x, scale=around.scale.name, site=around.site.name,
            machine=around.machine, variant=series.variant, apart=series.apart,
            simulated=around.scale.simulated(question),
            **{name: getattr(question, name) for name in _OF_QUESTION}, **run,
        )  # fmt: skip

    def _command(self, scene: AnyScene, of_run: dict[str, Any], x: float) -> tuple[Command, Program]:
        """The series' command on a scene, with what else it says of the run, and x."""
        parameter = self.question.sweep.parameter
        beginning = scene.beginning if isinstance(scene, Scene) else scene
        values, checked = (
            _placeholders(one, {**of_run, "x": _plain(x), **({parameter: _plain(x)} if parameter else {})})
            for one in (scene, beginning)
        )
        if parameter == "steps":
            checked["x"] = checked["steps"]
        instrument = str(self.around.programs[GENERATOR].sha256)
        place = Place(self.question.file.parent.absolute(), instrument, self.question.writes)
        return command_of(self.series, self.key, (values, checked), place)


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
