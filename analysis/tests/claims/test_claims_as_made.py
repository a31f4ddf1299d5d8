"""Each claim is tested as it was made: on its threads, its scale, its sizes, and where its effect is."""

import tomllib
from pathlib import Path

import pytest

from analysis import claims
from analysis.claims.outcome import FAILS, HOLDS, OPEN, Verdict
from analysis.records import published
from analysis.tests.claims.judging import Records, figures, row_of, slowed
from analysis.tests.synthetic import Machine, Point, bench, failure
from analysis.tests.synthetic_noise import QUIET, Noise
from analysis.tests.synthetic_study import study

# Threads


@pytest.mark.parametrize(
    ("threads", "factor", "verdict", "said"),
    [
        (20, 1.0, HOLDS, "holds"),
        (20, 1.2, FAILS, "does not hold"),
        (20, 1.04, Verdict.IN_DIRECTION, "holds in direction"),
        (2, 1.0, Verdict.HOLDS_ELSEWHERE, "holds at 2 threads (claimed at 20)"),
        (
            2,
            1.04,
            Verdict.IN_DIRECTION_ELSEWHERE,
            "holds in direction at 2 threads (claimed at 20)",
        ),
        (2, 1.2, Verdict.FAILS_ELSEWHERE, "does not hold at 2 threads (claimed at 20)"),
        (1, 1.2, Verdict.FAILS_ELSEWHERE, "does not hold at 1 thread (claimed at 20)"),
    ],
)
def test_a_verdict_on_other_threads_says_so(
    tmp_path: Path, threads: int, factor: float, verdict: Verdict, said: str
) -> None:
    records = study(["neighbourhood"], blocks=21, noise=QUIET, threads=threads)
    row = row_of(tmp_path, slowed(records, factor, series="four"), "four_boxes")
    assert row["verdict"] == verdict
    assert row["said"].replace("\u00a0", " ") == said
    assert (row["claimed_threads"], row["tested_threads"]) == ((20,), (threads,))
    assert figures(row)["threads"] == ("20", str(threads))
    scene = "100 000 discs of radius 16, side 10 000, 100 steps"
    assert [one.replace("\u00a0", " ") for one in figures(row)["scene"]] == [scene, scene]
    assert figures(row)["tolerance"] == ("published", "relative")


def test_the_claimed_threads_and_machines_are_those_of_the_published_times() -> None:
    content = tomllib.loads(published.PUBLISHED_FILE.read_text(encoding="utf-8"))["experiments"]
    for claim in claims.load():
        for name in claim.experiments:
            table = content.get(name, {})
            if "threads" in table:
                assert claim.published.threads == table["threads"], claim.id
            if "machine" in table:
                assert claim.published.machine == table["machine"], claim.id


def test_every_claim_says_what_the_study_measured_and_where_it_may_be_decided() -> None:
    for claim in claims.load():
        assert claim.published.effect
        assert set(claim.scales) <= {"paper", "quick"}
        assert claim.other_scales
        assert claim.test in claims.TESTS


def test_a_claim_is_judged_by_the_margin_of_its_question(tmp_path: Path) -> None:
    records = study(["neighbourhood"], noise=QUIET, threads=20)
    for record in records:
        record["tags"]["margin"] = 0.1
    row = row_of(tmp_path, records, "four_boxes")
    assert row["verdict"] == Verdict.IN_DIRECTION
    assert row["measured"].endswith("(faster, but by less than 10 %)")


# Scale and size


@pytest.mark.parametrize(
    ("threads", "factor", "verdict", "said"),
    [
        (20, 1.0, Verdict.HOLDS_ELSEWHERE, "holds at quick scale"),
        (20, 1.2, Verdict.FAILS_ELSEWHERE, "does not hold at quick scale"),
        (20, 1.04, Verdict.IN_DIRECTION_ELSEWHERE, "holds in direction at quick scale"),
        (2, 1.0, Verdict.HOLDS_ELSEWHERE, "holds at quick scale, at 2 threads (claimed at 20)"),
    ],
)
def test_a_verdict_at_a_smaller_scale_speaks_of_it_alone(
    tmp_path: Path, threads: int, factor: float, verdict: Verdict, said: str
) -> None:
    records = study(["neighbourhood"], blocks=21, noise=QUIET, scale="quick", threads=threads)
    row = row_of(tmp_path, slowed(records, factor, series="four"), "four_boxes")
    assert row["verdict"] == verdict
    assert row["said"].replace("\u00a0", " ") == said
    assert "24 rows" in row["why"]


def test_what_is_open_at_a_smaller_scale_says_what_is_missing(tmp_path: Path) -> None:
    records = study(["neighbourhood"], noise=Noise(process=0.2), scale="quick", threads=20, blocks=9)
    row = row_of(tmp_path, records, "four_boxes")
    assert row["verdict"] == OPEN
    assert "24 rows" not in row["why"]
    assert "SCALE=quick" in row["why"] or "not in sight" in row["why"]


@pytest.mark.parametrize(
    ("scale", "experiment", "claim"),
    [("quick", "threads", "threads"), ("unstated", "neighbourhood", "four_boxes")],
)
def test_a_scale_that_says_nothing_of_a_claim_shows_what_was_measured_and_decides_nothing(
    tmp_path: Path, scale: str, experiment: str, claim: str
) -> None:
    row = row_of(tmp_path, study([experiment], noise=QUIET, scale=scale, threads=20), claim)
    assert row["verdict"] == Verdict.OTHER_SCALE
    assert row["said"] == f"cannot be decided at {scale} scale"
    assert "24 rows" in row["why"]
    assert row["measured"]


