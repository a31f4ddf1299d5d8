"""What is open, as a running study asks for it: blocks, the next look, and those that are needed."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis import claims
from analysis.commands.open_questions import open_questions
from analysis.statistics.noise import MOST_BLOCKS, blocks_to_decide
from analysis.statistics.verdicts import judge_one
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET, Noise
from analysis.tests.synthetic_study import slowed, study

NOISY = Noise(process=0.03)
NOISIER = Noise(process=0.2)


def found(folder: Path, names: list[str], blocks: int, noise: Noise) -> dict[str, Any]:
    write(folder, study(names, blocks=blocks, noise=noise, threads=20))
    return open_questions(folder)


def test_a_claim_that_is_decided_is_settled_and_said(tmp_path: Path) -> None:
    answer = found(tmp_path, ["neighbourhood", "control"], 9, QUIET)
    assert answer["settled"] == ["neighbourhood", "control"]
    assert str(answer["said"]["four_boxes"]).startswith("holds: ")
    assert answer["open"] == {}


def test_a_claim_that_is_open_says_how_many_blocks_it_needs(tmp_path: Path) -> None:
    answer = found(tmp_path, ["neighbourhood"], 6, NOISY)
    one = answer["open"]["neighbourhood"]
    assert (one["blocks"], one["next"]) == (6, 9)
    assert one["needed"] >= 9
    assert answer["settled"] == []


def test_too_few_blocks_need_the_first_look(tmp_path: Path) -> None:
    answer = found(tmp_path, ["neighbourhood", "control"], 2, QUIET)
    expected = {"blocks": 2, "next": 6, "needed": 6}
    assert answer["open"] == {"neighbourhood": expected, "control": expected}


@pytest.mark.parametrize(("blocks", "needed"), [(6, 72), (32, 384), (108, None)])
def test_what_is_not_in_sight_has_the_benefit_of_a_standard_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, blocks: int, needed: int | None
) -> None:
    monkeypatch.setattr("analysis.claims.missing.blocks_to_decide", lambda *_: math.inf)
    answer = found(tmp_path, ["neighbourhood"], blocks, NOISIER)
    assert "four_boxes" not in answer["said"]
    assert answer["open"].get("neighbourhood", {}).get("needed") == needed
    assert answer["settled"] == []


def test_what_hardware_lacks_is_not_open(tmp_path: Path) -> None:
    answer = found(tmp_path, ["machine"], 9, QUIET)
    assert answer["open"] == {}, "a second machine is not made by more blocks"


def test_an_empty_folder_has_nothing_open(tmp_path: Path) -> None:
    (tmp_path / "records").mkdir()
    assert open_questions(tmp_path) == {"open": {}, "settled": [], "said": {}}


@pytest.mark.parametrize("effect", [0.0, 0.04, 0.06])
def test_the_forecast_is_right_more_often_than_not(effect: float) -> None:
    """Of studies that are open after nine blocks: decided at the look that was foretold."""
    generator = np.random.default_rng(1)
    right = foretold = 0
    for _ in range(100):
        ratios = np.log1p(effect) + generator.normal(0, 0.02, 164)
        row = judge_one(ratios[:9])
        needed = blocks_to_decide(row.p, 9)
        if row.verdict == "inconclusive" and needed <= len(ratios):
            foretold += 1
            right += judge_one(ratios[: int(needed)]).verdict != "inconclusive"
    assert foretold > 40
    assert right > 0.6 * foretold


def test_the_forecast_grows_with_the_family_and_ends_on_the_border() -> None:
    row = judge_one([0.04, 0.05, 0.02, 0.03, 0.06, 0.05])
    assert row.verdict == "inconclusive"
    assert blocks_to_decide(row.p, 6, family=17) > blocks_to_decide(row.p, 6)
    assert blocks_to_decide(100.0, 6) > MOST_BLOCKS, "on the border nothing is in sight"


def test_a_claim_that_holds_in_direction_than_the_margin_is_settled_and_says_so(tmp_path: Path) -> None:
    records = study(["neighbourhood"], blocks=21, noise=QUIET, threads=20)
    write(tmp_path, slowed(records, 1.04, series="four"))
    answer = open_questions(tmp_path)
    assert answer["settled"] == ["neighbourhood"]
    said = str(answer["said"]["four_boxes"]).replace("\u00a0", " ")
    assert said.startswith("holds in direction: ")
    assert said.endswith("(faster, but by less than 2 %)")


def test_what_was_tested_is_not_tested_again_until_it_has_new_records(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tested = []
    pair = claims.TESTS["pair"]

    def counted(*given: Any, **named: Any) -> Any:  # noqa: ANN401 - whatever a test takes and gives
        tested.append(named)
        return pair(*given, **named)

    monkeypatch.setitem(claims.TESTS, "pair", counted)
    remembered: claims.Tested = {}
    write(tmp_path, study(["neighbourhood", "row"], blocks=6, noise=QUIET, threads=20))
    first = open_questions(tmp_path, remembered)
    assert len(tested) > 1
    tested.clear()
    assert open_questions(tmp_path, remembered) == first
    assert tested == []
    write(tmp_path, study(["row"], blocks=9, noise=QUIET, threads=20))
    second = open_questions(tmp_path, remembered)
    assert len(tested) == 1
    assert second == open_questions(tmp_path)
