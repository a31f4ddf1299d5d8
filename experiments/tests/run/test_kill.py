"""Killed with -9 at random moments, again and again: nothing finished is lost, nothing is torn."""

import json
import os
import random
import signal
import time

from experiments.run.session import run
from experiments.tests.conftest import CHUNKS, CONTROL, PAIR_APART, Workplace, no_child_is_left, until
from support.record_schema import is_record

KILLS = 10
BLOCKS = 6


def test_ten_kills_lose_at_most_one_process_each(empty_workplace: Workplace) -> None:
    workplace = empty_workplace
    for name, text in (("chunks", CHUNKS), ("pair", PAIR_APART), ("control", CONTROL)):
        workplace.question(name, more_blocks(text))
    workplace.behave(FAKE_SECONDS="0.1")
    moments = random.Random(20240229)
    before: dict[str, dict[str, object]] = {}
    for _ in range(KILLS):
        process = workplace.start("run", "--no-figures")
        wait_until_it_measures(workplace)
        time.sleep(moments.uniform(0, 0.5))
        os.kill(process.pid, signal.SIGKILL)
        process.communicate()
        no_child_is_left(workplace)
        records = workplace.records()
        lost = [name for name, record in before.items() if records.get(name) != record]
        assert len(lost) <= 1, "what was finished is there, but for the half of a block cut through before"
        for file in workplace.files():
            assert is_record(json.loads(file.read_bytes()))
        before = records
    assert before, "something was finished"
    assert not workplace.is_whole(), "the kills came while there was something to do"
    assert run(workplace.settings) == 0
    after = workplace.records()
    assert len([name for name, record in before.items() if after[name] != record]) <= 1
    rows = workplace.rows().values()
    least = [3 * BLOCKS, 2 * BLOCKS, 2 * BLOCKS]
    assert all(row.done >= done and not row.missing for row, done in zip(rows, least, strict=True))
    most_together = 3
    assert len(after) <= (3 + 2) * BLOCKS + 2 * (BLOCKS + KILLS), "no block but the control's is one too many"
    assert workplace.measured() <= len(after) + most_together * KILLS, "each kill cost one process at most"
    assert not (workplace.results / ".running").exists()
    assert not workplace.failures()


def more_blocks(text: str) -> str:
    head, _, _ = text.partition("[blocks]")
    return f"{head}[blocks]\nminimum = {BLOCKS}\nwanted = {BLOCKS}\n"


def wait_until_it_measures(workplace: Workplace) -> None:
    log = workplace.root / "log"
    size = log.stat().st_size if log.exists() else 0
    until(lambda: log.exists() and "--tag" in log.read_text()[size:], "the study does not begin", 20)
