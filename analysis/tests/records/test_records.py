import json
from pathlib import Path
from typing import Any

import pytest

from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.synthetic import Machine, Point, bench, failure, write
from analysis.tests.synthetic_study import failures, study


def record(**tags: str | float) -> dict[str, Any]:
    return bench("steps", Point("checkered", 20, 1.0, "steps"), 0, [1.0, 1.1], Machine(), **tags)


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
        (b'{"context": {}, "benchmarks": []}', "not a Carom record"),
        (b'{"schema_version": 0, "kind": "bench", "tags": {}}', "schema version 0, expected 1"),
        (b'{"schema_version": 1, "kind": "bench", "tags": {}}', "$"),
    ],
)
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


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"repetitions": [{"steps_seconds": 0, "cpu_seconds": 1}]}, "$.repetitions[0].steps_seconds"),
        ({"tags": {"experiment": "steps"}}, "$.tags.series: missing"),
        (
            {"tags": {"experiment": "steps", "series": "a", "x_name": "steps", "x": "many", "block": 0}},
            "$.tags.x: found 'many', expected a number",
        ),
    ],
)
def test_a_record_out_of_bounds_is_named_by_its_key(
    tmp_path: Path, change: dict[str, Any], said: str
) -> None:
    path = tmp_path / "records" / "wrong.json"
    path.parent.mkdir()
    path.write_text(json.dumps(record() | change))
    lines: list[str] = []
    assert load(tmp_path, lines.append).runs.empty
    assert said in lines[0]


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


def test_a_failure_of_one_of_two_programs_is_not_the_others(tmp_path: Path) -> None:
    first, second = study(["steps"], blocks=2), study(["steps"], blocks=1)
    for number, record in enumerate(second):
        record["provenance"]["binary_sha256"] = "a" * 64
        record["tags"]["point"] = f"other-{number}"
    write(tmp_path, [*first, *second])
    write(tmp_path, [failure("steps", "checkered", "crash", host="bench-1", program_sha256="a" * 64)])
    studies = split(load(tmp_path))
    assert [len(one.failures) for one in studies] == [0, 1]


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
    first, second = split(load(tmp_path))
    assert [set(one.times["compiler"]) for one in (first, second)] == [{old, clang}, {new}]
    assert first.program in first.name
    assert first.name != second.name
