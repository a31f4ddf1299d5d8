"""What is made of streams whose truth is known."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray

from analysis.calibration import studies
from analysis.calibration.bounds import interval, upper_bound
from analysis.calibration.result import write
from analysis.calibration.streams import FILE, SCHEMA_VERSION, Stream, load
from analysis.calibration.studies import (
    all_studies,
    comparisons,
    disjoint,
    is_wrong,
    overlapping,
)
from analysis.calibration.tables import OURS, errors, ours_and_theirs, power
from analysis.calibration.usual_ways import WAYS, all_ways
from analysis.statistics.looks import looks_up_to
from analysis.statistics.verdicts import Ratio
from analysis.tests.statistics.unkind_noise import dependent
from support.errors import InputError

Floats = NDArray[np.float64]

MORE = (0.0, 0.0, 0.05, 0.1)
BLOCKS, ROUNDS = 260, 2


def stream(noise: Floats, drift: Floats | None = None) -> Stream:
    """Return a stream with this noise in its logarithms, blocks x rounds x contenders, and a drift of all."""
    shared = np.zeros(len(noise)) if drift is None else drift
    logs = noise + shared[:, None, None] + np.log1p(MORE)
    return Stream("variants", "quiet", MORE, np.exp(logs), wall_seconds=60.0)


def independent(seed: int, deviation: float = 0.01) -> Stream:
    return stream(np.random.default_rng(seed).normal(0, deviation, (BLOCKS, ROUNDS, len(MORE))))


def depending(seed: int) -> Stream:
    values = dependent(np.random.default_rng(seed), 0.6, len(MORE), BLOCKS)
    return stream(0.02 * values.T[:, None, :].repeat(ROUNDS, axis=1))


def bursts(seed: int) -> Stream:
    generator = np.random.default_rng(seed)
    shape = (BLOCKS, ROUNDS, len(MORE))
    return stream(generator.normal(0, 0.01, shape) + 0.5 * (generator.random(shape) < 0.05))


@pytest.mark.parametrize("made", [independent, depending, bursts])
def test_few_verdicts_are_wrong_whatever_the_noise(made: object) -> None:
    assert callable(made)
    row = errors(all_studies([made(1), replace(made(2), condition="busy")]), ["kind"]).iloc[0]
    assert row["wrong"] <= 0.05 * row["studies"]
    assert row["disjoint"] > 2 * 20
    assert row["disjoint_wrong"] / row["disjoint"] <= row["bound"] < 0.12
    assert row["stretches"] * (len(MORE) - 1) == row["disjoint"]
    assert row["stretches_wrong"] <= row["disjoint_wrong"]
    assert row["stretch_bound"] >= row["bound"]


def test_more_work_is_found_sooner() -> None:
    table = all_studies([independent(3)])
    found = [power(table, more).iloc[0] for more in (0.05, 0.1)]
    assert found[0]["found"] > 0.9
    assert found[1]["nine_of_ten"] <= found[0]["nine_of_ten"] < np.inf


def test_ten_and_then_ten_raise_alarms_where_the_machine_drifts() -> None:
    generator = np.random.default_rng(4)
    drift = np.cumsum(generator.normal(0, 0.01, BLOCKS))
    drifting = stream(generator.normal(0, 0.005, (BLOCKS, ROUNDS, len(MORE))), drift)
    table = ours_and_theirs(all_studies([drifting]), all_ways([drifting]), [drifting])
    alarms = table[table["more"] == 0].set_index("way")["said"]
    assert alarms[OURS] < 0.03
    assert alarms["ten, then ten: U test (compare.py)"] > 0.3
    assert alarms["the same U test, up to five times"] > alarms["ten, then ten: U test (compare.py)"]
    assert alarms["ten interleaved pairs: t"] < 0.12
    assert set(table["way"]) == {OURS, *(way.name for way in WAYS)}
    assert ((table["low"] <= table["said"]) & (table["said"] <= table["high"])).all()


def test_a_rule_that_errs_is_seen_to_err(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rule that calls everything equivalent is wrong about each true difference."""
    equivalent = Ratio(ratio=1.0, low=1.0, high=1.0, verdict="equivalent")
    monkeypatch.setattr(studies, "judge_one", lambda _: equivalent)
    row = errors(all_studies([independent(5)]), ["more"]).set_index("more")
    assert row.loc[0.0, "wrong"] == 0
    assert row.loc[0.05, "wrong"] == row.loc[0.05, "studies"]
    assert row.loc[0.05, "missed"] == row.loc[0.05, "studies"]


@pytest.mark.parametrize(
    ("verdict", "more", "wrong"),
    [
        ("slower", 0.0, True),
        ("faster", 0.0, True),
        ("equivalent", 0.0, False),
        ("equivalent", 0.05, True),
        ("slower", 0.05, False),
        ("faster", 0.05, True),
        ("slower", 0.02, True),
        ("inconclusive", 0.05, False),
    ],
)
def test_a_verdict_is_wrong_that_contradicts_the_truth(verdict: str, more: float, wrong: bool) -> None:
    assert is_wrong(verdict, more) == wrong


def test_studies_look_where_looks_are_planned_and_disjoint_ones_share_no_block() -> None:
    assert looks_up_to(20) == [6, 9, 14]
    starts, looks = disjoint(independent(6))
    assert starts.step == looks[-1]
    assert len(starts) >= 20
    starts, looks = overlapping(independent(6))
    assert starts[-1] + looks[-1] <= BLOCKS
    assert comparisons(MORE)[:4] == [(0, 1), (0, 2), (0, 3), (1, 2)]


def test_the_exact_bounds_are_those_of_clopper_and_pearson() -> None:
    assert upper_bound(0, 59) == pytest.approx(1 - 0.05 ** (1 / 59))
    assert upper_bound(5, 5) == 1
    assert interval(4, 20) == pytest.approx((0.0573, 0.4366), abs=1e-3)


def kept(folder: Path, one: Stream, **changed: object) -> Path:
    """Write the stream as `experiments calibrate` does."""
    told = {
        "kind": one.kind,
        "condition": one.condition,
        "percent_more": [100 * more for more in one.more],
        "began_at": "2026-01-02T03:04:05+00:00",
        "wall_seconds": one.wall_seconds,
        "provenance": {
            "cpu_model": "a processor",
            "hardware_threads": 2,
            "commit": "abcdef0123",
            "dirty": False,
        },
        "blocks": one.seconds.tolist(),
    }
    content = {"schema_version": SCHEMA_VERSION, "seconds": 60, "streams": [told], **changed}
    (folder / FILE).write_text(json.dumps(content), encoding="utf-8")
    return folder


def test_tables_and_figure_say_machine_commit_and_date(tmp_path: Path) -> None:
    text, files = write(kept(tmp_path, independent(7)))
    assert "a processor, 2 hardware threads; commit abcdef0; 2026-01-02" in text
    assert "Carom" in text
    assert [file.name for file in files] == ["calibration.md", "calibration.svg"]
    assert "a true 5 % found" in files[1].read_text(encoding="utf-8")
    assert pd.notna(load(tmp_path)[0][0].seconds).all()


@pytest.mark.parametrize(
    "damage", [{"schema_version": 2}, {"streams": []}, {"streams": [{"kind": "variants"}]}, {"streams": 3}]
)
def test_a_damaged_file_is_one_line(tmp_path: Path, damage: dict[str, object]) -> None:
    with pytest.raises(InputError, match=FILE) as told:
        load(kept(tmp_path, independent(8), **damage))
    assert "\n" not in str(told.value)
    (tmp_path / FILE).write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="cannot be read"):
        load(tmp_path)
