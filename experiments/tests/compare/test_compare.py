"""`carom compare` and `carom gate` as a user calls them. Nothing here depends on how fast anything is."""

import csv
import json
import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

from experiments.compare.benchmarks import are_benchmarks
from experiments.compare.commands import Compared
from experiments.tests.conftest import ROOT

CAROM = ROOT / "build" / "gcc" / "carom"

pytestmark = pytest.mark.skipif(
    not CAROM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)

LOOP = "i=0; while [ $i -lt {times} ]; do i=$((i+1)); done"
"""A loop of a shell, some 30 ms for ten thousand times on any machine of today."""


def run(folder: Path, *words: str, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [CAROM, *words],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder / "tmp"), **(env or {})},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "tmp").mkdir()
    script(tmp_path / "short", LOOP.format(times=4000))
    script(tmp_path / "long", LOOP.format(times=12000))
    return tmp_path


def script(path: Path, text: str) -> None:
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)


def left_behind(folder: Path) -> list[str]:
    """What a call has left in its temporary folder, but for the lock of the machine."""
    return [one.name for one in (folder / "tmp").iterdir() if not one.name.endswith(".lock")]


def test_what_takes_a_third_is_faster(folder: Path) -> None:
    done = run(folder, "compare", "./long", "./short", "--time", "60s")
    assert done.returncode in (0, 5), done.stderr
    assert "short against long   −" in done.stdout
    if done.returncode == 0:
        assert "faster by more than 2 %" in done.stdout
        assert "settled after" in done.stdout
    assert left_behind(folder) == []


def test_without_time_for_an_interval_nothing_is_settled(folder: Path) -> None:
    done = run(folder, "compare", "./long", "./short", "--time", "1ms")
    assert done.returncode == 0
    assert "1 block" in done.stdout
    assert "an interval needs 6 blocks" in done.stdout


def test_the_result_is_written_as_files(folder: Path) -> None:
    words = ["--export-json", "a.json", "--export-csv", "a.csv", "--export-markdown", "a.md"]
    done = run(folder, "compare", "-n", "a|b", "-n", "c", "./short", "./long", "--time", "20s", *words)
    assert done.returncode in (0, 5), done.stderr
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    assert [one["name"] for one in told["commands"]] == ["a|b", "c"]
    rows = list(csv.DictReader((folder / "a.csv").open(encoding="utf-8")))
    assert {row["command"] for row in rows} == {"a|b", "a|b again", "c"}
    seconds = [float(row["seconds"]) for row in rows if row["command"] == "c"]
    [runs] = [one for one in told["runs"] if one["command"] == "c"]
    assert seconds == runs["seconds"]
    assert "c against a\\|b" in (folder / "a.md").read_text(encoding="utf-8")


def test_the_same_under_two_names_is_never_told_apart(folder: Path) -> None:
    done = run(
        folder, "compare", "-n", "one", "-n", "two", "./short", "./short", "--time", "60s", "--margin", "40%"
    )
    assert "two against one" in done.stdout
    assert "slower by more" not in done.stdout
    assert "faster by more" not in done.stdout


def test_a_command_that_fails_is_named_with_its_last_line(folder: Path) -> None:
    script(folder / "fails", "echo first >&2; echo no such scene >&2; exit 3")
    done = run(folder, "compare", "./short", "./fails", "--time", "5s")
    assert done.returncode == 2
    assert "carom: fails: failed after 0 runs" in done.stderr
    assert "no such scene" in done.stderr
    assert left_behind(folder) == []


def test_a_command_that_fails_later_is_told_with_its_runs(folder: Path) -> None:
    script(folder / "wears_out", 'echo x >> count; [ "$(wc -l < count)" -lt 5 ] || exit 1')
    done = run(folder, "compare", "./short", "./wears_out", "--time", "20s", "--turns", "off")
    assert done.returncode == 2
    assert "wears_out: failed after" in done.stderr
    assert "short   " in done.stdout, "what was measured of the others"


def test_a_command_that_hangs_is_stopped(folder: Path) -> None:
    script(folder / "hangs", "sleep 1000")
    done = run(folder, "compare", "./short", "./hangs", "--timeout", "2s")
    assert done.returncode == 2
    assert "hangs: failed after 0 runs" in done.stderr


