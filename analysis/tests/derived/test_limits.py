"""The unavoidable work of a step, and phases against the machine's limits, from records with known rates."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from analysis.claims.entry import Evidence
from analysis.derived.ladder import named
from analysis.derived.limits import against_limits
from analysis.derived.unavoidable import PHASES, unavoidable
from analysis.figures.profiles import phases_against_limits
from analysis.figures.style import styled
from analysis.records.reading import load
from analysis.records.studies import Study, split
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_study import ARITHMETIC, COPY, SHARES, data_in, study

DISCS, OVERLAPS, RESOLVES = 100_000, 100_000, 120_000
"""Of a step of the synthetic sparse scene."""


def records(**changes: Any) -> list[dict[str, Any]]:  # noqa: ANN401
    made = study(["limits"], blocks=3, noise=QUIET)
    for record in made:
        record.get("axes", {}).update(changes)
    return made


def table_of(one: Study) -> pd.DataFrame:
    runs, phases, threads = (named(table) for table in (one.runs, one.phases, one.threads))
    return against_limits(runs, phases, threads, one.limits)


def work_of(one: Study) -> pd.DataFrame:
    sparse = one.runs[one.runs["scene_name"] == "sparse"].head(1)
    return unavoidable(sparse).set_index("phase")


@pytest.fixture(scope="module")
def limits_data(tmp_path_factory: pytest.TempPathFactory) -> Evidence:
    return data_in(tmp_path_factory.mktemp("limits"), records())


@pytest.fixture(scope="module")
def one(limits_data: Evidence) -> Study:
    return limits_data.study


def test_every_phase_reads_and_writes_what_its_formula_says(one: Study) -> None:
    work = work_of(one)
    touched = DISCS * (1 - np.exp(-2 * OVERLAPS / DISCS))
    assert list(work.index) == list(PHASES)
    assert work.loc["move", "bytes"] == 48 * DISCS
    assert work.loc["bin", "bytes"] == 20 * DISCS
    assert work.loc["find", "bytes"] == 16 * DISCS + 8 * OVERLAPS
    assert work.loc["resolve", "bytes"] == pytest.approx(8 * OVERLAPS + 48 * touched)
    assert work.loc["resolve", "operations"] == 7 * OVERLAPS + 10 * RESOLVES
    assert work.loc["find", "operations"] == 5 * OVERLAPS


def test_float_halves_the_bytes_of_numbers_and_no_operation(tmp_path: Path) -> None:
    work = work_of(data_in(tmp_path, records(precision="float")).study)
    assert work.loc["move", "bytes"] == 24 * DISCS
    assert work.loc["bin", "bytes"] == 12 * DISCS
    assert work.loc["move", "operations"] == 4 * DISCS


def test_without_overlaps_there_is_nothing_to_resolve(one: Study) -> None:
    runs = one.runs.assign(overlaps=0, pair_resolves=0)
    work = unavoidable(runs).set_index("phase").loc["resolve"]
    assert (work["bytes"] == 0).all()
    assert (work["operations"] == 0).all()


def test_the_least_time_is_that_of_the_largest_copy_within_the_scene(one: Study) -> None:
    table = table_of(one).set_index(["scene_name", "series", "phase"]).sort_index()
    assert table.loc["sparse", "level"].eq("L3").all(), "4.4 MB are more than 4 MiB"
    assert table.loc["dense", "level"].eq("L2").all(), "1.2 MB are more than 1 MiB"
    move = table.loc[("sparse", "published", "move")]
    assert move["copy"] == pytest.approx(1e9 * 48 / (2 * COPY["L3"][1]))
    assert move["arithmetic"] == pytest.approx(1e9 * 4 / (2 * 2 * ARITHMETIC))
    assert (move["bound"], move["least"]) == ("copy", move["copy"])
    assert move["wall"] == pytest.approx(1e9 * SHARES["move"] / (DISCS * 100), rel=0.05)
    assert move["reached"] == pytest.approx(move["copy"] / move["wall"], rel=0.02)
    assert move["wall"] * 0.8 < move["busy"] < move["wall"] * 0.9


def test_arithmetic_bounds_where_it_takes_longer(one: Study) -> None:
    slow = one.limits.assign(best=one.limits["best"].where(one.limits["limit"] == "copy", 1e6))
    table = table_of(replace(one, limits=slow))
    assert set(table["bound"]) == {"arithmetic"}
    assert (table["least"] == table["arithmetic"]).all()


def test_limits_of_as_many_threads_are_taken_or_of_fewer(one: Study) -> None:
    alone = table_of(replace(one, limits=one.limits[one.limits["threads"] == 1]))
    assert alone["copy_rate"].max() == COPY["L2"][1], "the dense scene's"
    assert alone["copy_rate"].min() == COPY["L3"][1], "the sparse scene's"
    more = one.limits.assign(threads=one.limits["threads"] + 2)
    assert table_of(replace(one, limits=more)).empty


def test_a_scene_smaller_than_any_copy_is_compared_with_the_smallest(one: Study) -> None:
    larger = one.limits.assign(working_set_bytes=one.limits["working_set_bytes"] * 2**10)
    assert set(table_of(replace(one, limits=larger))["level"]) == {"L2"}


def test_the_limits_are_those_of_the_machine(limits_data: Evidence, one: Study) -> None:
    assert set(one.limits["machine"]) == {one.machine}
    read = load(limits_data.folder)
    (other,) = split(replace(read, limits=read.limits.assign(machine="another: CPU")))
    assert other.limits.empty


def test_the_figure_names_the_limits_and_what_is_reached_if_there_are_any(
    limits_data: Evidence, one: Study
) -> None:
    with styled("limits"):
        drawing = phases_against_limits(limits_data, "limits", "limits")
    assert drawing is not None
    assert "40.0 GB/s within 4.00 MiB (L3)" in drawing.caption
    assert "12.0 Gflop/s" in drawing.caption
    assert "longest is resolve" in drawing.caption
    said = [text.get_text() for axes in drawing.figure.axes for text in axes.texts]
    assert sum("%" in text for text in said) == 2 * (2 * 2 * len(PHASES)), "reached, and waiting"
    without = replace(limits_data, study=replace(one, limits=one.limits.iloc[:0]))
    assert phases_against_limits(without, "limits", "limits") is None
