"""From a question to points: ids stand for content, and for nothing else."""

import re
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

from experiments.plan.command import Command
from experiments.plan.plan import Surroundings, plan
from experiments.plan.point import Point
from experiments.plan.program import Program, find_programs
from experiments.plan.question import load_question
from experiments.plan.scale import SCALES
from experiments.plan.scenes import HardCase, Scene, SceneFile
from experiments.plan.site import Machine, load_site
from experiments.run.verify import note_of
from experiments.tests.conftest import CHUNKS, ERRORS, PAIR, Workplace, generated
from support.errors import InputError

SHOWN = {
    "experiment", "kind", "figure", "claim", "margin", "error", "reference", "series", "series_number",
    "scene_name", "x_name", "x", "scale",
    *("program.path", "program.files", "program.hashes", "program.absent", "program.written"),
    "program.library",
    *("command.folder", "command.refused", "command.checker", "command.another"),
}  # fmt: skip
"""What only says where something is, or where in a figure the point stands, and so is no part of its id."""


def others(value: object, name: str = "") -> Iterator[tuple[str, Any]]:
    """The value with each thing in it once another one, and the name of that."""
    match value:
        case Program() | Scene() | Machine() | Command() | Point():
            for one in fields(value):
                for inner, other in others(getattr(value, one.name), f"{name}.{one.name}"):
                    yield inner, replace(value, **{one.name: other})
        case bool():
            yield name[1:], not value
        case int() | float():
            yield name[1:], value + 1
        case tuple() | frozenset():
            yield name[1:], (*value, "x")
        case _:
            yield name[1:], f"{value}x"


def test_whatever_changes_the_measurement_changes_the_id_and_nothing_else_does(workplace: Workplace) -> None:
    question = load_question(workplace.root / "questions" / "chunks.toml")
    point = replace(
        plan(question, surroundings(workplace)).points[0], command=Command(("sort",), Path("/"), "0" * 64)
    )
    changed = dict(others(point))
    assert {name for name, other in changed.items() if other.id == point.id} == SHOWN
    assert {"label", "scene.isotropic", "machine.cores", "command.benchmark"} < changed.keys()
    cases = {replace(point, scene=HardCase(case)).id for case in ("cradle", "corner")}
    assert len(cases | {point.id}) == 3
    assert all(re.fullmatch("p[0-9a-f]{16}", one) for one in cases), "no id reads as a number"


def surroundings(workplace: Workplace, scale: str = "paper") -> Surroundings:
    site = load_site("local")
    programs = find_programs(site, workplace.root / "build")
    return Surroundings(site, Machine("test", 2, 2), programs, SCALES[scale])


def test_quick_values_are_taken_at_quick_scale(workplace: Workplace) -> None:
    question = load_question(workplace.root / "questions" / "chunks.toml")
    points = plan(question, surroundings(workplace, "quick")).points
    assert [point.find_chunk for point in points] == [1, 2]
    assert {generated(point).particles for point in points} == {10}


def test_what_all_others_are_compared_with_is_measured_several_times(workplace: Workplace) -> None:
    values = ", ".join(map(str, range(1, 18)))
    text = CHUNKS.replace("values = [1, 2, 3]\n", f"values = [{values}]\n")
    alone = plan(load_question(workplace.question("alone", text)), surroundings(workplace)).points
    text = text.replace('"published"', '"published"\nreplicated = [2]')
    question = load_question(workplace.question("alone", text))
    points = plan(question, surroundings(workplace)).points
    replicates = [point for point in points if point.x == 2]
    assert [point.tags["replicate"] for point in replicates] == [1, 2, 3, 4]
    assert {point.tags.get("label") for point in replicates} == {None}
    assert len({point.id for point in points}) == len(points) == 17 + 3
    assert {point.id for point in alone} <= {point.id for point in points}
    few = plan(question, surroundings(workplace, "quick")).points
    assert [point.x for point in few] == [1, 2]


def test_a_sweep_of_seeds_makes_a_scene_of_each(workplace: Workplace) -> None:
    text = CHUNKS.replace('"find_chunk"', '"seed"')
    points = plan(load_question(workplace.question("seeds", text)), surroundings(workplace)).points
    assert [generated(point).seed for point in points] == [point.x for point in points] == [1, 2, 3]
    assert len({point.scene.name for point in points}) == 3


def test_an_optional_series_is_left_out_where_its_program_is_not_built(workplace: Workplace) -> None:
    other = 'variant = "published"\nprogram = "clang"'
    text = PAIR.replace('variant = "nine"', f"{other}\noptional = true")
    question = load_question(workplace.question("optional", text))
    assert [one.series for one in plan(question, surroundings(workplace)).points] == ["four"]
    asked = load_question(workplace.question("asked", PAIR.replace('variant = "nine"', other)))
    assert [one.series for one in plan(asked, surroundings(workplace)).points] == ["four", "nine"]
    program = find_programs(load_site("local"), workplace.root / "build")["gcc"]
    built = surroundings(workplace)
    there = replace(
        built, programs={**built.programs, "clang": replace(program, name="clang", sha256="1" * 64)}
    )
    assert [one.program.name for one in plan(question, there).points] == ["gcc", "clang"]


def test_a_variant_is_checked_with_the_tolerance_that_it_is_timed_with(workplace: Workplace) -> None:
    (point, _) = plan(
        load_question(workplace.root / "questions" / "pair.toml"), surroundings(workplace)
    ).points
    scene = SceneFile(Path("s.in"), "0" * 64)
    assert note_of(point, scene) != note_of(replace(point, tolerance="relative"), scene)