def test_exit_codes_that_are_fine_are_no_failures(folder: Path) -> None:
    script(folder / "ends_in_3", "exit 3")
    done = run(folder, "compare", "./short", "./ends_in_3", "--time", "1ms", "--ignore-exit", "3")
    assert done.returncode == 0, done.stderr


def test_before_and_after_each_run_and_once_for_all(folder: Path) -> None:
    script(folder / "needs", 'test -e prepared && test -e set_up && test "$A" = 1 && read x && test $x = y')
    (folder / "input").write_text("y\n", encoding="utf-8")
    done = run(
        folder, "compare", "-n", "a", "-n", "b", "./needs", "./needs", "--time", "1ms",
        "--prepare", "touch prepared", "--conclude", "rm prepared", "--setup", "touch set_up",
        "--cleanup", "rm set_up; touch cleaned_up", "--input", "input", "--env", "A=1", "--turns", "off",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not (folder / "set_up").exists()
    assert not (folder / "prepared").exists()
    assert (folder / "cleaned_up").exists()


def test_what_once_comes_first_and_fails_is_said(folder: Path) -> None:
    done = run(folder, "compare", "./short", "./long", "--setup", "echo no room >&2; false")
    assert done.returncode == 1
    assert "carom: --setup: " in done.stderr
    assert "no room" in done.stderr


def test_a_time_that_is_printed_counts(folder: Path) -> None:
    script(folder / "prints_1", "echo took 100 ms")
    script(folder / "prints_2", "echo took 50 ms")
    done = run(
        folder, "compare", "./prints_1", "./prints_2", "--time", "20s", "--time-from", "took ([0-9.]+) ms"
    )
    assert "prints_2 against prints_1   −50.0 % [−50.0, −50.0]   faster by more than 2 %" in done.stdout
    assert "prints_1   100 ms" in done.stdout


def test_threads_are_bound_or_the_environment_is_the_users(folder: Path) -> None:
    for words, env, wanted in (
        (["--threads", "1"], {"OMP_NUM_THREADS": "7"}, "1"),
        ([], {"OMP_NUM_THREADS": "7"}, "7"),
    ):
        script(folder / "threads", f'test "$OMP_NUM_THREADS" = {wanted}')
        done = run(folder, "compare", "./short", "./threads", "--time", "1ms", *words, env=env)
        assert done.returncode == 0, done.stderr


def test_the_layout_varies_from_block_to_block_or_is_fixed(folder: Path) -> None:
    script(folder / "tells", 'echo "${#CAROM_PADDING}" >> paddings')
    words = ("compare", "./short", "./tells", "--turns", "off")
    assert run(folder, *words, "--time", "10s").returncode in (0, 5)
    paddings = (folder / "paddings").read_text(encoding="utf-8").split()
    assert len(set(paddings)) > 1
    (folder / "paddings").unlink()
    done = run(folder, *words, "--time", "1s", "--fixed-layout")
    assert done.returncode in (0, 5)
    assert set((folder / "paddings").read_text(encoding="utf-8").split()) == {"0"}


def test_a_shell_is_told_with_what_its_start_takes(folder: Path) -> None:
    done = run(folder, "compare", "./short; true", "./long; true", "--time", "1ms")
    assert "a shell starts lines" in done.stdout


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["./short", "./not_there"], 'carom: not_there: command: found "./not_there", which is not there'),
        (["./short"], "found 1 command, expected two or more"),
        (["./short", "./long", "--export-json", "tmp"], "--export-json: found tmp, which is a folder"),
        (["./short", "./long", "--turns", "0.1ms"], "--turns: found 0.1ms, expected auto, on, off or"),
        (["./short", "./long", "--frobnicate"], "unrecognized arguments: --frobnicate"),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(folder: Path, words: list[str], told: str) -> None:
    done = run(folder, "compare", *words)
    assert done.returncode == 1
    assert done.stdout == ""
    assert told in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_what_there_is(folder: Path, number: signal.Signals) -> None:
    child = subprocess.Popen(
        [CAROM, "compare", "./short", "./long", "--margin", "0.0001%", "--export-csv", "rows.csv"],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder / "tmp")},
        stdout=subprocess.PIPE,
        text=True,
    )
    until = time.monotonic() + 60
    while time.monotonic() < until and not list(folder.glob("tmp/carom-compare-*/records/compare/*-b1.json")):
        time.sleep(0.1)
    child.send_signal(number)
    output, _ = child.communicate(timeout=60)
    assert child.returncode == 128 + number
    assert "short   " in output
    assert left_behind(folder) == []
    assert (folder / "rows.csv").exists()


