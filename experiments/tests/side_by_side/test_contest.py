"""Who runs when, who minds being stopped, which runs count: real programs under the real sampler."""

import hashlib
import json
import shlex
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from experiments.run.process_record import Described, process_record
from experiments.run.sources import Sources
from experiments.side_by_side.contest import Contender, Contest, Entrant, may_disagree, why_idle
from experiments.side_by_side.run_result import RunResult
from experiments.side_by_side.sampler import ProcessCommand, Sampler, SamplerError
from experiments.tests.conftest import ROOT
from support.record_schema import is_record

CAROM = ROOT / "build" / "gcc" / "carom"
needs_carom = pytest.mark.skipif(
    not CAROM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)

Measure = Callable[..., list[Entrant]]

NO_TERMINAL = " without a word; it had no terminal: its standard input is empty, its outputs are pipes"
WORK = "i=0; while [ $i -lt {} ]; do i=$((i+1)); done"


@pytest.fixture
def sampler() -> Iterator[Sampler]:
    with Sampler(CAROM) as found:
        yield found


@pytest.fixture
def measure(sampler: Sampler, tmp_path: Path) -> Measure:
    def measured(*contenders: Contender, slice_seconds: float = 0.01, seed: int = 1) -> list[Entrant]:
        return Contest(sampler, contenders, slice_seconds, seed, tmp_path).measure()

    return measured


def scripted(script: str, **more: Any) -> Contender:  # noqa: ANN401 - any field
    return Contender(("/bin/sh", "-c", script), **{"most_seconds": 60, **more})


def appending(word: str, path: Path) -> str:
    return f"printf {shlex.quote(word)} >> {shlex.quote(str(path))}"


@needs_carom
def test_what_only_works_takes_turns(measure: Measure) -> None:
    one = scripted(WORK.format(150_000), turns=True)
    for each in measure(one, one):
        assert (each.failure, each.is_sliced, each.undisturbed) == ("", True, "")
        assert len(each.runs[0].seconds) > 3


@needs_carom
def test_what_sleeps_is_measured_without_a_pause(measure: Measure) -> None:
    for each, least in zip(measure(scripted("sleep 0.3"), scripted("sleep 0.4")), (0.3, 0.4), strict=True):
        assert each.undisturbed
        assert not each.is_sliced
        assert len(each.runs[0].seconds) == 1
        assert each.runs[0].wall_seconds >= least


MINDS = {
    "fails in slices": """import sys, time
start = last = time.monotonic()
while last - start < 1.2:
    now = time.monotonic()
    if now - last > 0.3: sys.exit('stood still')
    last = now
""",
    "looks at the clock": """import time
until = time.monotonic() + 1.6
while time.monotonic() < until: pass
""",
}


@needs_carom
@pytest.mark.parametrize(
    ("script", "slice_seconds"), [*zip(MINDS.values(), (0.4, 0.05), strict=True)], ids=MINDS
)
def test_who_minds_is_measured_without_a_pause(measure: Measure, script: str, slice_seconds: float) -> None:
    other = scripted(WORK.format(2_000_000), turns=True, expected_seconds=1.2)
    minds, beside = measure(Contender(("python3", "-c", script)), other, slice_seconds=slice_seconds)
    assert (minds.failure, minds.is_sliced, beside.failure) == ("", False, "")
    assert minds.undisturbed
    assert minds.runs[0].wall_seconds >= 1.2


@needs_carom
def test_what_wait_for_one_another_are_measured_without_a_pause(measure: Measure, tmp_path: Path) -> None:
    lock = tmp_path / "lock"
    one = scripted(f"until mkdir {lock} 2> /dev/null; do :; done; {WORK.format(400_000)}; rmdir {lock}")
    ended = measure(one, one, slice_seconds=0.02)
    for each in ended:
        assert (each.failure, each.is_sliced, len(each.runs[0].seconds)) == ("", False, 1)
    assert any("and the others stand still while it runs" in each.undisturbed for each in ended)


@needs_carom
def test_what_finds_a_lock_left_ends_at_its_limit(measure: Measure, tmp_path: Path) -> None:
    one = scripted(f"until mkdir {tmp_path} 2> /dev/null; do :; done", most_seconds=0.3)
    assert [each.failure for each in measure(one, one)] == ["took longer than 0.3 s and was killed"] * 2


