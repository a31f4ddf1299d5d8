"""The questions and sites that come with the project: valid, complete, and true to the published study."""

from collections.abc import Mapping
from pathlib import Path

import pytest

from experiments.plan.claims import published_claims
from experiments.plan.plan import Experiment, Surroundings, plan
from experiments.plan.program import BESIDE, Program
from experiments.plan.question import FOLDER, load_question, load_questions
from experiments.plan.scale import SCALES
from experiments.plan.site import Machine, load_site
from experiments.tests.conftest import generated

QUESTIONS = sorted(FOLDER.glob("*.toml"))
NODE = Machine("a node of the published study", cores=10, hardware_threads=20)

THREADS_OF_CLAIMS = {
    "particles": 20, "grid_length": 20, "radius": 20, "steps": 20, "min_velocity": 20, "max_velocity": 20,
    "machine": 16, "neighbourhood": 20, "self_contained_checkered": 20, "self_contained_track": 20,
    "self_contained_repeat": 20, "schedule_find": 8, "schedule_resolve": 8, "schedule_resolve_row": 8,
    "row": 8, "reverse": 20, "compiler": 20, "phases": 20,
}  # fmt: skip
PUBLISHED_THREADS = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 13, 15, 17, 19, 20, 21, 25, 30, 35]


def around(scale: str, machine: Machine = NODE) -> Surroundings:
    """A machine on which nothing is built: variants are not looked up."""
    names = ("gcc", "clang", *BESIDE)
    programs: Mapping[str, Program] = {name: Program(name, Path(name), None) for name in names}
    return Surroundings(load_site("local"), machine, programs, SCALES[scale])


def planned(name: str, scale: str = "paper", machine: Machine = NODE) -> Experiment:
    return plan(load_question(FOLDER / f"{name}.toml"), around(scale, machine))


