"""`carom compare` of Google Benchmarks: how they are known, and which cases are compared."""

import csv
import re
from pathlib import Path

import pytest

from experiments.compare.benchmarks import call_of
from experiments.compare.commands import Compared
from experiments.tests.compare.calls import BENCHMARK, needs_the_program, run, script

pytestmark = needs_the_program


def test_whole_programs_are_run_where_the_user_says_so(folder: Path) -> None:
    for name in ("first", "second"):
        program = (Path("/bin") / "true").read_bytes() + b"benchmark_list_tests"
        (folder / name).write_bytes(program)
        (folder / name).chmod(0o755)
    done = run(folder, "compare", "./first", "./second", "--time", "1ms")
    assert "these are Google Benchmarks" in done.stderr
    assert done.returncode == 1, "they list no cases"
    assert run(folder, "compare", "./first", "./second", "--time", "1ms", "--no-gb").returncode == 0


def test_cases_of_benchmarks_are_paired_by_name(benchmarks: Path) -> None:
    done = run(
        benchmarks, "compare", "--gb", "./bench_old", "./bench_new", "--time", "60s", "--export-csv", "a.csv"
    )
    assert done.returncode == 0, done.stderr
    assert "BM_a     4 ms → 3 ms   −25.0 % [−25.0, −25.0]   faster by more than 2 %" in done.stdout
    assert "BM_b/8   4 ms → 3 ms   −25.0 %" in done.stdout
    assert "control: bench_old against itself: no difference found in any case" in done.stdout
    assert "not all have it: BM_gone of ./bench_old" in done.stderr
    assert "not all have it: BM_new of ./bench_new" in done.stderr
    rows = list(csv.DictReader((benchmarks / "a.csv").open(encoding="utf-8")))
    assert {row["case"] for row in rows} == {"BM_a", "BM_b/8"}


def test_the_time_of_six_blocks_is_foretold_by_the_first(folder: Path) -> None:
    for name in ("old", "new"):
        script(folder / name, f"sleep 0.4\n{BENCHMARK.format(names='BM_a', time=4)}")
    done = run(folder, "compare", "--gb", "./old", "./new", "--time", "1ms")
    found = re.search(
        r"measured for (\d+) s, 1 block: an interval needs 6 blocks, .* `--time (\d+)s`", done.stdout
    )
    assert found, done.stdout
    assert int(found[2]) >= 5 * int(found[1])


def test_a_filter_picks_cases(benchmarks: Path) -> None:
    done = run(benchmarks, "compare", "--gb", "--filter", "_b", "./bench_old", "./bench_new", "--time", "60s")
    assert "BM_b/8" in done.stdout
    assert "BM_a" not in done.stdout


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--filter", "gone"], 'carom: ./bench_new: --filter: found "gone", which no case matches'),
        (["--filter", "("], 'found "(", which no case matches: as a regular expression it has a fault: '),
        (["--filter", "nothing"], 'found "nothing", which no case matches'),
        (
            ["./bench_old --benchmark_out=kept"],
            "found --benchmark_out=kept, which every call of it would write",
        ),
    ],
)
def test_without_a_common_case_nothing_is_run(benchmarks: Path, words: list[str], told: str) -> None:
    done = run(benchmarks, "compare", "--gb", *words, "./bench_old", "./bench_new")
    assert done.returncode == 1
    assert told in done.stderr


def test_benchmarks_are_known_by_what_stands_in_them(tmp_path: Path) -> None:
    for name, content in (
        ("benchmark", b"\x7fELF...--benchmark_list_tests..."),
        ("loads_it", b"\x7fELF...libbenchmark.so.1..."),
        ("program", b"\x7fELF..."),
        ("script", b"#!/bin/sh\n./benchmark --benchmark_list_tests\n"),
        ("empty", b""),
    ):
        (tmp_path / name).write_bytes(content)

    def arguments(*words: str) -> tuple[str, ...] | None:
        call = call_of(Compared("x", words, "", folder=tmp_path))
        return None if call is None else call.arguments

    assert arguments("./benchmark") == arguments("./loads_it") == ()
    assert arguments("./benchmark", "--benchmark_min_time=0.2") == ("--benchmark_min_time=0.2",)
    assert arguments("taskset", "-c", "0", "./benchmark", "-x") == ("-x",)
    assert arguments("env", "A=1", "./loads_it") == arguments("time", "./loads_it") == ()
    behind_env = call_of(Compared("x", ("env", "BENCHMARK_FILTER=a", "./benchmark"), "", folder=tmp_path))
    assert behind_env is not None
    assert behind_env.filter == "a"
    for words in (["./program"], ["./script"], ["./empty"], ["./missing"], ["strip", "./benchmark"]):
        assert arguments(*words) is None
    assert arguments("./benchmark", "--benchmark_list_tests") is None
