"""Results folders with as many records as asked for, all of one question, each like one that was measured."""

import json
from pathlib import Path
from typing import Any

from experiments.results.store import new_session
from experiments.run.runner import Task
from experiments.run.study import Settings, Study
from support.errors import InputError
from support.files import read_json, to_json

NAME = "made_up"
POINTS = 40

_QUESTION = f"""title = "Made up"
figure = "trend"
threads = 1

[sweep]
parameter = "value"
values = {list(range(1, POINTS + 1))}

[[series]]
name = "nothing"
command = ["sh", "-c", "exit 0 # {{value}}"]
"""


def made_up_study(folder: Path) -> Study:
    """The study whose records they are; its question's file is written."""
    questions = folder / "questions"
    questions.mkdir(parents=True, exist_ok=True)
    (questions / f"{NAME}.toml").write_text(_QUESTION, encoding="utf-8")
    return Study(Settings(questions=questions, results=folder / "results"))


def fill(study: Study, records: int, size: int) -> None:
    """Write so many records of so many bytes each. Raises InputError where one cannot be measured."""
    [experiment] = study.experiments
    template = _measured(study)
    session = new_session()
    for number in range(records):
        block, at = divmod(number, POINTS)
        point = experiment.points[at]
        tags = {**point.tags, "block": block, "position": at, "session": session, "title": "Made up"}
        tags |= {"points_planned": POINTS, "blocks_planned": records // POINTS}
        path = study.store.record_path(point, block)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(_of_size({**template, "tags": tags, "process_seconds": 1 + 1e-6 * number}, size))


def _measured(study: Study) -> dict[str, Any]:
    """A record of the question's first point."""
    [experiment] = study.experiments
    with study.store.opened():
        [done] = study.runner().run([Task(experiment, experiment.points[0], 0, 0, 1, 1)])
    if done.seconds is None:
        raise InputError(f"made-up records: a first one cannot be measured: {done.reason}")
    found = read_json(study.store.record_path(experiment.points[0], 0))
    assert isinstance(found, dict)
    return found


def _of_size(record: dict[str, Any], size: int) -> bytes:
    """The record with as many timed runs as make it so large."""
    run = {"steps_seconds": 0.123456789, "cpu_seconds": 0.123456789}
    lacking = size - len(json.dumps(record, indent=1))
    runs = [run] * max(1, lacking // len(json.dumps(run)))
    return to_json({**record, "repetitions": runs})
