"""A point that fails, crashes, hangs or is not built is recorded with its reason, and the others go on."""

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.plan.scenes import sha256_of
from experiments.run.session import run
from experiments.run.study import POINTS_FAILED
from experiments.tests.conftest import PAIR_OF_BUILDS, Workplace
from support.record_schema import is_record

FAILURES = {
    "check": ("FAKE_CHECK_FAILS", "check of each step: step 3: discs 1 and 2 left colliding", 2),
    "result": ("FAKE_RESULT_WRONG", "energy changed by 3 %", 2),
    "crash": ("FAKE_BENCH_CRASHES", "killed by SIGABRT: out of memory", -6),
    "no record": ("FAKE_NO_RECORD", "left no record", 1),
}


@pytest.mark.parametrize(("behaviour", "reason", "code"), FAILURES.values(), ids=FAILURES.keys())
def test_a_failed_point_is_recorded_and_the_others_go_on(
    workplace: Workplace, behaviour: str, reason: str, code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    workplace.behave(**{behaviour: "nine"})
    assert run(workplace.settings) == POINTS_FAILED
    [failure] = workplace.failures()
    for file in workplace.files():
        assert is_record(json.loads(file.read_bytes()))
    assert len(workplace.files("pair")) == 2, "what failed stands beside what was measured"
    assert (failure["reason"], failure["exit_code"]) == (reason, code)
    assert failure["axes"]["variant"] == "nine"
    assert failure["tags"]["experiment"] == "pair"
    assert failure["tags"]["host"] == os.uname().nodename
    assert failure["tags"]["program_sha256"] == sha256_of(workplace.program)
    assert len(workplace.records("pair")) == 2, "the other variant, in both blocks"
    assert len(workplace.records("chunks")) == 6
    assert "nine" not in {one["axes"]["variant"] for one in workplace.records().values()}
    row = workplace.rows()["pair"]
    assert (row.done, row.failed, row.missing, row.reason) == (2, 2, 0, reason)
    told = capsys.readouterr()
    assert "points failed: pair (1)" in told.err
    assert "16 of 16" not in told.out, "what failed is not done"


def test_what_was_suspended_is_measured_again_together(workplace: Workplace) -> None:
    reason = "was suspended for some time while it was measured; measure it again"
    workplace.behave(FAKE_SUSPENDED="turns")
    assert run(workplace.settings) == POINTS_FAILED
    assert not workplace.records("pair")
    failures = workplace.failures()
    assert all(one["exit_code"] == 1 and one["reason"].endswith(reason) for one in failures)
    failed = {(one["tags"]["experiment"], one["tags"]["series"]) for one in failures}
    calls = workplace.calls()
    together = {call["pid"] for call in calls if call["words"][0] == "turns"}
    alone = [call for call in calls if "--tag" in call["words"] and call["pid"] not in together]
    assert failed >= {("pair", "four"), ("pair", "nine")}
    assert not alone, "nobody's partner is measured without it"
    workplace.behave(FAKE_SUSPENDED="none")
    assert run(workplace.settings) == 0
    assert not workplace.failures()
    assert len(workplace.records("pair")) == 4


def test_a_process_that_hangs_is_stopped(workplace: Workplace) -> None:
    site = Path(__file__).parents[2] / "sites" / "local.toml"
    impatient = workplace.root / "impatient.toml"
    impatient.write_text(site.read_text().replace("time_limit_seconds = 600", "time_limit_seconds = 0.5"))
    workplace.behave(FAKE_HANGS="nine")
    assert run(replace(workplace.settings, site=str(impatient))) == POINTS_FAILED
    [failure] = workplace.failures()
    assert failure["reason"] == "took longer than 0.5 s and was stopped"
    assert len(workplace.records("pair")) == 2


def test_a_build_that_is_missing_is_a_gap_with_a_remedy(workplace: Workplace) -> None:
    workplace.question("pair", PAIR_OF_BUILDS)
    assert run(workplace.settings) == 0
    [failure] = workplace.failures()
    assert "is not built; build it with `make build COMPILER=clang`" in failure["reason"]
    done = workplace.measured()
    assert run(workplace.settings) == 0
    assert workplace.measured() == done, "as long as it is not there, nothing else is measured again"
    workplace.build("clang")
    assert run(workplace.settings) == 0
    assert workplace.is_whole()
    assert workplace.rows()["pair"].done == 4
    assert not workplace.failures()


def test_what_one_build_can_measure_comes_before_the_other_is_built(
    workplace: Workplace, capsys: pytest.CaptureFixture[str]
) -> None:
    workplace.question("pair", PAIR_OF_BUILDS)
    assert run(replace(workplace.settings, builds=("gcc",))) == 0
    assert "the study is complete" not in capsys.readouterr().out
    assert (len(workplace.records("control")), len(workplace.records("pair"))) == (2, 0)
    assert not workplace.failures()
    workplace.build("clang")
    assert run(workplace.settings) == 0
    assert "the study is complete" in capsys.readouterr().out
    assert len(workplace.records("pair")) == 4
    assert len(workplace.records("control")) == 6, "the control goes on beside the rest"
