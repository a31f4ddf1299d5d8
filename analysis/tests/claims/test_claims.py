from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import pandas as pd
import pytest

from analysis import claims
from analysis.claims import missing
from analysis.claims.outcome import FAILS, HOLDS, OPEN, Verdict
from analysis.figures.style import Data
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.claims.judging import row_of, slowed, verdicts_of
from analysis.tests.synthetic import Machine, write
from analysis.tests.synthetic_noise import QUIET, Noise
from analysis.tests.synthetic_points import EXPERIMENTS
from analysis.tests.synthetic_study import study

IDS = [
    "threads", "particles", "grid_length", "radius", "steps", "velocity", "machine", "four_boxes",
    "self_contained_checkered", "self_contained_sequential", "find_schedule", "resolve_schedule",
    "row_schedule", "row", "reverse", "compiler", "resolve_dominates",
]  # fmt: skip


def test_every_published_claim_has_its_row_and_its_verdict(data: Data) -> None:
    table = claims.evaluate(data).set_index("id")
    assert list(table.index) == IDS
    verdicts = table["verdict"].drop("machine")
    without_threads = [one.id for one in claims.load() if one.published.threads is None]
    assert without_threads == ["threads", "reverse"]
    assert verdicts[without_threads].eq(HOLDS).all()
    assert verdicts.drop(without_threads).eq(Verdict.HOLDS_ELSEWHERE).all()
    assert table["measured"].drop("machine").str.contains(r"\[").all()


def test_one_machine_cannot_decide_about_machines(data: Data) -> None:
    row = claims.evaluate(data).set_index("id").loc["machine"]
    assert row["verdict"] == OPEN
    assert "only one is present" in row["why"]


@pytest.fixture(scope="module")
def verdicts_of_one(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], pd.DataFrame]:
    """The verdicts where one experiment alone was measured."""

    @cache
    def verdicts(experiment: str) -> pd.DataFrame:
        folder = tmp_path_factory.mktemp(experiment)
        write(folder, study([experiment], blocks=2, noise=QUIET))
        return verdicts_of(folder)

    return verdicts


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_without_its_records_a_claim_is_open_and_says_so(
    verdicts_of_one: Callable[[str], pd.DataFrame], experiment: str
) -> None:
    table = verdicts_of_one("compiler" if experiment != "compiler" else "steps")
    bearing = table[[experiment in names for names in table["experiments"]]]
    assert (bearing["verdict"] == OPEN).all()
    assert bearing["missing"].all()
    assert not bearing["figures"].any()
    assert bearing["why"].str.contains("no records yet").all()


def test_noise_leaves_a_ratio_claim_open(tmp_path: Path) -> None:
    records = study(["neighbourhood"], blocks=14, noise=Noise(process=0.05), threads=20)
    row = row_of(tmp_path, slowed(records, 1.25 / 1.19, series="four"), "four_boxes")
    assert row["verdict"] == OPEN
    assert "14 blocks" in row["measured"].replace("\u00a0", " ")
    assert "more blocks" in row["why"]


def test_the_command_that_would_settle_a_claim_names_the_folder_of_its_question(tmp_path: Path) -> None:
    write(tmp_path, study(["neighbourhood"], blocks=2))
    (measured,) = split(load(tmp_path))
    (claim,) = (replace(one, questions="my questions") for one in claims.load() if one.id == "four_boxes")
    command = "`make experiments STUDY=neighbourhood QUESTIONS='my questions' BUDGET="
    assert command in missing.said(measured, claim, 10, 20)


@pytest.mark.parametrize(
    ("machine", "verdict", "said"),
    [
        (Machine(cores=2, hardware_threads=4), HOLDS, ""),
        (Machine(cores=2, hardware_threads=2), OPEN, "more hardware threads than cores"),
        (Machine(cores=8, hardware_threads=16), FAILS, "expected faster"),
    ],
)
def test_the_thread_claim_needs_the_machine_to_have_its_stretches(
    tmp_path: Path, machine: Machine, verdict: str, said: str
) -> None:
    write(tmp_path, study(["threads"], blocks=9, machine=machine, noise=QUIET))
    if machine.cores == 8:
        for path in tmp_path.rglob("*.json"):
            if '"x": 1,' in (text := path.read_text()):
                path.write_text(text.replace('"steps_seconds": 6.', '"steps_seconds": 2.'))
    row = verdicts_of(tmp_path).loc["threads"]
    assert row["verdict"] == verdict
    assert said in row["why"]


@pytest.mark.parametrize(("speed", "verdict"), [(1.5, HOLDS), (1.0, FAILS), (0.8, FAILS)])
def test_the_machine_claim_orders_machines_by_clock(tmp_path: Path, speed: float, verdict: str) -> None:
    slow = Machine(host="a", cpu_model="Intel Xeon Silver 4114 CPU @ 2.20GHz")
    fast = Machine(host="b", cpu_model="13th Gen Intel(R) Core(TM) i7-13700")
    write(tmp_path, study(["machine"], machine=slow, noise=QUIET, threads=16))
    write(tmp_path, study(["machine"], machine=fast, noise=QUIET, speed=speed, threads=16))
    row = verdicts_of(tmp_path).loc["machine"]
    assert row["verdict"] == verdict
    assert "3.0 GHz" in row["measured"]
    assert "5.1 GHz" in row["measured"]


def test_a_machine_speaks_with_the_records_of_the_revision_that_is_judged(tmp_path: Path) -> None:
    slow, fast = "Intel Xeon Silver 4114 CPU @ 2.20GHz", "13th Gen Intel(R) Core(TM) i7-13700"
    for machine, speed in (
        (Machine(host="a", cpu_model=slow, commit="0" * 40), 4.0),
        (Machine(host="a", cpu_model=slow, commit="1" * 40), 1.0),
        (Machine(host="b", cpu_model=fast), 2.0),
    ):
        folder = tmp_path / "records" / f"{machine.host}{machine.commit[0]}"
        write(folder, study(["machine"], machine=machine, noise=QUIET, speed=speed, threads=16))
    verdicts = {}
    for one in claims.evidence_of(load(tmp_path)):
        table = claims.evaluate(one).set_index("id")
        verdicts[one.study.machine[0], one.study.revision[0]] = table.loc["machine", "verdict"]
    assert (verdicts["a", "0"], verdicts["a", "1"]) == (FAILS, HOLDS)


def test_a_ratio_claim_needs_both_sides_at_the_same_x(tmp_path: Path) -> None:
    records = [
        record
        for record in study(["row"], blocks=8, noise=QUIET)
        if (record["tags"]["x"] > 50_000) == (record["tags"]["series"] == "row")
    ]
    row = row_of(tmp_path, records, "row")
    assert row["verdict"] == OPEN
    assert "of row and checkered at the same particles" in row["why"]
