"""A study replayed: its session decides as ever, but each block is drawn from those that a results folder
holds, and a clock of its own goes on by what they took, and by what the looks take here.

    python docs/notebook/replay.py RESULTS MINUTES [SEED ...]

tells a line a seed: how many claims were decided after each quarter of the minutes. It is to be called in the
checkout whose programs measured the folder. Of a question with few blocks it knows too little of the noise.
"""

import random
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from analysis import claims
from analysis.claims.missing import tally
from analysis.records import published
from analysis.records.reading import load
from analysis.records.studies import split
from experiments.results.store import Store
from experiments.run import session
from experiments.run.progress import ProgressDisplay
from experiments.run.runner import ProcessResult, Task
from experiments.run.study import COSTS, Settings, Study
from experiments.support.process import Coprocess
from support.files import read_json, write_json

BESIDE = 0.15
"""Seconds that a process takes beside its own account."""


class Replay:
    """What stands in the runner's place; `seconds` have passed since the study began."""

    def __init__(self, store: Store, recorded: Path, seed: int, quarter: float) -> None:
        self._store, self._random, self._quarter = store, random.Random(seed), quarter
        self.seconds, self.decided = 0.0, list[int]()
        self._records: dict[str, dict[int, Path]] = {}
        for file in recorded.glob("records/*/*.json"):
            point, _, block = file.stem.rpartition("-b")
            self._records.setdefault(point, {})[int(block)] = file

    def run(self, tasks: Sequence[Task]) -> list[ProcessResult]:
        """Take the records of one drawn block, as if it had been measured now."""
        there = [set(self._records.get(task.point.id, ())) for task in tasks]
        blocks = sorted(set.intersection(*there))
        if not blocks:
            return [ProcessResult(None, "is not recorded") for _ in tasks]
        drawn, ended = self._random.choice(blocks), []
        for task in tasks:
            record: Any = read_json(self._records[task.point.id][drawn])
            record["tags"] |= task.tags(self._store.session)
            self.seconds += record["process_seconds"]
            now = datetime(2026, 1, 1, tzinfo=UTC) + timedelta(seconds=round(self.seconds))
            record["recorded_at"] = now.isoformat(timespec="seconds")
            write_json(self._store.record_path(task.point, task.block), record, self._store.temporary)
            runs = [one["steps_seconds"] for one in record["repetitions"]]
            ended.append(ProcessResult(record["process_seconds"], runs=runs))
        self.seconds += BESIDE
        if self.seconds > self._quarter * (len(self.decided) + 1):
            self.decided.append(decided(self._store.root))
        return ended


def decided(results: Path) -> int:
    """How many claims are decided by the records there."""
    studies = split(load(results))
    return tally(claims.evaluate(studies[0], studies, published.load(), claims.load(results)))["decided"]


def replay(recorded: Path, minutes: float, seed: int) -> list[int]:
    """The claims decided after each quarter of the minutes."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(recorded / COSTS, folder)
        study = Study(Settings(results=Path(folder), budget_seconds=60 * minutes, figures=True))
        with (
            study.store.opened(),
            Coprocess(study.analysis_command()) as analysis,
            ProgressDisplay() as display,
        ):
            schedule = study.schedule(study.runner(), settle=True)
            replayed = Replay(study.store, recorded, seed, 15 * minutes)

            def ask(words: str, limit: float) -> Any:  # noqa: ANN401 - as the analysis answers
                began = time.perf_counter()
                answer = analysis.ask(words, limit)
                replayed.seconds += time.perf_counter() - began
                return answer

            session.time = SimpleNamespace(monotonic=lambda: replayed.seconds)  # type: ignore[assignment]
            asked: Any = SimpleNamespace(ask=ask)
            runner: Any = replayed
            session.Session(study, runner, schedule, display, asked).run()
            return [*replayed.decided[:3], decided(study.store.root)]


if __name__ == "__main__":
    for one in map(int, sys.argv[3:] or ["1"]):
        print(f"seed {one}:", *replay(Path(sys.argv[1]), float(sys.argv[2]), one), flush=True)