def test_what_is_not_bound_is_bound_at_no_number_of_threads(workplace: Workplace) -> None:
    text = CHUNKS.replace('"find_chunk"', '"threads"')
    path = workplace.question(
        "unbound", text.replace('figure = "schedule"', 'figure = "scaling"\nbound = false')
    )
    free = plan(load_question(path), surroundings(workplace)).points
    kept = plan(load_question(workplace.question("bound", text)), surroundings(workplace)).points
    assert {dict(point.openmp)["OMP_PROC_BIND"] for point in free} == {"false"}
    assert [dict(point.openmp)["OMP_PROC_BIND"] for point in kept] == ["close", "close", "false"]
    assert free[0].id != kept[0].id


def test_every_variant_meets_every_scene_at_every_value(workplace: Workplace) -> None:
    points = plan(load_question(workplace.question("errors", ERRORS)), surroundings(workplace)).points
    places = [(point.scene_name, point.series, point.x, point.substeps) for point in points]
    assert places == [
        (scene, series, substeps, substeps)
        for scene in ("dilute", "cradle")
        for series in ("four", "nine")
        for substeps in (1, 2)
    ]


@pytest.mark.parametrize(("scale", "dilute"), [("paper", "100 1000 5 10 1 2"), ("quick", "10 316 5 10 1 2")])
def test_a_hard_case_has_one_size(workplace: Workplace, scale: str, dilute: str) -> None:
    question = load_question(workplace.question("errors", ERRORS))
    points = plan(question, surroundings(workplace, scale)).points
    words = {" ".join(point.scene.arguments) for point in points}
    assert words == {f"{dilute} --seed 1 --placement lattice --isotropic", "--case cradle"}


@pytest.mark.parametrize(
    ("line", "paper", "quick"),
    [("", "fnfn", "fnfn"), ("paper_only = true", "fnfn", "fn"), ('series = ["nine"]', "fnn", "fnn")],
)
def test_a_scene_may_be_for_some_series_or_for_one_scale_alone(
    workplace: Workplace, line: str, paper: str, quick: str
) -> None:
    question = load_question(workplace.question("errors", ERRORS.replace('"cradle"', f'"cradle"\n{line}')))
    planned = (plan(question, surroundings(workplace, scale)).points for scale in ("paper", "quick"))
    of_each = ["".join(one.series[0] for one in points if one.x == 1) for points in planned]
    assert of_each == [paper, quick]


def test_what_is_judged_travels_as_tags(workplace: Workplace) -> None:
    said = 'margin = 0.05\nerror = 0.01\nreference = "nine"\n'
    usual, own = (
        plan(load_question(workplace.question("pair", text)), surroundings(workplace)).points
        for text in (PAIR, said + PAIR)
    )
    told = [[point.tags.get(key) for key in ("margin", "error", "reference")] for point in (usual[0], own[0])]
    assert told == [[0.02, 0.05, None], [0.05, 0.01, "nine"]]


MISTAKES = {
    "variant": (
        PAIR.replace('variant = "nine"', 'variant = "nien"'),
        'series[2].variant: found "nien", expected one of a name out of `carom list --names`, auto, '
        'fastest; did you mean "nine"?',
    ),
    "program": (
        PAIR.replace('variant = "nine"', 'variant = "nine"\nprogram = "clan"'),
        'series[2].program: found "clan", expected one of gcc-libomp, clang-in-gcc, gcc, clang; did',
    ),
    "whole processes of a library": (
        'verb = "process"\n' + PAIR.replace('variant = "nine"', 'variant = "nine"\nprogram = "clang-in-gcc"'),
        'series[2].program: found "clang-in-gcc", a program that runs another',
    ),
    "the same twice": (
        PAIR.replace('variant = "nine"', 'variant = "published"'),
        'series: "nine" at 0 measures what "four" at 0 measures',
    ),
    "a replicate of nothing": (
        CHUNKS.replace('"published"', '"published"\nreplicated = [4]'),
        "series[1].replicated: found 4, expected one of its values",
    ),
    "a replicate of nothing at quick scale": (
        CHUNKS.replace('"published"', '"published"\nreplicated = [3]'),
        "series[1].replicated: found 3, expected one of its quick_values",
    ),
    "replicates in a figure that would take them for samples": (
        CHUNKS.replace('"schedule"', '"trend"').replace('"published"', '"published"\nreplicated = [1]'),
        "series[1].replicated: found for figure trend, expected for schedule only",
    ),
    "replicates of a share of the machine": (
        CHUNKS.replace('"find_chunk"', '"threads"\nunit = "hardware_threads"').replace(
            '"published"', '"published"\nreplicated = [1]'
        ),
        "series[1].replicated: found beside sweep.unit, expected only one of the two",
    ),
    "nothing left": (
        CHUNKS.replace('"find_chunk"', '"threads"').replace("[1, 2, 3]", "[9]\nlimit = 1"),
        "sweep.limit: found 1, which leaves no value on a machine with 2 hardware threads",
    ),
    "impossible velocities": (
        CHUNKS.replace('"find_chunk"', '"min_velocity"'),
        "sweep.values: found min_velocity 3, which makes max_velocity 2 less than min_velocity 3",
    ),
}


@pytest.mark.parametrize(("text", "expected"), MISTAKES.values(), ids=MISTAKES.keys())
def test_one_line_for_a_plan_that_cannot_be(workplace: Workplace, text: str, expected: str) -> None:
    path = workplace.question("mistaken", text)
    with pytest.raises(InputError) as error:
        plan(load_question(path), surroundings(workplace))
    assert str(error.value).startswith(f"{path}: ")
    assert expected in str(error.value)