def printed(folder: Path) -> None:
    """Programs that say how long they took: `prints A B` took A times B ms."""
    script(folder / "prints", 'echo took "$(($1 * $2))" ms')


TOOK = ("--time-from", "took ([0-9]+) ms")


def test_products_of_lists_have_a_table_of_effects(folder: Path) -> None:
    printed(folder)
    lists = ("-L", "a", "100,200", "-L", "b", "1,3")
    done = run(folder, "compare", *lists, "./prints {a} {b}", *TOOK, "--time", "60s")
    assert done.returncode == 0, done.stderr
    told = done.stdout.split("what each value changes")[1]
    rows = [re.split(" {3,}", line.strip()) for line in told.splitlines()[1:]]
    more, none = "more time, by more than 2 %", "below 2 %"
    assert rows == [
        ["a 200 instead of 100", "+100.0 % [+100.0, +100.0]", more],
        ["b 3 instead of 1", "+200.0 % [+200.0, +200.0]", more],
        ["a 200 instead of 100 and b 3 instead of 1", "+0.0 % [+0.0, +0.0]", none],
    ]


def test_words_behind_dashes_and_another_reference(folder: Path) -> None:
    printed(folder)
    named = ("-q", "-n", "first", "-n", "second", "--reference", "second", "--time", "60s", *TOOK)
    done = run(folder, "compare", *named, "--", "./prints", "100", "1", "--vs", "./prints", "50", "1")
    assert done.returncode == 0, done.stderr
    assert "first against second   +100.0 % [+100.0, +100.0]   slower by more than 2 %" in done.stdout
    assert "control: second against itself" in done.stdout


def test_a_range_of_numbers_is_a_league(folder: Path) -> None:
    printed(folder)
    done = run(folder, "compare", "-P", "n", "1", "3", "./prints {n} 100", "--time", "60s", *TOOK)
    assert "./prints 2 100 against ./prints 1 100   +100.0 %" in done.stdout
    assert "./prints 3 100 against ./prints 1 100   +200.0 %" in done.stdout
    assert "those with a letter in common cannot be told apart" in done.stdout


def test_a_smaller_error_is_stated_and_takes_more(folder: Path) -> None:
    script(folder / "wobbles", 'echo took "$((100 + $(wc -l < blocks) % 3))" ms; echo x >> blocks')
    script(folder / "longer", 'echo took "$((104 + $(wc -l < blocks) % 3))" ms; echo x >> blocks')
    needed = {}
    for error in ("5%", "0.01%"):
        (folder / "blocks").write_text("", encoding="utf-8")
        words = ("./wobbles", "./longer", *TOOK, "--error", error, "--time", "60s", "--export-json", "a.json")
        run(folder, "compare", *words)
        told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
        [one] = told["differences"]
        needed[error] = told["blocks"], one["high"] - one["low"]
        assert told["error"] == float(error.removesuffix("%")) / 100
    assert needed["0.01%"] > needed["5%"]


def test_untimed_runs_come_before_each_timed_one(folder: Path) -> None:
    script(folder / "counts", "echo x >> runs")
    words = ("--warmup", "2", "--prepare", "true", "--turns", "off", "--time", "1ms")
    assert run(folder, "compare", "-n", "a", "-n", "b", "./counts", "./counts", *words).returncode == 0
    # Two commands and the control, in one block.
    assert (folder / "runs").read_text(encoding="utf-8").count("x") == 3 * (2 + 1)