def test_the_row_claim_is_judged_at_its_150_rows_and_not_at_the_largest_scene(tmp_path: Path) -> None:
    records = slowed(study(["row"], noise=QUIET, threads=8), 1.3, series="row", x=200_000)
    row = row_of(tmp_path / "whole", records, "row")
    assert row["verdict"] == HOLDS
    assert "particles = 100\u00a0000" in row["measured"]
    smaller = [record for record in records if record["tags"]["x"] < 100_000]
    row = row_of(tmp_path / "smaller", smaller, "row")
    assert row["verdict"] == OPEN
    assert "needs particles = 100\u00a0000" in row["why"]


# Trends


def velocities(seconds: dict[str, dict[int, float]]) -> Records:
    axes = {"threads": 20}
    return [
        bench(name, Point("checkered", x, 1.0, name, axes=axes), block, [second + block / 500], Machine())
        for name, curve in seconds.items()
        for x, second in curve.items()
        for block in range(6)
    ]  # fmt: skip


def test_ends_at_which_all_velocities_are_equal_do_not_decide_a_trend(tmp_path: Path) -> None:
    rising = {1: 1.0, 5: 1.1, 25: 1.3, 45: 1.5, 50: 0.7}
    row = row_of(tmp_path, velocities({"min_velocity": rising, "max_velocity": {**rising, 1: 9.0, 50: 1.6}}),
                 "velocity")  # fmt: skip
    assert row["verdict"] == HOLDS
    assert "(without the degenerate min_velocity = 50)" in row["measured"]
    assert "(without the degenerate max_velocity = 1)" in row["measured"]
    assert "from 1 to 45" in figures(row)["growth of the time over min_velocity"][1]


def test_degenerate_ends_that_are_slow_do_not_make_a_trend(tmp_path: Path) -> None:
    falling = {1: 1.5, 5: 1.4, 25: 1.2, 45: 1.0}
    row = row_of(
        tmp_path,
        velocities(
            {"min_velocity": {**falling, 50: 9.0}, "max_velocity": {1: 0.1, 5: 1.0, 25: 1.2, 50: 1.5}}
        ),
        "velocity",
    )
    assert row["verdict"] == FAILS


def test_the_growth_stands_beside_the_published_one(tmp_path: Path) -> None:
    row = row_of(tmp_path, study(["particles"], noise=QUIET, threads=20), "particles")
    theirs, ours = figures(row)["growth of the time over particles"]
    assert theirs == "×5.67 from 10\u00a0000 to 100\u00a0000"
    assert ours.startswith("×5.2")


@pytest.mark.parametrize(
    ("least", "factor", "verdict", "said"),
    [(35, 1.0, HOLDS, ""), (25, 0.7, FAILS, "radius 25"), (35, 1.0 / 0.99, HOLDS, "")],
)
def test_the_radius_of_the_least_time_is_tested(
    tmp_path: Path, least: int, factor: float, verdict: Verdict, said: str
) -> None:
    records = slowed(study(["radius"], noise=QUIET, threads=20), factor, x=least)
    row = row_of(tmp_path, records, "radius")
    assert row["verdict"] == verdict
    assert said in row["why"]
    assert figures(row)["least time at radius"][0] == "35"


def test_without_the_published_radius_its_minimum_is_open(tmp_path: Path) -> None:
    records = [one for one in study(["radius"], noise=QUIET, threads=20) if one["tags"]["x"] != 35]
    row = row_of(tmp_path, records, "radius")
    assert row["verdict"] == OPEN
    assert "needs radius = 35" in row["why"]


# Threads: one binding


def test_a_stretch_over_a_change_of_binding_decides_nothing(tmp_path: Path) -> None:
    machine = Machine()
    records = study(["threads"], machine=machine, noise=QUIET)
    assert row_of(tmp_path / "one", records, "threads")["verdict"] == HOLDS
    for record in records:
        if record["axes"]["threads"] > 2:
            record["provenance"]["openmp"]["proc_bind"] = "false"
    row = row_of(tmp_path / "two", records, "threads")
    assert row["verdict"] == OPEN
    assert "binding changes" in row["why"]


def test_stretches_stand_beside_the_published_ones(tmp_path: Path) -> None:
    row = row_of(tmp_path, study(["threads"], noise=QUIET), "threads")
    assert figures(row)["time up to the cores"][0] == "×0.178 from 1 to 10"
    assert figures(row)["time beyond"][0] == "×3.15 from 20 to 35"


def test_a_speed_up_beyond_the_cores_carries_a_doubt(tmp_path: Path) -> None:
    records = slowed(study(["threads"], machine=Machine(cores=2, hardware_threads=4), noise=QUIET), 2.0, x=1)
    row = row_of(tmp_path, records, "threads")
    assert "a speed-up of 3.6" in row["measured"]
    assert "is doubtful, the cores give 2.00 at most" in row["measured"]


# What failed


def test_points_that_failed_are_counted_beside_the_verdict(tmp_path: Path) -> None:
    records = study(["grid_length"], blocks=4, noise=QUIET, threads=20)
    sparse = failure("grid_length", "checkered", "step 3: the sweep limit was reached")
    row = row_of(tmp_path, [*records, sparse], "grid_length")
    assert "1\u00a0process failed and left no time" in row["why"]