FAILURES: dict[str, tuple[Contender, int, str]] = {
    "exit": (scripted("echo first >&2; echo last >&2; exit 4"), 4, "exit code 4: last"),
    "signal": (scripted("kill -ABRT $$"), -6, "killed by SIGABRT"),
    "limit": (scripted("sleep 60", most_seconds=0.05), 124, "took longer than 0.05 s and was killed"),
    "missing": (Contender(("/no/such/program",)), 127, "cannot be run: No such file or directory"),
    "folder": (
        scripted("", folder="/no/such"), 127, "cannot be run in /no/such: No such file or directory"
    ),
    "silent": (
        scripted("echo nothing", pattern="took ([0-9]+)"), 1,
        "time: 'took ([0-9]+)' matches 0 lines of standard output, expected one "
        "(what goes to standard error is read with `2>&1` behind the command)",
    ),
    "prepare": (scripted("", prepare=("sh", "-c", "echo no >&2; exit 1")), 1, "prepare: exit code 1: no"),
    "no prepare": (
        scripted("", prepare=("/no/such/program",)), 1, "prepare: cannot be run: No such file or directory"
    ),
    "conclude": (scripted("", conclude=("false",)), 1, f"conclude: exit code 1{NO_TERMINAL}"),
    "background": (
        scripted("", prepare=("sh", "-c", "sleep 97 &")), 1,
        "prepare: left sleep running in the background, expected nothing beside what is timed",
    ),
    "in slices": (scripted("exit 3", turns=True), 3, f"exit code 3{NO_TERMINAL}"),
}  # fmt: skip


@needs_carom
@pytest.mark.parametrize("name", FAILURES)
def test_what_fails_says_why_and_its_partners_do_not(measure: Measure, name: str) -> None:
    contender, exit_code, reason = FAILURES[name]
    failed, right = measure(contender, scripted(WORK.format(1000), turns=True))
    assert failed.failure == reason
    assert failed.exit_code == exit_code or name in ("prepare", "no prepare", "conclude", "background")
    assert right.failure == ""
    assert len(right.runs) == 1


@needs_carom
def test_where_nothing_can_be_measured_all_fail(tmp_path: Path) -> None:
    with Sampler(Path("/bin/false")) as nothing:
        ended = Contest(nothing, [scripted("")], 0.01, 1, tmp_path).measure()
        assert [one.failure for one in ended] == ["exit code 1 without a word"]
        with pytest.raises(SamplerError):
            nothing.surroundings(1, None)


@needs_carom
def test_exit_codes_that_are_fine_are(measure: Measure) -> None:
    [found] = measure(scripted("echo x | grep -c y", exit_codes=(0, 1)))
    assert (found.failure, found.runs[0].exit_code, found.runs[0].output_bytes) == ("", 1, 2)


@needs_carom
def test_each_run_is_prepared_and_concluded_in_its_folder(measure: Measure, tmp_path: Path) -> None:
    log, folders = tmp_path / "log", tmp_path / "folders"
    [one] = measure(
        scripted(
            f'test "$(ls)" = prepared && pwd >> {folders} && {appending("run ", log)}',
            prepare=("sh", "-c", f"touch prepared; {appending('prepare ', log)}"),
            conclude=("sh", "-c", f"rm prepared && {appending('conclude ', log)}"),
            fresh_folder=True,
            warm_ups=2,
        )
    )
    assert one.failure == ""
    assert log.read_text() == "prepare run conclude " * 3
    made = folders.read_text().split()
    assert len(set(made)) == 3
    assert not any(Path(folder).exists() for folder in made)


def benchmark(folder: Path, name: str, script: str) -> Contender:
    return scripted(script, benchmark="BM", output=folder / f"{name}.report")


