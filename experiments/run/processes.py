"""Whole processes, of variants and of anybody's programs, timed from outside, in turns."""

import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from experiments.plan.point import Point, Tags
from experiments.plan.program import Program, build_of
from experiments.plan.scenes import SceneFile
from experiments.results.store import Store
from experiments.run.host_lock import run_alone
from experiments.support.process import Completed

MARGIN_SECONDS = 60.0
"""What measuring takes beside the processes, before it is given up."""

Asked = tuple[Point, SceneFile | None, Tags]


class Processes:
    """Runs `carom processes`, which lets them run in turn and leaves a record, or a failure, of each."""

    def __init__(self, store: Store, instrument: Program, time_limit: float) -> None:
        self._store = store
        self._instrument = instrument
        self._time_limit = time_limit

    def measure(self, points: Sequence[Asked], seed: int) -> tuple[Completed, list[Path]]:
        """How it went, and where each record or failure is, if there is one."""
        folder = self._store.temporary / "processes"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        records = [folder / f"{number}.json" for number in range(len(points))]
        described = [self._described(*one, record) for one, record in zip(points, records, strict=True)]
        described_in = folder / "processes.json"
        described_in.write_text(json.dumps(described), encoding="utf-8")
        command = (str(self._instrument.path), "processes", str(described_in), "--seed", str(seed))
        # The instrument itself is bound nowhere: what it starts would inherit that.
        return run_alone(command, (), self._time_limit * len(points) + MARGIN_SECONDS), records

    def _described(self, point: Point, scene: SceneFile | None, tags: Tags, record: Path) -> dict[str, Any]:
        output = record.with_suffix(".benchmark").absolute()
        path = scene.path.absolute() if scene is not None else None
        described: dict[str, Any] = {
            "command": point.process_words(path, output),
            "environment": dict(point.openmp),
            "most_seconds": self._time_limit,
            "record": str(record),
            "tags": [f"{key}={value}" for key, value in tags.items()],
            "sources": [str(file) for file in point.program.sources],
            "threads": point.threads,
            "axes": {key: value for key, value in point.axes.items() if value is not None},
            "warm_ups": point.warm_up,
        }
        if path is not None:
            described["scene"] = str(path)
        if point.command is None and point.program.sha256 != self._instrument.sha256:
            described["build"] = build_of(point.program)
        if point.is_checked:
            described["checked"] = "every-step" if point.command is None else "trajectory"
        if point.command is not None:
            described |= {"folder": str(point.command.folder), "unit_seconds": point.command.unit_seconds}
            if point.command.pattern is not None:
                described["pattern"] = point.command.pattern
            if point.command.benchmark is not None:
                described |= {"benchmark": point.command.benchmark, "output": str(output)}
        return described