@pytest.mark.parametrize("path", QUESTIONS, ids=lambda path: path.stem)
@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("hardware_threads", [1, 2, 24])
def test_every_question_has_points_everywhere(path: Path, scale: str, hardware_threads: int) -> None:
    machine = Machine("any", max(1, hardware_threads // 2), hardware_threads)
    experiment = plan(load_question(path), around(scale, machine))
    assert len(experiment.points) >= 1
    assert experiment.name == path.stem


def test_every_question_of_the_study_is_there() -> None:
    assert {path.stem for path in QUESTIONS} == {
        "threads", "particles", "grid_length", "radius", "steps", "min_velocity", "max_velocity", "machine",
        "neighbourhood", "self_contained_checkered", "self_contained_track", "self_contained_repeat",
        "schedule_find", "schedule_resolve", "schedule_resolve_row", "row", "row_over_size", "reverse",
        "sequential_orders",
        "compiler", "phases", "phases_of_variants", "ladder", "rungs", "limits", "density", "small_scenes",
        "oversubscription", "control", "openmp_runtime", "speed_against_error", "hard_cases", "ways",
        "ways_of_processes",
    }  # fmt: skip


def test_every_published_claim_has_a_question() -> None:
    assert {one.claim for one in load_questions(FOLDER)} - {None} == {*published_claims()}


def test_threads_are_the_published_ones_cut_to_twice_the_machine() -> None:
    on_node = [point.threads for point in planned("threads").points]
    assert on_node == PUBLISHED_THREADS
    here = [point.threads for point in planned("threads", machine=Machine("small", 2, 2)).points]
    assert here == [1, 2, 3, 4]


@pytest.mark.parametrize("hardware_threads", [2, 8, 40])
def test_a_claim_is_tested_on_the_published_number_of_threads_or_on_all_there_are(
    hardware_threads: int,
) -> None:
    questions = {one.name for one in load_questions(FOLDER) if one.claim}
    assert questions == {*THREADS_OF_CLAIMS, "threads"}
    machine = Machine("any", max(1, hardware_threads // 2), hardware_threads)
    for name, threads in THREADS_OF_CLAIMS.items():
        points = planned(name, machine=machine).points
        assert {point.threads for point in points} == {min(threads, hardware_threads)}


def test_no_binding_changes_within_a_sweep_of_threads() -> None:
    for name in ("threads", "oversubscription"):
        for machine in (Machine("plain", 4, 4), Machine("two threads a core", 4, 8)):
            points = planned(name, machine=machine).points
            assert len({dict(point.openmp)["OMP_PROC_BIND"] for point in points}) == 1


def test_while_one_loop_s_schedule_is_swept_the_other_has_the_published_chunk() -> None:
    for name, chunk in (("schedule_find", "resolve_chunk"), ("schedule_resolve", "find_chunk"),
                        ("schedule_resolve_row", "find_chunk")):  # fmt: skip
        published = {"resolve_chunk": 5, "find_chunk": 4}[chunk]
        assert {getattr(point, chunk) for point in planned(name).points} == {published}


@pytest.mark.parametrize(
    ("name", "choice"),
    [
        ("schedule_find", ("guided", 4)),
        ("schedule_resolve", ("guided", 5)),
        ("schedule_resolve_row", ("dynamic", 1)),
    ],
)
@pytest.mark.parametrize("scale", ["paper", "quick"])
def test_the_schedule_to_choose_has_replicates(name: str, choice: tuple[str, float], scale: str) -> None:
    points = [(point.series, point.x) for point in planned(name, scale).points]
    repeated = {point: points.count(point) for point in points if points.count(point) > 1}
    assert repeated == {choice: 4 if scale == "paper" else points.count(choice)}


@pytest.mark.parametrize(("scale", "asked"), [("paper", range(81, 201)), ("quick", range(81, 161))])
def test_a_count_is_taken_on_seeds_that_did_not_tell_their_number(scale: str, asked: range) -> None:
    points = planned("reverse", scale).points
    seeds = {
        point.series: [generated(one).seed for one in points if one.series == point.series]
        for point in points
    }
    assert seeds == {"reverse": [*asked], "forward": [*asked]}


@pytest.mark.parametrize("name", ["min_velocity", "max_velocity"])
def test_the_quick_velocities_have_the_published_least_time_and_the_end_before_the_last(name: str) -> None:
    assert {5, 45, 50} <= {point.x for point in planned(name, "quick").points}


def test_early_resolves_are_measured_beside_the_profile_of_the_published_variant() -> None:
    assert {"published", "self_contained_off"} <= {point.variant for point in planned("phases").points}


@pytest.mark.parametrize(
    ("name", "steps", "published"),
    [
        ("threads", 25, ("100000", "10000", "16", "2", "5")),
        ("grid_length", 12, ("100000", "100000", "15", "2", "5")),
        ("radius", 50, ("10000", "10000", "50", "2", "5")),
        ("max_velocity", 12, ("100000", "10000", "15", "1", "50")),
    ],
)
def test_scenes_are_the_published_ones_for_some_of_their_steps(
    name: str, steps: int, published: tuple[str, ...]
) -> None:
    arguments = planned(name).points[-1].scene.arguments
    assert arguments[:3] + arguments[4:6] == published
    assert arguments[3] == str(steps)


def test_quick_scenes_are_a_tenth_of_the_size() -> None:
    quick, paper = (generated(planned("neighbourhood", scale).points[0]) for scale in ("quick", "paper"))
    assert quick.particles * 10 == paper.particles
    assert quick.area_fraction == pytest.approx(paper.area_fraction, rel=1e-3)
    assert (quick.radius, quick.steps) == (paper.radius, paper.steps)


def test_density_runs_from_a_tenth_to_nine_tenths() -> None:
    points = planned("density").points
    assert [point.x for point in points] == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]
    for point in points:
        assert generated(point).area_fraction == pytest.approx(point.x, rel=1e-3)


def test_the_ladder_leads_from_the_published_best_over_different_variants_on_four_scenes() -> None:
    series = load_question(FOLDER / "ladder.toml").series
    assert series[0].variant == "published"
    assert len({one.variant for one in series}) == len(series)
    points = planned("ladder").points
    assert [point.series_number for point in points] == [*range(1, len(series) + 1)] * 4
    fractions = list(dict.fromkeys(round(generated(point).area_fraction, 2) for point in points))
    assert fractions == [0.8, 0.91, 0.88]


def test_what_is_compared_with_the_limits_and_with_empty_space_is_the_ladder_s_last_rung() -> None:
    fastest = load_question(FOLDER / "ladder.toml").series[-1].variant
    for name in ("limits", "grid_length"):
        assert [one.variant for one in load_question(FOLDER / f"{name}.toml").series] == [
            "published",
            fastest,
        ]


def test_row_keeps_the_area_fraction() -> None:
    fractions = [generated(point).area_fraction for point in planned("row_over_size").points]
    assert fractions == pytest.approx([fractions[0]] * len(fractions), rel=5e-3)


def test_speed_against_error_goes_from_dilute_to_dense_without_overlap() -> None:
    points = planned("speed_against_error").points
    fractions = {point.scene_name: generated(point).area_fraction for point in points}
    assert fractions == {
        "dilute": pytest.approx(0.1, rel=1e-3),
        "medium": pytest.approx(0.4, rel=1e-3),
        "dense": pytest.approx(0.65, rel=1e-3),
    }
    assert {generated(point).placement for point in points} == {"random", "lattice"}
    assert {point.substeps for point in points} == {1, 2, 4, 8, 16, 32, 64}
    assert all(point.errors for point in points)


def test_the_local_site_is_valid_and_binds_no_oversubscribed_run() -> None:
    site = load_site("local")
    machine = Machine("small", cores=2, hardware_threads=4)
    assert site.binding.environment(2, machine)["OMP_PROC_BIND"] == "close"
    assert site.binding.environment(3, machine)["OMP_PROC_BIND"] == "false"
    assert site.binding.environment(2, machine)["OMP_DYNAMIC"] == "false"
    assert site.binding.environment(2, machine)["KMP_BLOCKTIME"] == "8"
    assert site.binding.environment(3, machine)["KMP_BLOCKTIME"] == "0"
