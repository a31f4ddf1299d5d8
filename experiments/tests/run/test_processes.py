"""Anybody's programs beside a variant, under the real runner: measured, checked, failed, killed, resumed."""

import json
import sys
import tomllib
from dataclasses import replace

import pytest

from experiments.__main__ import main
from experiments.run.session import run
from experiments.run.study import POINTS_FAILED, Settings
from experiments.tests.conftest import ROOT, SCENE, Workplace
from experiments.tests.foreign import script
from support.record_schema import is_record

BUILD = ROOT / "build"

pytestmark = pytest.mark.skipif(
    not (BUILD / "gcc" / "carom").is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)

SIMULATION = """#!{python}
\"\"\"Discs that meet nobody, as long as the scene lasts.\"\"\"
import sys

scene, output, share = sys.argv[1], sys.argv[2], float(sys.argv[3])
lines = open(scene).read().splitlines()
number, steps = int(lines[0]), int(lines[3])
discs = [[float(word) for word in line.split()] for line in lines[4:]]
with open(output, "w") as file:
    for step in range(steps + 1):
        for i, x, y, vx, vy in discs:
            print(step, int(i), repr(x), repr(y), repr(vx), repr(vy), file=file)
        discs = [[i, x + share * vx, y + share * vy, vx, vy] for i, x, y, vx, vy in discs]
"""

ALONE = SCENE.replace("particles = 100", "particles = 1").replace("steps = 10", "steps = 3")

PROGRAMS = f"""
title = "Programs of others"
figure = "comparison"
threads = 1
{ALONE}
[[series]]
name = "right"
command = ["./mine", "{{scene}}", "/dev/null", "1"]
trajectory = ["./mine", "{{scene}}", "{{out}}", "1"]

[[series]]
name = "wrong"
command = ["./mine", "{{scene}}", "/dev/null", "0.999"]
trajectory = ["./mine", "{{scene}}", "{{out}}", "0.999"]

[[series]]
name = "crashes"
command = ["./crash it's \\"here\\"", "{{scene}}"]

[[series]]
name = "says"
command = ["echo", "it took 20 ms"]
time = {{stdout = 'took (\\d+) ms', unit = "ms"}}

[[series]]
name = "benchmark"
benchmark = {{program = "./bench", name = "BM_x"}}

[[series]]
name = "variant"
variant = "published"

[blocks]
minimum = 2
wanted = 2
"""

BENCHMARK = """#!/bin/sh
for word in "$@"; do
    case $word in --benchmark_out=*)
        echo '{"benchmarks": [{"name": "BM_x", "real_time": 3, "time_unit": "ms", "rate": 7}]}' \\
            > "${word#*=}";;
    esac
done
"""


@pytest.fixture
def programs(empty_workplace: Workplace) -> Workplace:
    script(empty_workplace, "mine", SIMULATION.replace("{python}", sys.executable))
    script(empty_workplace, 'crash it\'s "here"', "#!/bin/sh\necho no room for >&2; exit 9\n")
    script(empty_workplace, "bench", BENCHMARK)
    empty_workplace.question("others", PROGRAMS)
    return empty_workplace


def settings(place: Workplace) -> Settings:
    return replace(place.settings, build=BUILD)


