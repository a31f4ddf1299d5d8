"""Which time `carom compare` judges: on a busy machine that without waiting for a processor."""

import json
import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from experiments.compare.blocks import Runs
from experiments.compare.clock import clock_of
from experiments.support.busy import busy
from experiments.tests.compare.calls import LOOP, TOOK, needs_the_program, run, script
from support.vocabulary import OWN, WALL


@pytest.mark.parametrize(
    ("is_busy", "is_known", "clock"),
    [(True, True, OWN), (False, True, WALL), (True, False, WALL)],
    ids=["busy", "quiet", "the system does not tell"],
)
def test_waiting_for_a_processor_is_left_out_where_others_are_in_the_way(
    is_busy: bool, is_known: bool, clock: str
) -> None:
    asked = SimpleNamespace(
        cases=(), has_printed_times=False, commands=[SimpleNamespace(name="a"), SimpleNamespace(name="b")]
    )
    runs = {("a", 0): Runs(), ("b", 0): Runs(knows_waiting=is_known)}
    blocks = SimpleNamespace(runs=runs, others=SimpleNamespace(are_in_the_way=is_busy))
    assert clock_of(asked, blocks) == clock  # type: ignore[arg-type]


@needs_the_program
def test_what_a_command_sleeps_counts_also_on_a_busy_machine(folder: Path) -> None:
    words = ("sleep 0.05", "sleep 0.1", "--time", "20s", "--export-json", "a.json")
    with busy(2 * len(os.sched_getaffinity(0))):
        done = run(folder, "compare", *words)
    assert done.returncode in (0, 5), done.stderr
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    assert told["differences"][0]["ratio"] == pytest.approx(2, rel=0.2)


@needs_the_program
def test_a_verdict_without_waiting_says_so_and_tells_that_of_wall_time(folder: Path) -> None:
    script(folder / "less", LOOP.format(times=20_000))
    script(folder / "more", LOOP.format(times=40_000))
    words = ("./less", "./more", "--time", "30s", "--export-json", "a.json")
    with busy(2 * len(os.sched_getaffinity(0))):
        done = run(folder, "compare", *words)
    assert done.returncode in (0, 5), done.stderr
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    if told["clock"] == WALL:
        pytest.skip("the system does not tell how long a command waits for a processor")
    assert told["differences"][0]["ratio"] == pytest.approx(2, rel=0.5)
    assert told["differences_by_wall"][0]["name"] == "more"
    # Of all time, and of the verdict unless that is withdrawn.
    assert done.stdout.count(", waiting for a processor left out") == 1 + (done.returncode == 0)
    assert "With what the commands waited for it: more +" in done.stdout


@needs_the_program
def test_the_control_runs_in_every_fourth_block_after_the_first_look(folder: Path) -> None:
    script(folder / "wobbles", 'echo x >> n; echo took "$((100 + $(wc -l < n) % 7))" ms')
    words = ("-n", "a", "-n", "b", "./wobbles", "./wobbles", *TOOK, "--margin", "1%", "--time", "30s")
    done = run(folder, "compare", *words, "--export-json", "a.json")
    assert done.returncode in (0, 5), done.stderr
    told = {one["command"]: one["blocks"] for one in json.loads((folder / "a.json").read_text())["runs"]}
    assert told["a"] == told["b"] == list(range(len(told["a"])))
    assert len(told["a"]) > 8
    assert told["a again"] == [one for one in told["a"] if one < 6 or one % 4 == 0]