@needs_carom
def test_benchmarks_go_round_after_round_and_no_report_is_taken_twice(
    measure: Measure, tmp_path: Path
) -> None:
    def writing(name: str) -> Contender:
        runs = tmp_path / name
        return benchmark(tmp_path, name, (
            f"{appending('x', runs)}; {appending(name, tmp_path / 'log')}; n=$(wc -c < {runs}); sleep 0.2;"
            f'echo \'{{"benchmarks": [{{"name": "BM", "real_time": \'$n\'}}]}}\' > {tmp_path}/{name}.report'
        ))  # fmt: skip

    ended = measure(writing("a"), writing("b"), scripted("echo 1", pattern="(.*)", unit_seconds=1.0))
    assert [each.failure for each in ended] == [""] * 3
    rounds = len(ended[0].runs)
    assert 2 < rounds <= 5, "as many as the longest has room for in a second"
    assert (len(ended[1].runs), len(ended[2].runs)) == (rounds, 1)
    assert [round(1e9 * one.seconds) for one in ended[0].stated] == [*range(1, rounds + 1)]
    log = (tmp_path / "log").read_text()
    assert all({*log[at : at + 2]} == {"a", "b"} for at in range(0, len(log), 2))
    report = tmp_path / "c.report"
    once = (
        f'[ -e {tmp_path}/once ] || echo \'{{"benchmarks": [{{"name": "BM", "real_time": 1}}]}}\' > {report}'
    )
    [forgetful] = measure(benchmark(tmp_path, "c", f"{once}; touch {tmp_path}/once"))
    assert forgetful.failure.startswith(f"{report}: cannot be read (No such file")


@needs_carom
def test_times_of_unlike_versions_of_a_library_count_for_nobody(measure: Measure, tmp_path: Path) -> None:
    def of(version: str) -> Contender:
        run = {"name": "BM", "threads": 4, "real_time": 3}
        report = json.dumps({"context": {"library_version": version}, "benchmarks": [run]})
        return benchmark(tmp_path, version, f"sleep 0.6; echo '{report}' > {tmp_path}/{version}.report")

    for each in measure(of("v1.8.3"), of("v1.9.1")):
        assert "'v1.8.3'" in each.failure
        assert "'v1.9.1'" in each.failure
    assert [each.failure for each in measure(of("v1.8.3"), of("v1.8.4"))] == ["", ""]


@needs_carom
def test_short_ones_run_as_often_as_they_say_around_the_others(measure: Measure, tmp_path: Path) -> None:
    log = tmp_path / "log"

    def short(name: str, rounds: int, **more: int) -> Contender:
        return scripted(
            f"(sleep 0.002; {appending(name, log)}) &",
            prepare=("sh", "-c", appending("(", log)),
            conclude=("sh", "-c", appending(")", log)),
            rounds=rounds,
            **more,
        )

    ended = measure(short("a", 8, warm_ups=1), short("b", 4), short("c", 1), seed=7)
    assert [len(each.runs) for each in ended] == [8, 4, 1]
    order = log.read_text()
    assert order.startswith("(a)"), "first the run that does not count"
    assert all(order[at] + order[at + 2] == "()" for at in range(0, len(order), 3)), "each is waited for"
    order = "".join(letter for letter in order if letter in "ab")
    assert all(order[at : at + 3].count("b") == 1 for at in range(1, len(order), 3)), "one in each quarter"


@needs_carom
def test_after_a_failure_no_more_and_others_go_on(measure: Measure, tmp_path: Path) -> None:
    runs = tmp_path / "runs"
    fails = scripted(f"{appending('x', runs)}; [ $(wc -c < {runs}) -lt 3 ]", rounds=9)
    sliced = scripted(WORK.format(50_000), turns=True)
    often = scripted("exit 0", rounds=3, turns=True)
    ended = measure(fails, sliced, often, sliced)
    assert ended[0].failure
    assert runs.read_text() == "xxx"
    assert [len(each.runs) for each in ended[1:]] == [1, 3, 1]
    assert [each.is_sliced for each in ended] == [False, True, False, True]


def result(wall: float, cpu: float, **more: float) -> RunResult:
    facts: dict[str, Any] = dict.fromkeys(RunResult.__dataclass_fields__, 0)
    return RunResult(**{**facts, "seconds": [wall], "user_seconds": cpu, "idle_seconds": wall, **more})


@pytest.mark.parametrize(
    ("wall", "cpu", "idle", "said"),
    [
        (1.0, 0.9, 1.0, ""), (1.0, 0.25, 1.0, "it computes for only 25 % of its time"),
        (1.0, 0.25, 0.2, ""), (0.001, 0.0, 0.001, ""),
    ],
    ids=["busy", "idle", "may have waited for a processor", "too short to tell"],
)  # fmt: skip
def test_who_is_idle_though_there_is_a_processor_minds(
    wall: float, cpu: float, idle: float, said: str
) -> None:
    why = why_idle(result(wall, cpu, idle_seconds=idle))
    assert why.startswith(said)
    assert bool(why) == bool(said)