def test_whole_programs_are_run_where_the_user_says_so(folder: Path) -> None:
    for name in ("first", "second"):
        program = (Path("/bin") / "true").read_bytes() + b"benchmark_list_tests"
        (folder / name).write_bytes(program)
        (folder / name).chmod(0o755)
    done = run(folder, "compare", "./first", "./second", "--time", "1ms")
    assert "these are Google Benchmarks" in done.stderr
    assert done.returncode == 1, "they list no cases"
    assert run(folder, "compare", "./first", "./second", "--time", "1ms", "--no-gb").returncode == 0


def test_short_commands_are_repeated(folder: Path) -> None:
    script(folder / "quick", "echo x >> runs")
    script(folder / "quicker", "exit 0")
    files = ("--export-json", "a.json")
    done = run(folder, "compare", "./quick", "./quicker", "--time", "1ms", "--turns", "off", *files)
    assert done.returncode == 0, done.stderr
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    times = told["in_a_row"]
    assert times > 1
    assert f"each time is of {times} runs in a row" in done.stdout
    # Itself and under its second name: once in the block that shows how short it is, then in a row.
    runs = (folder / "runs").read_text(encoding="utf-8").count("x")
    assert runs == 2 + 2 * times * told["blocks"]


def test_a_short_command_that_fails_is_named_with_its_code(folder: Path) -> None:
    script(folder / "quick", "exit 0")
    script(
        folder / "wears_out", 'echo x >> count; [ "$(wc -l < count)" -lt 9 ] || { echo worn >&2; exit 4; }'
    )
    done = run(folder, "compare", "./quick", "./wears_out", "--time", "20s", "--turns", "off")
    assert done.returncode == 2
    assert "exit code 4: worn" in done.stderr


def test_what_is_prepared_is_never_repeated(folder: Path) -> None:
    script(folder / "needs", "rm prepared")
    words = ("--prepare", "touch prepared", "--turns", "off", "--time", "1ms", "--export-json", "a.json")
    done = run(folder, "compare", "-n", "a", "-n", "b", "./needs", "./needs", *words)
    assert done.returncode == 0, done.stderr
    assert json.loads((folder / "a.json").read_text(encoding="utf-8"))["in_a_row"] == 1


def test_a_file_goes_on_with_what_is_in_it(folder: Path) -> None:
    printed(folder)
    words = ("compare", "./prints 100 1", "./prints 50 1", *TOOK, "--append", "kept.json", "--time", "1ms")
    assert "1 block:" in run(folder, *words).stdout
    assert "2 blocks, 1 of them earlier" in run(folder, *words).stdout
    done = run(folder, *words[:-1], "60s")
    assert "settled after" in done.stdout
    assert "6 blocks, 2 of them earlier" in done.stdout
    assert "6 blocks, 6 of them earlier" in run(folder, *words).stdout, "all is known: nothing is measured"
    script(folder / "prints", 'echo took "$(($1 * $2))" ms # changed')
    done = run(folder, *words)
    assert "a new session begins" in done.stderr
    assert "other commands, or changed programs" in done.stderr
    assert "1 block:" in done.stdout
    sessions = json.loads((folder / "kept.json").read_text(encoding="utf-8"))["sessions"]
    assert [len(one["records"]) for one in sessions] == [18, 3]


def test_a_file_of_something_else_is_no_earlier_call(folder: Path) -> None:
    (folder / "kept.json").write_text('{"sessions": 1}', encoding="utf-8")
    done = run(folder, "compare", "./short", "./long", "--append", "kept.json")
    assert done.returncode == 1
    assert "--append: kept.json: is no file of an earlier call" in done.stderr
    assert (folder / "kept.json").read_text(encoding="utf-8") == '{"sessions": 1}'


def test_a_page_has_the_verdict_and_its_picture(folder: Path) -> None:
    printed(folder)
    words = ("./prints 100 1", "./prints 50 1", "-n", "<old>", "-n", "new", *TOOK, "--time", "60s")
    assert run(folder, "compare", *words, "--html", "a.html").returncode == 0
    page = (folder / "a.html").read_text(encoding="utf-8")
    assert "<h1>new against &lt;old&gt;: faster by more than 2 %</h1>" in page
    assert "<svg" in page
    assert not re.search(r"(href|src)=.http|url\(http|@import", page), "it asks nothing of any other place"
    assert left_behind(folder) == []


