"""Somebody else's programs as series: what a file may say of them, and what each mistake is answered with."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.plan.command import placed
from experiments.plan.point import Point
from experiments.plan.question import load_question
from experiments.plan.scenes import CHECKED_STEPS
from experiments.run.study import Study
from experiments.tests.conftest import SCENE, Workplace
from experiments.tests.foreign import BLOCKS, script
from support.errors import InputError

HEAD = 'title = "Programs"\nfigure = "comparison"\n'
SORT = '[[series]]\nname = "sort"\ncommand = ["sort", "--parallel={threads}", "--output=/dev/null"]\n'


def points(place: Workplace, text: str) -> list[Point]:
    place.question("asked", text)
    [experiment] = Study(place.settings).experiments
    return list(experiment.points)


def refusal(place: Workplace, text: str) -> str:
    with pytest.raises(InputError) as refused:
        points(place, text)
    assert "\n" not in str(refused.value)
    return str(refused.value)


def words(point: Point) -> tuple[str, ...]:
    assert point.command is not None
    return placed(point.command.words)


def test_a_question_needs_no_scene_and_fills_in_what_it_sweeps(empty_workplace: Workplace) -> None:
    text = f'{HEAD}threads = 1\n[sweep]\nparameter = "lines"\nvalues = [10, 2.5]\n'
    series = '[[series]]\nname = "a"\ncommand = ["sort", "{lines}", "{x} {{}}", "{threads}"]\n'
    found = points(empty_workplace, f"{text}{series}{BLOCKS}")
    assert [words(point)[1:] for point in found] == [("10", "10 {}", "1"), ("2.5", "2.5 {}", "1")]
    assert {point.verb for point in found} == {"process"}
    assert all(Path(words(point)[0]).name == "sort" for point in found)


def test_what_is_usual_leaves_the_id_as_it_was(empty_workplace: Workplace) -> None:
    for line in ("exit_codes = [0]\n", "fresh_folder = false\n"):
        [plain], [said] = (points(empty_workplace, HEAD + SORT + one + BLOCKS) for one in ("", line))
        assert plain.id == said.id


def test_of_a_scene_everything_can_be_said(empty_workplace: Workplace) -> None:
    script(empty_workplace, "mine", "exit 0")
    command = 'command = ["./mine", "{scene}", "{particles}", "{side}", "{radius}", "{steps}", "{seed}"]'
    text = f'{HEAD}{SCENE}[[series]]\nname = "mine"\n{command}\n{BLOCKS}'
    [point] = points(empty_workplace, text)
    assert words(point)[1:] == ("{scene}", "100", "1000", "5", "10", "1")
    assert point.process_words(Path("/a b/{x}.in"), Path("out"))[1] == "/a b/{x}.in"


def test_braces_of_a_folder_are_what_they_are(empty_workplace: Workplace) -> None:
    folder = empty_workplace.root / "{x} {scene}"
    folder.mkdir()
    lines = '[[series]]\nname = "a"\ncommand = ["echo", "{folder}", "{scene}"]\n'
    (folder / "asked.toml").write_text(HEAD + SCENE + lines + BLOCKS, encoding="utf-8")
    [experiment] = Study(replace(empty_workplace.settings, questions=folder)).experiments
    [point] = experiment.points
    assert point.process_words(Path("s.in"), Path("out"))[1:] == (str(folder), "s.in")


def test_what_is_checked_is_the_beginning_of_the_scene(empty_workplace: Workplace) -> None:
    script(empty_workplace, "mine", "exit 0")
    lines = 'command = ["./mine", "{steps}"]\ntrajectory = ["./mine", "{scene}", "{steps}", "{out}"]'
    long = SCENE.replace("steps = 10", "steps = 1000")
    [point] = points(empty_workplace, f'{HEAD}{long}[[series]]\nname = "mine"\n{lines}\n{BLOCKS}')
    assert words(point)[1:] == ("1000",)
    assert point.command is not None
    assert point.command.trajectory[1:] == ("{scene}", str(CHECKED_STEPS), "{out}")
    assert point.is_checked


def test_a_variant_may_stand_beside_a_program(empty_workplace: Workplace) -> None:
    variant = '[[series]]\nname = "published"\nvariant = "published"\n'
    mine, published = points(empty_workplace, f"{HEAD}{SCENE}{SORT}{variant}{BLOCKS}")
    assert published.verb == mine.verb == "process"
    assert published.process_words(Path("s.in"), Path("out"))[1:3] == ("run", "s.in")
    assert mine.variant is None
    assert published.command is None


@pytest.mark.parametrize("changed", ["the program", "its interpreter", "a file among its words"])
def test_a_changed_program_is_another_point(
    empty_workplace: Workplace, monkeypatch: pytest.MonkeyPatch, changed: str
) -> None:
    own = script(empty_workplace, "own-interpreter", f"#!{sys.executable}\nexit 0\n")
    files = {
        "the program": script(empty_workplace, "mine", f"#!/usr/bin/env -S {own.name} -x\nexit 0\n"),
        "its interpreter": own,
        "a file among its words": script(empty_workplace, "input.txt", "exit 0"),
    }
    monkeypatch.setenv("PATH", f"{own.parent}:/usr/bin:/bin")
    text = f'{HEAD}[[series]]\nname = "mine"\ncommand = ["./mine", "input.txt", "other"]\n{BLOCKS}'
    [before] = points(empty_workplace, text)
    assert {path.name for path in before.program.files} == {"mine", "own-interpreter", "input.txt"}
    before.program.require_unchanged()
    with files[changed].open("a", encoding="utf-8") as file:
        file.write("# changed\n")
    [after] = points(empty_workplace, text)
    assert after.id != before.id
    with pytest.raises(InputError, match=f"{files[changed].name}: was built anew while the study ran"):
        before.program.require_unchanged()


def test_a_pattern_makes_a_series_of_each_file(empty_workplace: Workplace) -> None:
    for name in ("subs/anna/sim", "subs/b {ob}/sim", "subs/notes.txt"):
        script(empty_workplace, name, "exit 0")
    lines = 'commands = "subs/*/sim"\ncommand = ["{program}", "{x}"]\ntrajectory = ["{folder}/sim", "{out}"]'
    found = points(empty_workplace, f"{HEAD}{SCENE}[[series]]\n{lines}\n{BLOCKS}")
    assert [point.series for point in found] == ["anna", "b {ob}"]
    folder = empty_workplace.root / "questions" / "subs"
    assert [words(point) for point in found] == [
        (str(folder / "anna" / "sim"), "0"),
        (str(folder / "b {ob}" / "sim"), "0"),
    ]


def test_a_benchmark_is_run_for_its_one_case(empty_workplace: Workplace) -> None:
    script(empty_workplace, "bench", "exit 0")
    table = 'benchmark = {program = "./bench", name = "BM_sort<int>/{x}"}'
    text = f'{HEAD}[sweep]\nparameter = "size"\nvalues = [8]\n[[series]]\nname = "sort"\n{table}\n{BLOCKS}'
    [point] = points(empty_workplace, text)
    assert point.process_words(None, Path("report"))[1:] == (
        "--benchmark_filter=^BM_sort<int>/8(/|$)",
        "--benchmark_min_time=0.1",
        "--benchmark_out=report",
        "--benchmark_out_format=json",
    )
    assert point.command is not None
    assert point.command.benchmark == "BM_sort<int>/8"
    assert point.command.times_itself


WRONG = {
    'name = "a"\ncommand = ["./none"]': 'series[1].command: found "./none", which is not there',
    'name = "a"\ncommand = ["no-such-program-anywhere"]': "expected a program on PATH",
    'name = "a"\ncommand = ["./plain"]': 'found "./plain", which is not executable; `chmod +x`',
    'name = "a"\ncommand = ["./folder/"]': 'found "./folder/", which is a folder',
    'name = "a"\ncommand = ["/dev/null"]': 'found "/dev/null", which is no file; expected a program',
    'name = "a"\ncommand = ["sort", "{thread}"]': 'found "{thread}", expected one of {threads}',
    'name = "a"\ncommand = ["sort", "{scene}"]': 'found "{scene}", expected one of {threads}',
    'name = "a"\ncommand = ["sort", "{x:3}"]': 'series[1].command: found "{x}", expected one of',
    'name = "a"\ncommand = ["sort", "{"]': "{{ stands for a brace",
    'name = "a"\ncommand = []': "series[1].command: found [], expected a list of words",
    'name = "a"\ncommand = ["sort"]\ntrajectory = ["sort", "{out}"]': "trajectory: found without a scene",
    'name = "a"\ncommand = ["sort"]\nvariant = "nine"': "found variant and command, expected one of",
    'name = "a"': "series[1]: found none of them, expected one of variant, command, benchmark",
    'name = "a"\nvariant = "nine"\ntime = {stdout = "(a)"}': "time: found for a variant, expected for",
    'name = "a"\ncommand = ["sort"]\nfind_chunk = 3': "find_chunk: found for a command, expected for",
    'name = "a"\ncommand = ["sort"]\ntime = {stdout = "a"}': 'time.stdout: found "a" with 0 groups',
    'name = "a"\ncommand = ["sort"]\ntime = {stdout = "("}': "expected a regular expression",
    'name = "a"\ncommand = ["sort"]\ntime = {stdout = "(a)", unit = "d"}': "one of ns, us, ms, s, min, h",
    'command = ["sort"]': "series[1].name: missing",
    'commands = "none/*"\ncommand = ["{program}"]': 'commands: found "none/*", which no file matches',
    'name = "a"\nbenchmark = {program = "sort"}': "benchmark: expected either name or filter",
}


@pytest.mark.parametrize(("lines", "expected"), WRONG.items())
def test_a_mistake_is_told_with_file_key_and_what_was_expected(
    empty_workplace: Workplace, lines: str, expected: str
) -> None:
    script(empty_workplace, "plain", "exit 0", 0o644)
    (empty_workplace.root / "questions" / "folder").mkdir()
    said = refusal(empty_workplace, f"{HEAD}[[series]]\n{lines}\n{BLOCKS}")
    assert said.startswith(f"{empty_workplace.root / 'questions' / 'asked.toml'}: ")
    assert expected in said


VARIANT = '[[series]]\nname = "b"\nvariant = "nine"\n'
SWEPT = '[sweep]\nparameter = "{}"\nvalues = [1]\nquick_values = [2]\n'
ONLY_OF_VARIANTS = {
    'verb = "bench"\n': 'verb: found bench beside programs of others, expected "process"',
    "repetitions = 2\n": "repetitions: found for verb process, expected for bench or profile only",
    SCENE + SWEPT.format("lines") + VARIANT: 'sweep.parameter: found "lines", expected one of threads',
    VARIANT: "scene: missing",
    SWEPT.format("particles"): "sweep.parameter: found particles without a scene",
}


@pytest.mark.parametrize(("text", "expected"), ONLY_OF_VARIANTS.items())
def test_what_only_variants_can_do_is_refused(empty_workplace: Workplace, text: str, expected: str) -> None:
    assert expected in refusal(empty_workplace, HEAD + text + SORT + BLOCKS)


def test_claims_of_a_folder_may_be_named(empty_workplace: Workplace) -> None:
    text = f'claim = "mine_is_faster"\n{HEAD}{SORT}{BLOCKS}'
    assert 'claim: found "mine_is_faster", expected one of' in refusal(empty_workplace, text)
    claims = empty_workplace.root / "questions" / "claims.toml"
    claims.write_text('[[claim]]\nid = "mine_is_faster"\n', encoding="utf-8")
    assert load_question(empty_workplace.question("asked", text)).claim == "mine_is_faster"
    assert [one.name for one in Study(empty_workplace.settings).experiments] == ["asked"]
    claims.write_text("claim = 3\n", encoding="utf-8")
    assert "is not a list of claims" in refusal(empty_workplace, text.replace("mine_is", "other_is"))
