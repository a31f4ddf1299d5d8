"""The model of a step on more cores, against steps whose parts are known."""

import math
from pathlib import Path

import pandas as pd
import pytest

from analysis.derived.more_cores import (
    PHASES,
    bandwidth,
    foretold,
    loops_over,
    measured_speed_ups,
    resolve_loops,
    steps_by_phase,
    strips_of,
)
from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_points import MORE_CORES
from analysis.tests.synthetic_study import study

NO_LIMITS = pd.DataFrame({"limit": [], "level": [], "threads": [], "best": [], "working_set_bytes": []})


def step(name: str, threads: int, seconds: float, **of: float) -> dict[str, object]:
    scene = {"particles": 100_000, "side": 10_000.0, "radius": 16.0, "sweeps": 20.0} | of
    return {"scene_name": name, "threads": threads, **dict.fromkeys(PHASES, seconds), **scene}


def told(*steps: dict[str, object], limits: pd.DataFrame = NO_LIMITS) -> pd.DataFrame:
    return foretold(pd.DataFrame(list(steps)), limits).set_index(["scene_name", "threads"])["seconds"]


TWO_DISCS = [step("two", threads, 1e-9, particles=2, sweeps=1.0) for threads in (1, 2)]


def test_strips_are_four_rows_of_boxes_as_wide_as_a_disc() -> None:
    assert [strips_of(10_000, 53), strips_of(10_000, 16), strips_of(31_623, 16)] == [24, 78, 247]
    assert strips_of(10, 16) == 1


def test_sweeps_run_as_one_by_one_two_four_and_eight() -> None:
    assert [resolve_loops(sweeps) for sweeps in (1, 2, 3, 4, 7, 8, 15, 16)] == [1, 2, 2, 3, 3, 4, 4, 5]


def test_work_that_divides_evenly_takes_its_share_of_the_time() -> None:
    seconds = told(step("one", 1, 1.0), *TWO_DISCS)
    assert seconds["one", 1] == pytest.approx(4.0)
    assert seconds["one", 2] == pytest.approx(0.5 + 0.5 + 39 / 78 + 40 / 78, rel=1e-3)


def test_no_more_threads_than_every_other_strip_resolve_at_a_time() -> None:
    seconds = told(step("few", 1, 1.0, radius=53.0), *TWO_DISCS)
    assert seconds["few", 64] == pytest.approx(1 / 64 + 1 / 64 + 1 / 24 + 2 / 24, rel=0.02)


def test_what_two_threads_take_longer_is_handed_over_in_every_half_of_a_sweep() -> None:
    slower = step("one", 2, 0.0) | {"resolve": 0.6 + 40 / 78 - 0.5}
    seconds = told(step("one", 1, 1.0), slower, *TWO_DISCS)
    without = told(step("one", 1, 1.0), *TWO_DISCS)
    for threads in (2, 16):
        assert seconds["one", threads] - without["one", threads] == pytest.approx(0.1, rel=1e-3)


def test_loops_cost_what_two_discs_take_longer_and_grow_with_the_threads() -> None:
    loops = pd.DataFrame({phase: [1.0, 2.0, 4.0] for phase in PHASES}, index=[1, 2, 4])
    assert [loops_over(loops, threads)["find"] for threads in (1, 2, 3, 4, 8)] == [0, 1, 2, 3, 6]


def test_memory_bounds_what_no_cache_holds_on_as_many_threads_as_were_measured() -> None:
    copies = [("memory", threads, 1e6 * threads, 1e9) for threads in (1, 2)]
    rows = [*copies, ("L2", 1, 1e12, 1e6)]
    limits = pd.DataFrame(rows, columns=["level", "threads", "best", "working_set_bytes"]).assign(
        limit="copy"
    )
    assert [bandwidth(limits, threads) for threads in (1, 2, 3)] == [1e6, 2e6, math.inf]
    table = foretold(pd.DataFrame([step("one", 1, 1.0), *TWO_DISCS]), limits).set_index(
        ["scene_name", "threads"]
    )
    assert table.loc[("one", 2), "bounds"] == "memory"
    assert table.loc[("one", 2), "seconds"] == pytest.approx(250 * 100_000 / 2e6)
    assert table.loc[("one", 4), "bounds"] == "work"


def test_larger_boxes_take_as_much_longer() -> None:
    seconds = told(step("one", 1, 1.0, particles=1e6), *TWO_DISCS)
    assert seconds["10 million discs", 1] == pytest.approx(40.0)
    assert seconds["100 million discs", 1] == pytest.approx(400.0)
    quick = told(step("one", 1, 1.0, particles=1e4), *TWO_DISCS)
    assert quick["100\xa0000 discs", 1] == pytest.approx(40.0)


def test_nothing_is_foretold_without_loops_on_two_threads() -> None:
    assert told(step("one", 1, 1.0)).empty
    assert told(step("one", 1, 1.0), TWO_DISCS[0]).empty


def test_measured_speed_ups_are_those_of_the_records(tmp_path: Path) -> None:
    write(tmp_path, study(["more_cores"], blocks=6, noise=QUIET))
    of = split(load(tmp_path))[0]
    steps = steps_by_phase(*of.of("more_cores", "runs", "phases"))
    assert set(steps["scene_name"]) == set(MORE_CORES)
    found = measured_speed_ups(next(of.of("more_cores", "phases"))).set_index(["scene_name", "threads"])
    for threads in (2, 4):
        truth = 9.0 / (9.0 / threads + 1e-3 * (threads - 1))
        assert found.loc[("1M", threads), "speed_up"] == pytest.approx(truth, rel=0.05)