WORKS, WAITS = ((1.0, 1.0), (1.4, 1.4), (1.1, 1.1)), ((1.2, 1.0), (1.8, 1.5), (1.2, 1.0))


@pytest.mark.parametrize(
    ("undisturbed", "in_slices", "expected"),
    [
        (WORKS, ((0.95, 0.95), (1.2, 1.2), (1.0, 1.0)), False), (WORKS, ((0.5, 0.5), (0.7, 0.7)), True),
        (WORKS, ((1.6, 1.6), (1.7, 1.7), (2, 2)), True),
        # What sleeps for a sixth of its time saves that in slices, on a fast machine as on a slow one.
        (WAITS, ((1.2, 1.2), (1.5, 1.5), (1.1, 1.1)), True), (WAITS, ((1.2, 1.0), (1.1, 0.9)), False),
    ],
)  # fmt: skip
def test_what_disagrees_beyond_noise_minds(
    undisturbed: Sequence[tuple[float, float]], in_slices: Sequence[tuple[float, float]], *, expected: bool
) -> None:
    assert (
        may_disagree([result(*one) for one in undisturbed], [result(*one) for one in in_slices]) == expected
    )


def test_waiting_for_a_processor_is_no_minding() -> None:
    assert may_disagree([result(1.0, 0.9)], [result(2.5, 0.9)])
    assert not may_disagree([result(1.0, 0.9)], [result(2.5, 0.9, waited_seconds=1.5)])


class Told(Sampler):
    """Tells of each program, by its name, how long its next runs take: without a pause, and in slices."""

    def __init__(self, alone: dict[str, list[RunResult]], in_slices: dict[str, list[RunResult]]) -> None:
        self._alone, self._in_slices = alone, in_slices

    def run(
        self,
        commands: Sequence[ProcessCommand],
        slice_seconds: float = 1.0,  # noqa: ARG002 - as the real one has it
        seed: int = 0,  # noqa: ARG002
    ) -> list[RunResult]:
        told = self._in_slices if len(commands) > 1 else self._alone
        return [told[one.command[0]].pop(0) for one in commands]


ONE, TWO, IDLE, FAILED = result(1, 1), result(2, 2), result(1, 0), result(1, 1, exit_code=3)
JUDGED = {
    "all agree at once": ([ONE], [ONE], [ONE], [ONE], (True, True)),
    "noise, then all agree": ([ONE, ONE], [ONE], [TWO, ONE], [ONE, ONE], (True, True)),
    "one disagrees each time": ([ONE] * 3, [ONE], [TWO] * 3, [ONE] * 3, (False, False)),
    "one fails in slices": ([ONE], [ONE], [FAILED], [ONE], (False, True)),
    "one is idle": ([IDLE], [ONE], [], [], (False, False)),
}


@pytest.mark.parametrize(
    ("alone", "other_alone", "sliced", "other_sliced", "are_sliced"), JUDGED.values(), ids=JUDGED
)
def test_who_was_in_slices_at_last(
    tmp_path: Path,
    alone: list[RunResult],
    other_alone: list[RunResult],
    sliced: list[RunResult],
    other_sliced: list[RunResult],
    are_sliced: tuple[bool, bool],
) -> None:
    sampler = Told({"a": [*alone], "b": [*other_alone]}, {"a": [*sliced], "b": [*other_sliced]})
    ended = Contest(sampler, [Contender(("a",)), Contender(("b",))], 0.01, 1, tmp_path).measure()
    assert tuple(one.is_sliced for one in ended) == are_sliced
    assert [bool(one.undisturbed) for one in ended] == [not one for one in are_sliced]
    assert [one.failure for one in ended] == ["", ""]
    assert all(one.runs == [ONE] or one.runs == [IDLE] for one in ended)


