"""Every mistake in a TOML file gets one line: file, key, what was found, what was expected, nearest name."""

from pathlib import Path

import pytest

from experiments.plan.question import load_question, load_questions
from experiments.tests.conftest import CHUNKS, ERRORS, PAIR, SCENE, Workplace
from support.errors import InputError

MISTAKES = {
    "unknown key": (
        CHUNKS.replace("steps = 10", "steps = 10\nradios = 5"),
        "scene.radios: unknown key; expected one of name, particles, side, radius, steps, min_velocity, "
        'max_velocity, seed, placement, isotropic, paper_only, series, case; did you mean "radius"?',
    ),
    "misspelt required key": (CHUNKS.replace("radius", "radios"), 'did you mean "radius"?'),
    "missing key": (CHUNKS.replace("radius = 5\n", ""), "scene.radius: missing; expected a number above 0"),
    "wrong type": (
        CHUNKS.replace("particles = 100", 'particles = "many"'),
        'scene.particles: found "many", expected a whole number of at least 1',
    ),
    "too many discs": (
        CHUNKS.replace("particles = 100", "particles = 1000000000000"),
        "expected a whole number of at least 1 and at most 100000000",
    ),
    "a box smaller than a disc": (
        PAIR.replace("side = 1000", "side = 3"),
        "scene.side: found 3, expected at least a disc's diameter, ",
    ),
    "two series of one name": (
        PAIR.replace('name = "nine"', 'name = "four"'),
        'series[2].name: found "four" twice, expected each once',
    ),
    "unknown figure": (
        CHUNKS.replace('"schedule"', '"shedule"'),
        'figure: found "shedule", expected one of scaling, trend, comparison, schedule, machine, phases, '
        "control, speed_against_error, hard_cases, ladder, limits, ways, pauses; "
        'did you mean "schedule"?',
    ),
    "unknown claim": (PAIR.replace("four_boxes", "for_boxes"), 'did you mean "four_boxes"?'),
    "name that is a number": (
        PAIR.replace('name = "four"', 'name = "1e3"'),
        'series[1].name: found "1e3", expected a name that is no number',
    ),
    "unknown parameter": (
        CHUNKS.replace('"find_chunk"', '"find_chunks"'),
        'sweep.parameter: found "find_chunks", expected one of threads, find_chunk, resolve_chunk, '
        "substeps, particles, side, radius, steps, min_velocity, max_velocity, area_fraction, seed; did you "
        'mean "find_chunk"?',
    ),
    "value twice": (
        CHUNKS.replace("[1, 2, 3]", "[1, 2, 2]"),
        "sweep.values: found [1, 2, 2], expected a list that is not empty, each value once",
    ),
    "bad value": (
        CHUNKS.replace("[1, 2, 3]", "[1, -2]"),
        "sweep.values[2]: found -2, expected a number above 0",
    ),
    "chunk that is no whole number": (
        CHUNKS.replace("[1, 2, 3]", "[1.5, 2]"),
        "series[1].values: found 1.5, expected whole numbers",
    ),
    "no series": (PAIR.split("[[series]]")[0], "series: missing; expected a list that is not empty"),
    "bad threads": (
        PAIR.replace("[scene]", 'threads = "all"\n[scene]', 1),
        'threads: found "all", expected a whole number of at least 1, "cores" or "hardware_threads"',
    ),
    "blocks the wrong way round": (
        PAIR.replace("wanted = 2", "wanted = 1"),
        "blocks.wanted: found 1, expected at least 2",
    ),
    "values without a sweep": (
        PAIR.replace('variant = "nine"', 'variant = "nine"\nvalues = [1]'),
        "series[2].values: found values, expected none without a sweep",
    ),
    "sweep without values": (
        CHUNKS.replace("values = [1, 2, 3]\nquick_values = [1, 2]\n", ""),
        "series[1].values: missing; expected the values of find_chunk",
    ),
    "swept and fixed": (
        CHUNKS.replace('variant = "published"', 'variant = "published"\nfind_chunk = 3'),
        "series[1].find_chunk: found beside a sweep of it, expected only one of the two",
    ),
    "limit of something else": (
        CHUNKS.replace("[1, 2, 3]", "[1, 2, 3]\nlimit = 2"),
        "sweep.limit: found for find_chunk, expected for threads only",
    ),
    "sizes without quick ones": (
        CHUNKS.replace('"find_chunk"', '"particles"').replace("quick_values = [1, 2]\n", ""),
        "series[1].quick_values: missing; expected the values of particles at quick scale",
    ),
    "isotropic by a number": (
        ERRORS.replace("isotropic = true", "isotropic = 1"),
        "scenes[1].isotropic: found 1, expected true or false",
    ),
    "misspelt case": (ERRORS.replace('case = "cradle"', 'cases = "cradle"'), 'did you mean "case"?'),
    "case with a size": (
        ERRORS.replace('case = "cradle"', 'case = "cradle"\nparticles = 5'),
        "scenes[2].particles: unknown key; expected one of case, name, paper_only, series",
    ),
    "scene of a series that there is not": (
        ERRORS.replace('case = "cradle"', 'case = "cradle"\nseries = ["nien"]'),
        'scenes[2].series[1]: found "nien", expected one of four, nine; did you mean "nine"?',
    ),
    "scene without a name": (
        ERRORS.replace('name = "dilute"\n', ""),
        "scenes[1].name: missing; expected a text, which tells the scenes apart",
    ),
    "two scenes of one name": (
        ERRORS.replace('"dilute"', '"cradle"'),
        'scenes[2].name: found "cradle" twice, expected each once',
    ),
    "one scene and several": (
        ERRORS.replace("[sweep]", f"{SCENE}[sweep]"),
        "scene: found beside scenes, expected only one of the two",
    ),
    "velocities of the second scene": (
        ERRORS.replace(
            'case = "cradle"', 'name = "other"' + SCENE.replace("[scene]", "").replace("= 2", "= 0")
        ).replace('[sweep]\nparameter = "substeps"\nvalues = [1, 2]\n', ""),
        "scenes[2].max_velocity: found 0, expected at least 1",
    ),
    "size of a hard case": (
        ERRORS.replace('"substeps"', '"radius"'),
        "sweep.parameter: found radius over the hard case cradle, which is as it is; expected one of threads",
    ),
    "substeps swept and fixed": (
        f"substeps = 2\n{ERRORS}",
        "substeps: found beside a sweep of it, expected only one of the two",
    ),
    "neither kind nor figure": (
        CHUNKS.replace('figure = "schedule"\n', ""),
        "kind: missing; expected one of comparison, control, trend",
    ),
    "figure that cannot draw the kind": (
        f'kind = "hard_cases"\n{CHUNKS}',
        "figure: found schedule for kind hard_cases, expected one of hard_cases",
    ),
    "kind of several scenes in a figure of one": (
        ERRORS.replace('figure = "speed_against_error"', 'kind = "ladder"\nfigure = "comparison"'),
        "scenes: found several for figure comparison, expected one, or one of the kinds",
    ),
    "figure of errors without errors": (
        ERRORS.replace("errors = true\n", ""),
        "errors: missing; expected true for kind speed_against_error",
    ),
    "speed against error over threads": (
        ERRORS.replace('"substeps"', '"threads"'),
        "sweep.parameter: expected substeps for kind speed_against_error",
    ),
    "scenes that no figure tells apart": (
        ERRORS.replace("speed_against_error", "trend"),
        "scenes: found several for kind trend, expected one, or one of the kinds hard_cases, ladder",
    ),
    "errors of a profile": (
        f'verb = "profile"\n{ERRORS}',
        "errors: found for verb profile, expected for bench only",
    ),
    "claim with another tolerance": (
        PAIR.replace('tolerance = "published"\n', ""),
        'tolerance: found relative for a published claim, expected "published", or a tolerance_reason',
    ),
    "reason for the published tolerance": (
        PAIR.replace('tolerance = "published"', 'tolerance = "published"\ntolerance_reason = "none"'),
        "tolerance_reason: found beside the published tolerance, which needs none",
    ),
    "half a seed": (
        CHUNKS.replace('"find_chunk"', '"seed"').replace("[1, 2, 3]", "[1, 2.5]"),
        "series[1].values: found 2.5, expected whole numbers",
    ),
    "margin of all": (f"margin = 1\n{PAIR}", "margin: found 1, expected a number above 0 and below 1"),
    "reference that there is not": (
        f"reference = 'nin'\n{PAIR}",
        'reference: found "nin", expected one of four, nine; did you mean "nine"?',
    ),
    "counts of what is timed": (
        PAIR.replace("[scene]", "simulated = 3\n\n[scene]", 1),
        "simulated: found for verb bench, expected for profile only",
    ),
    "not TOML": ("title = \n", "is not valid TOML: Invalid value (at line 1, column 9)"),
}


