"""What a study would have decided under the rules of this checkout, drawn from what one has measured:

    PYTHONPATH=. .venv/bin/python docs/notebook/replay.py RECORDED FOLDER MINUTES [SEED] [SCALE]

Each block is one RECORDED of the same contenders, drawn at random, and takes as long as that one did. All
else is as in a study: the order, the looks, the analysis and its time. FOLDER is made anew. The study needs
the programs and the machine that RECORDED is of, since these make the names of what was measured.
"""

import copy
import json
import random
import shutil
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from experiments.results.record import runs_of
from experiments.results.store import Found, Store
from experiments.run import session
from experiments.run.progress import ProgressDisplay
from experiments.run.runner import ProcessResult
from experiments.run.study import Settings, Study
from experiments.run.task import Task
from experiments.run.verdicts import Analysis

BESIDE = 1.23
"""How many times as long as its processes a study takes, checks and scenes included: 1.26 and 1.35 in two,
1.23 since final states that are known to be right are not checked again."""


class Replayed:
    """A runner that measures nothing, and the clock that goes on as if it had."""

    def __init__(self, recorded: Path, store: Store, seed: int) -> None:
        self.store, self.passed, self.chance = store, 0.0, random.Random(seed)
        self.there: dict[str, list[Any]] = {}
        for path in sorted((recorded / "records").glob("*/*/*.json")):
            record = json.loads(path.read_text(encoding="utf-8"))
            self.there.setdefault(path.parts[-3], []).append(record)

    def clock(self) -> float:
        """Seconds, of which those of recorded processes are only counted."""
        return time.monotonic() + self.passed

    def run(self, tasks: Sequence[Task], found: Found) -> list[ProcessResult]:
        """Take what was measured of these points together."""
        asked = {task.point.id: task for task in tasks}
        there = self.there.get(tasks[0].experiment.name, ())
        fitting = [
            one for one in there if {each["tags"]["point"] for each in one["contenders"]} == set(asked)
        ]
        if not fitting:
            return [ProcessResult(None, "was not recorded")] * len(tasks)
        record = copy.deepcopy(self.chance.choice(fitting))
        results = {}
        for one in record["contenders"]:
            point = one["tags"]["point"]
            one["tags"] |= asked[point].tags(self.store.session)
            results[point] = ProcessResult(float(one["process_seconds"]), runs=runs_of(record, one))
        found.take(record, self.store.keep(record))
        self.passed += BESIDE * sum(one.seconds or 0.0 for one in results.values())
        return [results[point] for point in asked]


def main(recorded: str, folder: str, minutes: str, seed: str = "1", scale: str = "paper") -> None:
    """Replay one study into the folder, and print what is decided when; `carom claims` tells the rest."""
    shutil.rmtree(folder, ignore_errors=True)
    settings = Settings(results=Path(folder), scale=scale, budget_seconds=60 * float(minutes))

    def runner(asked: Study) -> Replayed:
        replayed = Replayed(Path(recorded), asked.store, int(seed))
        began, tell = replayed.clock(), ProgressDisplay.line
        session.time = SimpleNamespace(monotonic=replayed.clock)  # type: ignore[assignment]

        def line(display: ProgressDisplay, text: str) -> None:
            tell(display, f"{replayed.clock() - began:6.0f} s {text}")

        ProgressDisplay.line = line  # type: ignore[method-assign]
        return replayed

    Study.runner = runner  # type: ignore[method-assign, assignment]
    ProgressDisplay.block = lambda *_: None  # type: ignore[method-assign]
    Analysis.report = lambda *_: Path(folder)  # type: ignore[method-assign]
    session.run(settings)


if __name__ == "__main__":
    main(*sys.argv[1:])
