"""Which time `carom compare` judges: on a busy machine that in which a processor computed, if that is all."""

import json
import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from experiments.compare.blocks import WAITS_COUNTED, Runs
from experiments.compare.clock import clock_of
from experiments.support.busy import busy
from experiments.tests.compare.calls import LOOP, needs_the_program, run, script


def runs_of(cores: float, waits: float | None) -> Runs:
    counts = {} if waits is None else {WAITS_COUNTED: [waits, waits]}
    return Runs(blocks=[0, 1], seconds=[0.5, 0.5], cores=[cores, cores], counts=counts)


@pytest.mark.parametrize(
    ("is_busy", "cores", "waits", "clock"),
    [
        (True, 0.6, 2, "processor"),
        (False, 0.6, 2, "wall"),
        (True, 1.6, 2, "wall"),
        (True, 0.6, 500, "wall"),
        (True, 0.6, None, "wall"),
    ],
    ids=["busy", "quiet", "on several processors", "waits for something else", "nothing is counted"],
)
def test_what_computes_on_one_processor_is_judged_by_it_where_others_are_in_the_way(
    is_busy: bool, cores: float, waits: float | None, clock: str
) -> None:
    asked = SimpleNamespace(
        cases=(), has_printed_times=False, commands=[SimpleNamespace(name="a"), SimpleNamespace(name="b")]
    )
    blocks = SimpleNamespace(
        runs={("a", 0): runs_of(0.6, 2), ("b", 0): runs_of(cores, waits)},
        others=SimpleNamespace(are_in_the_way=is_busy),
    )
    assert clock_of(asked, blocks) == clock  # type: ignore[arg-type]


@needs_the_program
def test_a_verdict_by_processor_time_says_so_and_tells_that_of_wall_time(folder: Path) -> None:
    script(folder / "less", LOOP.format(times=20_000))
    script(folder / "more", LOOP.format(times=40_000))
    words = ("./less", "./more", "--time", "30s", "--export-json", "a.json")
    with busy(2 * len(os.sched_getaffinity(0))):
        done = run(folder, "compare", *words)
    assert done.returncode in (0, 5), done.stderr
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    assert told["clock"] == "processor"
    assert told["differences"][0]["ratio"] == pytest.approx(2, rel=0.5)
    assert told["differences_by_wall"][0]["name"] == "more"
    assert ", by processor time" in done.stdout
    assert "is left out; with it: more +" in done.stdout


@needs_the_program
def test_the_control_runs_in_every_fourth_block_after_the_first_look(folder: Path) -> None:
    words = ("true", "false", "--ignore-exit", "1", "--margin", "0.01%", "--time", "20s")
    done = run(folder, "compare", *words, "--export-json", "a.json")
    assert done.returncode in (0, 5), done.stderr
    told = {one["command"]: one["blocks"] for one in json.loads((folder / "a.json").read_text())["runs"]}
    assert told["true"] == told["false"] == list(range(len(told["true"])))
    assert len(told["true"]) > 8
    assert told["true again"] == [one for one in told["true"] if one < 6 or one % 4 == 0]