@needs_carom
def test_the_record_says_what_was_run_and_what_became_of_it(
    sampler: Sampler, measure: Measure, tmp_path: Path
) -> None:
    often = scripted(
        f"echo $OMP_NUM_THREADS > out; {appending('x', tmp_path / 'runs')}; exit $(($(wc -c < runs) % 2))",
        folder=str(tmp_path), environment={"OMP_NUM_THREADS": "3"}, exit_codes=(0, 1), rounds=3,
    )  # fmt: skip
    ended = measure(often, scripted("echo it took 250 ms", pattern="took ([0-9]+)"), seed=9)
    build = {"compiler": "GNU 1", "openmp": {"runtime": "none"}}
    sources, around = Sources([Path("/bin/sh")], {}), sampler.surroundings(3, None)
    its = Described({"a": "1", "b": "x"}, {"threads": 3}, sources, "trajectory", build, around)
    whole = process_record([(one, its) for one in ended], 9)
    assert is_record(whole)
    assert (whole["kind"], whole["turns"]) == ("process", {"seed": 9})
    record, printed = whole["contenders"]
    process, provenance = record["process"], whole["provenance"] | record["provenance"]
    assert (record["tags"], record["axes"]) == ({"a": 1, "b": "x"}, {"threads": 3})
    assert printed["provenance"].keys() == {"openmp"}, "all else is as of the first"
    assert record["check"] == {"verdict": "passed", "scope": "trajectory", "reason": None}
    assert (process["command"], process["time_from"]) == ([*often.words], "outside")
    assert (process["exit_codes"], process["exit_code"], process["runs"]) == ([1, 0, 1], 1, 3)
    assert process["sources"][0]["sha256"] == provenance["binary_sha256"]
    assert process["tree"] in ("cgroup", "subreaper")
    assert (process["changed"], process["undisturbed"]) == ([], None)
    assert provenance["openmp"]["environment"] == {"OMP_NUM_THREADS": "3"}
    assert (provenance["openmp"]["runtime"], provenance["compiler"]) == ("none", "GNU 1")
    assert "compiler_flags" in provenance, "what is not said stays that of the sampler"
    assert len(record["slices"]["seconds"]) == len(record["repetitions"]) == 3
    assert sum(one["steps_seconds"] for one in record["repetitions"]) == pytest.approx(
        record["process_seconds"]
    )
    assert (tmp_path / "out").read_text() == "3\n"
    assert printed["repetitions"][0]["steps_seconds"] == pytest.approx(0.25)
    assert (printed["process"]["time_from"], printed["slices"]) == ("the program", None)
    ended[0].failure = "no room"
    partly = process_record([(one, its) for one in ended], 9)
    assert is_record(partly)
    assert (partly["kind"], partly["contenders"][0]["reason"]) == ("process", "no room")


@needs_carom
def test_the_most_memory_of_all_runs_is_told(sampler: Sampler, measure: Measure, tmp_path: Path) -> None:
    large = "head -c 200000000 /dev/zero | tail -n 1 > /dev/null"
    ended = measure(scripted(f"mkdir {tmp_path}/once 2> /dev/null && {large}; exit 0", rounds=2))
    its = Described({}, {"threads": 1}, Sources([CAROM], {}), surroundings=sampler.surroundings(1, None))
    whole = process_record([(ended[0], its)], 1)
    [record] = whole["contenders"]
    assert whole["turns"] is record["slices"] is None, "nobody took turns with it"
    assert record["process"]["peak_memory_bytes"] > 150_000_000


def test_files_that_a_program_changed_are_told(tmp_path: Path) -> None:
    data, touched, gone = (tmp_path / name for name in ("data", "touched", "gone"))
    for file in (data, touched, gone):
        file.write_text("3\n1\n")
    sources = Sources([data, touched, gone], {})
    data.write_text("1\n3\n")
    touched.write_text("3\n1\n")
    gone.unlink()
    assert sources.changed() == [data, gone]
    first = sources.hashes[data]
    assert first == hashlib.sha256(b"3\n1\n").hexdigest()
    # Its own output counts by what it was when it was first seen.
    written = Sources([data], {data: first})
    data.write_text("9\n")
    assert (written.changed(), written.hashes[data]) == ([], first)


@needs_carom
def test_what_prints_more_than_could_be_kept_says_so(sampler: Sampler, tmp_path: Path) -> None:
    [ended] = sampler.run([ProcessCommand(("echo", "took 1 ms"), output_file=str(tmp_path / "no" / "file"))])
    one = Entrant(scripted("", pattern="took (.*)"), tmp_path / "no" / "file")
    one.keep(ended)
    assert one.failure.startswith("time: found 10 bytes of standard output, of which only 0 could be kept")