def test_every_kind_is_measured_or_fails_with_its_reason(programs: Workplace) -> None:
    assert run(settings(programs)) == POINTS_FAILED
    records = list(programs.records("others").values())
    assert all(is_record(json.loads(path.read_bytes())) for path in programs.files("others"))
    assert {record["kind"] for record in records} == {"process"}
    by_series = {record["tags"]["series"]: record for record in records if record["tags"]["block"] == 1}
    assert set(by_series) == {"right", "says", "benchmark", "variant"}
    assert len(records) == 8
    checks = {name: record["check"]["verdict"] for name, record in by_series.items()}
    assert checks == {"right": "passed", "variant": "passed", "says": "unchecked", "benchmark": "unchecked"}
    seconds = {name: record["repetitions"][0]["steps_seconds"] for name, record in by_series.items()}
    assert seconds["says"] == pytest.approx(0.02)
    assert seconds["benchmark"] == pytest.approx(0.003)
    assert by_series["benchmark"]["process"]["counters"] == {"rate": 7}
    assert seconds["right"] == by_series["right"]["process"]["wall_seconds"]
    scopes = {name: record["check"]["scope"] for name, record in by_series.items()}
    assert scopes["right"] == "trajectory of its own program, steps 0 to 3"
    assert scopes["variant"] == "every-step"
    assert by_series["variant"]["process"]["command"][1] == "run"
    assert by_series["right"]["scene"]["particles"] == 1
    [wrong, crashed] = sorted(programs.failures(), key=lambda one: str(one["tags"]["series"]), reverse=True)
    assert wrong["tags"]["series"] == "wrong"
    assert "step 1: disc 0 moved from" in wrong["reason"]
    assert wrong["exit_code"] == 2
    assert crashed["reason"] == "exit code 9: no room for"
    assert crashed["command"][0].endswith('crash it\'s "here"')


COUNTS = """
title = "One that counts"
figure = "comparison"
threads = 1

[[series]]
name = "one"
command = ["./count", "400"]
"""

COUNT = "#!/bin/sh\ni=0\nwhile [ $i -lt $1 ]; do i=$((i+1)); done\n"


def test_the_folder_of_the_questions_brings_its_claims_along(empty_workplace: Workplace) -> None:
    script(empty_workplace, "count", COUNT)
    empty_workplace.question("counts", COUNTS)
    run(replace(settings(empty_workplace), blocks=1))
    kept = empty_workplace.results / "claims.toml"
    place = f'questions = "{empty_workplace.root / "questions"}"\n'
    assert kept.read_text() == f"{place}# Nothing is claimed.\n"
    (empty_workplace.root / "questions" / "claims.toml").write_text('[[claim]]\nid = "a"\n')
    run(replace(settings(empty_workplace), blocks=1))
    assert kept.read_text() == f'{place}[[claim]]\nid = "a"\n'
    assert tomllib.loads(kept.read_text())["questions"]


def test_a_new_question_runs_as_it_is(empty_workplace: Workplace) -> None:
    empty_workplace.monkeypatch.chdir(empty_workplace.root)
    assert main(["new", "sorting"]) == 0
    assert main(["new", "sorting"]) == 1
    assert main(["new", "3"]) == 1
    assert run(replace(settings(empty_workplace), blocks=1)) == 0
    assert {record["tags"]["series"] for record in empty_workplace.records("sorting").values()} == {
        "one thread",
        "two threads",
    }
    assert {one["scene"] for one in empty_workplace.records("sorting").values()} == {None}


@pytest.mark.skipif(not (BUILD / "clang" / "carom").is_file(), reason="build/clang/carom is not built")
def test_two_builds_take_turns_as_whole_processes_and_each_tells_how_it_was_built(
    empty_workplace: Workplace,
) -> None:
    series = [
        f'[[series]]\nname = "{name}"\nvariant = "published"\nprogram = "{name}"\n'
        for name in ("gcc", "clang")
    ]
    blocks = "[blocks]\nminimum = 1\nwanted = 1\n"
    head = f'title = "Compilers"\nfigure = "comparison"\nverb = "process"\nthreads = 1\n{SCENE}\n'
    empty_workplace.question("builds", head + "\n".join([*series, blocks]))
    assert run(settings(empty_workplace)) == 0
    records = list(empty_workplace.records("builds").values())
    built = {record["tags"]["series"]: record["provenance"] for record in records}
    assert built["gcc"]["compiler"].startswith("GNU")
    assert built["gcc"]["openmp"]["runtime"] == "libgomp"
    assert built["clang"]["compiler"].startswith("Clang")
    assert built["clang"]["openmp"]["runtime"] == "libomp"
    assert all(is_record(json.loads(path.read_bytes())) for path in empty_workplace.files("builds"))
    for record in records:
        # On a busy machine one of them may seem to mind being stopped, which its record then says.
        assert record["process"]["undisturbed"] or record["slices"]