def test_slices_are_as_long_as_asked(folder: Path) -> None:
    slices = {}
    for length in ("5ms", "10s"):
        words = ("./long", "./long; true", "--turns", length, "--time", "1ms", "--append", length)
        assert run(folder, "compare", *words).returncode == 0
        [session] = json.loads((folder / length).read_text(encoding="utf-8"))["sessions"]
        slices[length] = [len((one["turns"] or {"seconds": []})["seconds"]) for one in session["records"]]
    assert max(slices["5ms"]) > max(slices["10s"])


def test_what_is_counted_stands_beside_the_times(folder: Path) -> None:
    done = run(folder, "compare", "./short", "./long", "--time", "1ms", "--export-json", "a.json")
    assert "counted of each run, short → long:" in done.stdout
    assert "page faults" in done.stdout
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    for one in told["runs"]:
        assert len(one["counts"]["minor_page_faults"]) == told["blocks"]


BENCHMARK = """
list= filter=. output=
for word; do
    case $word in
        --benchmark_list_tests=*) list=yes ;;
        --benchmark_filter=*) filter=${{word#*=}} ;;
        --benchmark_out=*) output=${{word#*=}} ;;
    esac
done
names=$(printf '%s\\n' {names} | grep -E -- "$filter")
[ -z "$list" ] || {{ printf '%s\\n' "$names"; exit; }}
case="{{\\"name\\": \\"$names\\", \\"real_time\\": {time}, \\"time_unit\\": \\"ms\\"}}"
echo "{{\\"benchmarks\\": [$case]}}" > "$output"
"""
"""Says of each case that it takes so long."""


@pytest.fixture
def benchmarks(folder: Path) -> Path:
    script(folder / "bench_old", BENCHMARK.format(names="BM_a BM_b/8 BM_gone", time=4))
    script(folder / "bench_new", BENCHMARK.format(names="BM_new BM_b/8 BM_a", time=3))
    return folder


def test_cases_of_benchmarks_are_paired_by_name(benchmarks: Path) -> None:
    done = run(
        benchmarks, "compare", "--gb", "./bench_old", "./bench_new", "--time", "60s", "--export-csv", "a.csv"
    )
    assert done.returncode == 0, done.stderr
    assert "BM_a     4 ms → 3 ms   −25.0 % [−25.0, −25.0]   faster by more than 2 %" in done.stdout
    assert "BM_b/8   4 ms → 3 ms   −25.0 %" in done.stdout
    assert "control: bench_old against itself: no difference in any case" in done.stdout
    assert "not all have it: BM_gone of bench_old" in done.stderr
    assert "not all have it: BM_new of bench_new" in done.stderr
    rows = list(csv.DictReader((benchmarks / "a.csv").open(encoding="utf-8")))
    assert {row["case"] for row in rows} == {"BM_a", "BM_b/8"}


def test_a_filter_picks_cases(benchmarks: Path) -> None:
    done = run(benchmarks, "compare", "--gb", "--filter", "_b", "./bench_old", "./bench_new", "--time", "60s")
    assert "BM_b/8" in done.stdout
    assert "BM_a" not in done.stdout


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--filter", "gone"], 'carom: --gb: bench_new.filter: found "gone", which no case matches'),
        (["--filter", "nothing"], 'found "nothing", which no case matches'),
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

    def are(*words: str) -> bool:
        return are_benchmarks([Compared(word, tuple(word.split()), word, folder=tmp_path) for word in words])

    assert are("./benchmark", "./loads_it")
    assert not are("./benchmark", "./program")
    assert not are("./script", "./benchmark")
    assert not are("./benchmark --verbose", "./benchmark")
    assert not are("./empty", "./missing")


def test_three_commands_are_a_league(folder: Path) -> None:
    for name, time_taken in (("a", 100), ("b", 50), ("c", 50)):
        script(folder / name, f"echo took {time_taken} ms")
    done = run(folder, "compare", "./a", "./b", "./c", "--time", "60s", "--time-from", "took ([0-9]+) ms")
    assert "c against a   −50.0 %" in done.stdout
    places = [line.split() for line in done.stdout.split("told apart:\n")[1].splitlines()]
    assert [place[-2:] for place in places] == [["b", "a"], ["c", "a"], ["a", "b"]]
