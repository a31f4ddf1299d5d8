"""What is open is measured on until it is settled, as the analysis program says, and no further."""

import json
import re
import shutil
from dataclasses import replace

import pytest

from experiments.plan import scale
from experiments.run import session
from experiments.run.session import run
from experiments.run.study import Study
from experiments.run.verdicts import Analysis, Open, Verdicts
from experiments.tests.conftest import CHUNKS, PAIR, Workplace, finish


def blocks_of(workplace: Workplace, experiment: str) -> int:
    return 1 + max(one["tags"]["block"] for one in workplace.records(experiment).values())


def want(workplace: Workplace, **blocks: int) -> None:
    (workplace.root / "needed").write_text(json.dumps(blocks))


@pytest.mark.parametrize(
    ("needed", "until", "decided"),
    [
        ({"pair": 7, "chunks": 2}, ("--budget", "5"), {"pair": 7, "chunks": 4}),
        # Of what rests on two questions more of the one that has its blocks would settle nothing.
        ({"pair+chunks": 5}, ("--budget", "5"), {"pair+chunks": 7}),
        ({"pair": 20, "chunks": 11}, ("--until-decided",), {"pair": 22, "chunks": 13}),
    ],
)
def test_what_is_open_goes_on_from_look_to_look_and_what_is_settled_stops(
    needing: Workplace, needed: dict[str, int], until: tuple[str, ...], decided: dict[str, int]
) -> None:
    want(needing, **needed)
    code, output, error = finish(needing.start("run", *until))
    assert (code, error) == (0, "no ink\n")
    for claim, blocks in decided.items():
        assert f"decided: {claim} holds from {blocks} blocks" in output
        assert {blocks_of(needing, name) for name in claim.split("+")} == {blocks}
    looks = [json.loads(line)["pair"] for line in (needing.root / "looks").read_text().splitlines()]
    assert looks == [*range(1, looks[-1] + 1, 3)], "nothing is looked at between two looks"


def test_a_finished_study_is_left_alone_until_a_budget_is_given(needing: Workplace) -> None:
    want(needing, pair=2, chunks=2)
    assert finish(needing.start("run", "--budget", "5"))[0] == 0
    want(needing, pair=5, chunks=2)
    assert finish(needing.start("run"))[0] == 0
    assert blocks_of(needing, "pair") == 4
    assert finish(needing.start("run", "--budget", "1"))[0] == 0
    assert blocks_of(needing, "pair") == 7


@pytest.mark.parametrize(("share", "blocks"), [(0.0, 0), (1e7, 10)])
def test_a_slow_machine_still_has_time_to_decide(
    needing: Workplace, monkeypatch: pytest.MonkeyPatch, share: float, blocks: int
) -> None:
    want(needing, pair=8, chunks=2)
    needing.monkeypatch.chdir(needing.root)
    short = replace(scale.SCALES["paper"], budget_seconds=1e-6, report_seconds=0.0)
    monkeypatch.setitem(scale.SCALES, "paper", short)
    monkeypatch.setattr(session, "DECIDING_SHARE", share)
    assert run(replace(needing.settings, figures=True, study=("pair", "chunks"))) == 0
    assert (blocks_of(needing, "pair") if blocks else len(needing.records("pair"))) == blocks


def test_nothing_is_decided_before_all_builds_are_there(needing: Workplace) -> None:
    want(needing, pair=8, chunks=2)
    assert finish(needing.start("run", "--builds", "gcc", "--budget", "5"))[0] == 0
    assert (blocks_of(needing, "pair"), blocks_of(needing, "chunks")) == (1, 1)
    assert finish(needing.start("run", "--budget", "5"))[0] == 0
    assert blocks_of(needing, "pair") == 10


def test_the_time_of_the_part_before_the_other_builds_is_part_of_the_budget(needing: Workplace) -> None:
    want(needing, pair=8, chunks=2)
    assert finish(needing.start("run", "--builds", "gcc", "--budget", "5"))[0] == 0
    note = needing.settings.results / "begun.json"
    ((asked, seconds),) = json.loads(note.read_text()).items()
    assert 0 < seconds < 60
    note.write_text(json.dumps({asked: 300 + seconds}))
    assert finish(needing.start("run", "--budget", "5"))[0] == 0
    assert blocks_of(needing, "pair") == 1