@pytest.mark.parametrize(("text", "expected"), MISTAKES.values(), ids=MISTAKES.keys())
def test_one_line_for_a_mistake_in_a_question(tmp_path: Path, text: str, expected: str) -> None:
    path = tmp_path / "mistaken.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_question(path)
    line = str(error.value)
    assert line.startswith(f"{path}: ")
    assert expected in line
    assert "\n" not in line


def test_a_claim_may_state_why_it_has_another_tolerance(tmp_path: Path) -> None:
    path = tmp_path / "sparse.toml"
    reason = 'tolerance_reason = "its scene does not end under the published one"'
    path.write_text(PAIR.replace('tolerance = "published"', reason), encoding="utf-8")
    assert load_question(path).tolerance == "relative"


def test_unreadable_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.toml: cannot be read: No such file or directory"):
        load_question(tmp_path / "none.toml")
    (tmp_path / "latin.toml").write_bytes(b'title = "caf\xe9"')
    with pytest.raises(InputError, match=r"latin\.toml: is not UTF-8 text at byte 12"):
        load_question(tmp_path / "latin.toml")


def test_the_control_is_part_of_every_choice(workplace: Workplace) -> None:
    folder = workplace.root / "questions"
    assert [one.name for one in load_questions(folder, ["pair"])] == ["pair", "control"]
    assert [one.name for one in load_questions(folder, ["control"])] == ["control"]
    assert [one.name for one in load_questions(folder)] == ["chunks", "control", "pair"]


def test_a_folder_without_questions_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"questions: found .*/absent, expected a folder that is there"):
        load_questions(tmp_path / "absent")
    with pytest.raises(InputError, match="has no question in it"):
        load_questions(tmp_path)
