import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.synthetic import Machine, Point, bench, failure, whole, write
from analysis.tests.synthetic_study import failures, study

TURNS = {"seed": 1, "steps": [2] * 3, "seconds": [1.0] * 3, "returning_seconds": [0.5] * 3}


def record(**tags: str | float) -> dict[str, Any]:
    return bench("steps", Point("checkered", 20, 1.0, "steps"), 0, [1.0, 1.1], Machine(), **tags)


def changed(**more: Any) -> bytes:  # noqa: ANN401
    """Return a record with other values."""
    return json.dumps(whole(record() | more)).encode()


def turns(contenders: list[int], rounds: int) -> bytes:
    return changed(turns=TURNS | {"contenders": contenders, "rounds": rounds})


NAMED = {"experiment": "steps", "series": "a", "x_name": "steps", "block": 0}
OF_TURNS = "$.turns.contenders: expected rounds with a turn of each of 1, "


def test_one_row_a_process_a_record_a_phase_a_counter(tmp_path: Path) -> None:
    write(tmp_path, study(["neighbourhood", "phases"], blocks=3, repetitions=2))
    write(tmp_path, failures())
    records = load(tmp_path, warn=pytest.fail)
    assert len(records.runs) == 2 * 3 + 3 * 3
    assert [len(runs) for runs in records.times["steps_seconds_of_runs"]] == 2 * 3 * [2]
    assert len(records.phases) == 3 * 3 * 4
    assert len(records.threads) == 3 * 3 * 4 * 2
    assert len(records.counters) == 3 * 3 * (2 + 2 * 6)
    assert records.counters.loc[records.counters["name"] == "PAPI_TOT_CYC", "value"].isna().all()
    assert list(records.failures["reason"]) == [
        "step 2: disc 4 left moving into the wall",
        "step 3: discs 1 and 2 are still colliding",
    ]
    first = records.times.iloc[0]
    assert (first["experiment"], first["threads"], first["particles"]) == ("neighbourhood", 2, 100_000)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "not JSON (line 1, column 1"),
        (b'{"schema_version": 1, "kind": "ben', "not JSON (line 1"),
        (b'{"host": "\xff"}', "not UTF-8"),
        (b"[1, 2]", "not a Carom record"),
        (b"[" * 100_000, "nested too deeply"),
        (b"1" * 5000, "not JSON"),
        (b'{"schema_version": 2, "kind": "failure", "exit_code": NaN}', "NaN"),
        (b'{"schema_version": 2, "kind": "failure", "exit_code": 1e999}', "1e999"),
        (b'"\\ud800"', "not a Carom record"),
        (b'{"context": {}, "benchmarks": []}', "not a Carom record"),
        (b'{"schema_version": 2, "kind": "bench", "contenders": []}', "$"),
        (changed(repetitions=[{"steps_seconds": 0, "cpu_seconds": 1}]),
         "$.contenders[0].repetitions[0].steps_seconds"),
        (changed(tags={"experiment": "steps"}), "$.contenders[0].tags.series: missing"),
        (changed(tags={**NAMED, "x": "many"}), "$.contenders[0].tags.x: found 'many', expected a number"),
        (turns([0, 0, 1], 3), f"{OF_TURNS}3 a run"),
        (turns([0, 0, 0], 2), f"{OF_TURNS}2 a run"),
        (turns([0, 0], 2), "$.turns.steps: found 3, expected one for each of 2 turns"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_record_is_named_and_left_out(
    tmp_path: Path, content: bytes, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path, study(["steps"], blocks=1))
    foreign = tmp_path / "records" / "steps" / "foreign.json"
    foreign.write_bytes(content)
    records = load(tmp_path)
    assert len(records.runs) == 10
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith(f"{foreign}: skipped: ")
    assert said in lines[0]


def test_records_of_an_older_schema_are_refused_in_one_line(tmp_path: Path) -> None:
    write(tmp_path, study(["steps"], blocks=1))
    for path in (tmp_path / "records").rglob("*.json"):
        path.write_text(path.read_text().replace('"schema_version": 2', '"schema_version": 1'))
    lines: list[str] = []
    assert load(tmp_path, lines.append).runs.empty
    [line] = lines
    assert line.endswith(
        "skipped: schema version 1, expected 2: measure it again, or read it with the release of Carom that "
        "wrote it (and 9 more alike)"
    )


def process(contenders: int, block: int, rounds: int = 6) -> dict[str, Any]:
    """The record of contenders that took turns, in which contender 1 takes 10 % more than 0, on a machine
    whose speed changes after every tenth turn.
    """
    random = np.random.default_rng(block)
    whose = np.concatenate([random.permutation(contenders) for _ in range(rounds)])
    speed = np.repeat(1 + 0.5 * random.integers(2, size=contenders * rounds // 10 + 1), 10)[: len(whose)]
    turns = {
        "seed": block,
        "rounds": rounds,
        "contenders": whose.tolist(),
        "steps": [2] * len(whose),
        "seconds": (speed * (1 + 0.1 * (whose == 1))).tolist(),
        "returning_seconds": (0.6 * speed).tolist(),
    }
    points = (Point(f"series {number}", 20, 1.0) for number in range(contenders))
    return whole(*(bench("steps", point, block, [1.0], Machine()) | {"turns": turns} for point in points))


@pytest.mark.parametrize(("contenders", "what"), [(20, ""), (4, ""), (6, "failed"), (6, "of two scenes")])
def test_of_many_that_took_turns_one_value_each_is_left(tmp_path: Path, contenders: int, what: str) -> None:
    """Of few, or if somebody failed or had another scene, all rounds are."""
    (tmp_path / "records").mkdir()
    is_joint = contenders == 20
    for block in range(2):
        made = process(contenders, block)
        if what == "failed":
            made["turns"]["seconds"][made["turns"]["contenders"].index(3)] = 0.0
            made["contenders"][3] = whole(failure("steps", "series 3", "crashed"))["contenders"][0]
        if what == "of two scenes":
            made["contenders"][3]["scene"]["sha256"] = "f" * 64
        (tmp_path / "records" / f"{block}.json").write_text(json.dumps(made))
    records = load(tmp_path, warn=pytest.fail)
    assert len(records.times) == 2 * contenders - 2 * (what == "failed")
    assert len(records.failures) == 2 * (what == "failed")
    assert records.times["file"].is_unique
    assert records.times["in_turns"].all()
    rounds = records.times["steps_seconds_of_rounds"]
    assert set(rounds.map(len)) == {1 if is_joint else 6}
    first, second = (rounds[records.times["series"] == f"series {number}"] for number in range(2))
    for one, other in zip(first, second, strict=True):
        assert np.median(other / one) == pytest.approx(1.1, rel=0.02) or not is_joint


def test_a_copied_record_counts_once(tmp_path: Path) -> None:
    write(tmp_path, [record()])
    original = next((tmp_path / "records").rglob("*.json"))
    (original.parent / "copy.json").write_bytes(original.read_bytes())
    lines: list[str] = []
    assert len(load(tmp_path, lines.append).runs) == 1
    assert "the same record as" in lines[0]


def test_a_failed_check_has_no_time(tmp_path: Path) -> None:
    wrong = record() | {
        "repetitions": [],
        "check": {"verdict": "failed", "scope": "last-step", "reason": "step 100: energy drifts"},
    }
    write(tmp_path, [wrong])
    records = load(tmp_path)
    assert records.times.empty
    assert list(records.runs["check_verdict"]) == ["failed"]


def test_a_failure_belongs_to_the_machine_and_the_program_that_it_tells(tmp_path: Path) -> None:
    hosts = [Machine(host="one"), Machine(host="two")]
    for machine in hosts:
        write(tmp_path, study(["steps"], blocks=1, machine=machine))
    known = {one.host: one.provenance("g++ 12.2.0", 2)["binary_sha256"] for one in hosts}
    for number, tags in enumerate(
        (
            {"host": "one", "program_sha256": known["one"]},
            {"host": "two", "program_sha256": "of no record"},
            {"host": "three"},
            {"partition": "two", "host": "node"},
            {},
        )
    ):
        write(tmp_path, [failure("steps", "checkered", str(number), point=f"p{number}", **tags)])
    found = {one.machine.split(":")[0]: set(one.failures["reason"]) for one in split(load(tmp_path))}
    assert found == {"one": {"0", "4"}, "two": {"1", "3", "4"}}


def test_machines_revisions_and_scales_are_never_merged(tmp_path: Path) -> None:
    machines = [Machine(), Machine(host="bench-2"), Machine(commit="f" * 40)]
    for machine in machines:
        write(tmp_path / machine.host / machine.commit, study(["steps"], blocks=2, machine=machine))
    write(tmp_path / "quick", study(["steps", "particles"], blocks=2, scale="quick"))
    flat = tmp_path / "all"
    (flat / "records").mkdir(parents=True)
    for number, path in enumerate(sorted(tmp_path.rglob("*-b*.json"))):
        path.rename(flat / "records" / f"{number}.json")
    studies = split(load(flat, warn=pytest.fail))
    assert [(one.scale, len(one.runs)) for one in studies] == [("paper", 20)] * 3 + [("quick", 40)]
    assert len({one.name for one in studies}) == 4


def test_the_nodes_of_a_partition_are_one_machine(tmp_path: Path) -> None:
    for node in ("n1", "n2"):
        machine = Machine(host=node, partition="xs-4114")
        write(tmp_path, study(["steps"], blocks=2, machine=machine))
    studies = split(load(tmp_path))
    assert [one.machine for one in studies] == ["xs-4114: Example CPU @ 2.50GHz"]
    assert set(studies[0].runs["node"]) == {"n1", "n2"}


def test_a_machine_with_a_quota_is_another_one(tmp_path: Path) -> None:
    for number, quota in enumerate((None, 1.5, 64.0)):
        records = study(["steps"], blocks=2)
        for record in records:
            record["provenance"]["cpu_quota"] = quota
        write(tmp_path / str(number), records)
        (one,) = split(load(tmp_path / str(number)))
        assert one.machine.endswith(", a quota of 1.5 processors") == (quota == 1.5)


def test_a_series_of_two_programs_makes_two_studies_and_two_series_one(tmp_path: Path) -> None:
    def measured(series: str, compiler: str, block: int) -> dict[str, Any]:
        point = Point(series, 20, 1.0, "steps", compiler=compiler)
        made = bench("steps", point, block, [1.0], Machine())
        made["tags"]["point"] = f"{series}-{compiler.replace(' ', '-')}"
        return made

    old, new, clang = "g++ 12.2.0", "g++ 13.1.0", "clang 14.0.6"
    write(tmp_path, [measured("gcc", old, block) for block in range(3)] + [measured("clang", clang, 0)])
    (one,) = split(load(tmp_path))
    assert (one.program, set(one.times["compiler"])) == ("", {old, clang})
    write(tmp_path, [measured("gcc", new, block) for block in range(2)])
    of_new = measured("gcc", new, 0)["provenance"]["binary_sha256"]
    write(tmp_path, [failure("steps", "gcc", "crash", host="bench-1", program_sha256=of_new)])
    first, second = split(load(tmp_path))
    assert [set(one.times["compiler"]) for one in (first, second)] == [{old, clang}, {new}]
    assert [len(one.failures) for one in (first, second)] == [0, 1]
    assert first.program in first.name
    assert first.name != second.name