def test_an_analysis_that_fails_leaves_the_budget_to_the_old_rule(needing: Workplace) -> None:
    (needing.root / "broken").touch()
    needing.question("pair", PAIR.replace("wanted = 2", "wanted = 4"))
    code, _, error = finish(needing.start("run", "--budget", "5"))
    assert code == 1
    assert error.splitlines() == [
        "what is open is not known, so that nothing is measured to settle it: no statistics",
        "the report could not be written: report.html: No space left on device, expected a writable place"
        " with room",
    ]
    assert blocks_of(needing, "pair") == 4


def test_the_report_of_what_is_there_is_written_while_the_study_runs(
    needing: Workplace, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    want(needing, pair=2, chunks=2)
    needing.monkeypatch.chdir(needing.root)
    monkeypatch.setattr(session, "REPORT_PAUSE", 0.0)
    monkeypatch.setattr(session, "REPORT_SHARE", 1e6)
    settings = replace(needing.settings, figures=True, study=("pair", "chunks"))
    assert run(settings) == 0
    *asked, last = (needing.root / "reports").read_text().splitlines()
    assert len(asked) >= 7, "after each block"
    assert last == ""
    assert all(re.fullmatch(r"\d+ of \d+ processes done, about \d+ (s|min) left", line) for line in asked)
    assert capfd.readouterr().out.count("report of what is there: results/report.html") == len(asked)
    (needing.root / "reports").unlink()
    monkeypatch.setattr(session, "REPORT_PAUSE", 300.0)
    shutil.rmtree(needing.results)
    assert run(settings) == 0
    assert (needing.root / "reports").read_text() == "\n", "a short study needs no other"


def test_the_analysis_itself_is_asked_and_writes(workplace: Workplace) -> None:
    run(workplace.settings)
    analysis = Analysis(workplace.results, ["pair"])
    expected = Open(blocks=2, next=6, needed=6)
    assert {name: one for name, one in analysis.verdicts().open.items() if name == "pair"} == {
        "pair": expected
    }
    assert analysis.verdicts().settled == frozenset()
    page = analysis.report("2 of 9 processes done")
    assert (page, "2 of 9 processes done" in page.read_text()) == (workplace.results / "report.html", True)


def test_values_taken_out_of_a_finished_question_are_no_longer_planned(workplace: Workplace) -> None:
    run(workplace.settings)
    plan = json.loads((workplace.results / "plan.json").read_text())["paper"]["chunks"]
    assert (plan["blocks"], len(plan["points"])) == (2, 3)
    workplace.question("chunks", CHUNKS.replace("values = [1, 2, 3]", "values = [1, 2]"))
    run(workplace.settings)
    plan = json.loads((workplace.results / "plan.json").read_text())["paper"]["chunks"]
    assert (plan["blocks"], len(plan["points"])) == (2, 2)
    assert len(workplace.records("chunks")) == 4


def test_what_was_spent_on_a_question_counts_towards_what_settling_it_costs(workplace: Workplace) -> None:
    run(replace(workplace.settings, figures=False))
    study = Study(workplace.settings)
    with study.store.opened():
        schedule = study.schedule(settle=False)
    [waiting] = schedule.waiting(Verdicts({"pair": Open(blocks=4, next=9, needed=20)}))
    assert (waiting.name, waiting.lacking, waiting.is_first) == ("pair", 7, True)
    assert waiting.seconds_to_settle == pytest.approx(18 * waiting.block_seconds)
    assert not list(schedule.waiting(Verdicts()))


def test_blocks_of_what_is_open_take_turns(needing: Workplace) -> None:
    want(needing, pair=8, chunks=8)
    assert finish(needing.start("run", "--budget", "5"))[0] == 0
    firsts = [call["words"] for call in needing.calls() if "--tag" in call["words"]]
    order = [
        (tags["experiment"], int(tags["block"]))
        for words in firsts
        for tags in [dict(word.split("=", 1) for word in words if "=" in word)]
        if tags["experiment"] != "control"
    ]
    blocks = list(dict.fromkeys(order))
    after = blocks[blocks.index(("pair", 2)) :] if ("pair", 2) in blocks else []
    assert {name for name, _ in blocks[4:6]} == {"pair", "chunks"}, blocks
    assert [name for name, _ in after[:4]] in (["pair", "chunks"] * 2, ["chunks", "pair"] * 2), blocks
