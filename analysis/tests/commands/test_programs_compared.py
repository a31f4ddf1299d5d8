"""What `carom compare` asks of the analysis: differences, their correction for many, effects, a picture."""

import json
from pathlib import Path
from typing import Any

import pytest

from analysis.commands.programs_compared import programs_compared
from analysis.commands.programs_picture import programs_picture
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import Noise
from analysis.tests.synthetic_study import study
from support.errors import InputError
from support.vocabulary import ASKED

NOISE = Noise(process=0.01)


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A comparison of two, by their names `four` and `nine`."""
    write(tmp_path, study(["neighbourhood"], blocks=14, noise=NOISE, threads=2))
    return tmp_path


def contrast(results: Path, weights: dict[str, float]) -> list[dict[str, Any]]:
    told = {"cases": [], "contrasts": [{"name": "what it is", "weights": weights}]}
    (results / ASKED).write_text(json.dumps(told), encoding="utf-8")
    return list(programs_compared(results)["effects"])


def test_many_calls_share_the_error_of_a_slower_verdict(results: Path) -> None:
    [alone] = programs_compared(results)["commands"]
    [of_many] = programs_compared(results, 250)["commands"]
    assert alone["low_of_all"] == pytest.approx(alone["low"])
    assert of_many["low"] == alone["low"]
    assert of_many["low_of_all"] < alone["low"]


def test_a_contrast_of_two_series_is_their_ratio(results: Path) -> None:
    [row] = programs_compared(results)["commands"]
    [against] = {"four", "nine"} - {row["series"]}
    [effect] = contrast(results, {row["series"]: 1.0, against: -1.0})
    assert effect["series"] == "what it is"
    assert effect["ratio"] == pytest.approx(row["ratio"])
    assert (effect["low"], effect["high"]) == (pytest.approx(row["low"]), pytest.approx(row["high"]))


def test_a_contrast_of_what_is_not_there_is_left_out(results: Path) -> None:
    assert contrast(results, {"nobody": 1.0, "nine": -1.0}) == []


def test_the_picture_is_a_file_in_the_folder(results: Path) -> None:
    file = programs_picture(results)
    assert file.parent == results
    text = file.read_text(encoding="utf-8")
    assert "<svg" in text
    assert "NaN" not in text


def test_without_records_there_is_nothing_to_draw(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="holds no comparison to draw"):
        programs_picture(tmp_path)
    assert programs_compared(tmp_path)["next"] == 6
