"""Whole processes, of variants and of anybody's programs, timed from outside, in turns."""

import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.plan.command import Command, placed
from experiments.plan.point import PROCESS, Point, Tags
from experiments.plan.program import Program, build_of
from experiments.plan.scenes import SceneFile
from experiments.results.store import Store
from experiments.run.behaviour import Behaviours
from experiments.run.host_lock import run_alone
from experiments.run.progress import warn
from experiments.run.together import is_alike, is_left_open
from experiments.support.process import Completed
from support.files import read_json, write_json
from support.record_schema import is_record
from support.vocabulary import PAUSES

MARGIN_SECONDS = 60.0
"""What measuring takes beside the processes, before it is given up."""

CROWDED = "too many are compared to wait in memory side by side"
"""Why a program is not stopped."""

SLICE_SECONDS, SHORT_SECONDS = 0.01, 0.002
"""Of a slice, and of one in every third block: from the two the analysis knows what a stop costs
(analysis/statistics/stopping.py). The noise of a virtual machine changes within some milliseconds.
"""

HINDERED_SECONDS = 0.025
"""Of a slice where other programs have the processors: who goes on there is often moved to another one, whose
caches hold nothing of it."""

_RUNS = 8
"""Of each at most: one to look at it, two in slices, and where these disagree two more of either kind."""


@dataclass(frozen=True)
class Asked:
    """A point to be measured, the file of its scene, what its record is to remember, how what it does was
    checked, whether it may take turns with others at all, and whether it does not because more are compared
    than memory holds at once.
    """

    point: Point
    scene: SceneFile | None
    tags: Tags
    checked: str = ""
    turns: bool = True
    crowded: bool = False


@dataclass(frozen=True)
class Left:
    """What was measured: the point, the file with its record or failure, if there is one, and the one that it
    wrote itself, if it was to write one.
    """

    point: Point
    record: Path
    output: Path


class Processes:
    """Runs `carom processes`, which lets them run in turn and leaves a record, or a failure, of each.

    Where it `tells`, a line says of a program why it is not stopped; the record says it in any case.
    """

    def __init__(
        self,
        store: Store,
        instrument: Program,
        time_limit: float,
        *,
        tells: bool = True,
    ) -> None:
        self._store = store
        self._instrument = instrument
        self._time_limit = time_limit
        self._tells = tells
        self._slice = SLICE_SECONDS
        self._behaviours = Behaviours(store)

    def measure(
        self, asked: Sequence[Asked], seed: int, slice_seconds: float
    ) -> tuple[Completed, list[Left]]:
        """How it went, and what is left of each; the shortest runs for so many seconds before the next does.

        All are measured a second time where one turns out to mind being stopped and others were in slices: on
        a busy machine a program takes another time in slices than as a whole.
        """
        self._slice = slice_seconds
        done, left = self._run(asked, seed)
        found = self._learn(asked, left)
        if any(found) and any(map(_was_sliced, asked, left)):
            done, left = self._run(asked, seed)
            _say_why_whole(asked, left, found, self._store.temporary)
        for one, there in zip(asked, left, strict=True):
            if one.turns and one.crowded:
                _write_why(there, CROWDED, self._store.temporary)
        return done, left

    def _learn(self, asked: Sequence[Asked], left: Sequence[Left]) -> list[str]:
        """Take in what the records tell; returns of each why it is not to be stopped, if that is news."""
        is_open = [self._turns(one, asked) is None for one in asked]
        found = [
            self._behaviours.learn(one.point, read_json(there.record), found_out=left_open)
            for one, there, left_open in zip(asked, left, is_open, strict=True)
        ]
        for one, said in zip(asked, found, strict=True):
            if said and self._tells:
                warn(f"{one.point.experiment}, {one.point.series}: measured without a pause: {said}")
        return found

    def write_trajectory(self, point: Point, scene: Path, output: Path) -> Completed:
        """Run the point's command for a trajectory, with all that it starts, once and untimed."""
        command, record = point.command, self._folder() / "trajectory.json"
        assert command is not None
        words = placed(command.trajectory, scene, output)
        described = {
            **self._surroundings(command, scene, output),
            "command": words,
            "environment": dict(point.openmp),
            "record": str(record),
            "axes": {"threads": 1},
        }
        done = self._call([described], 1, self._time_limit * _commands(command))
        match read_json(record):
            case {"kind": "failure", "exit_code": int(exit_code), "reason": str(reason)}:
                return Completed(words, exit_code or 1, "", reason)
            case {"kind": "process"}:
                return Completed(words, 0, "", "")
        return Completed(words, done.exit_code or 1, "", done.error or "left no record")

    def _run(self, asked: Sequence[Asked], seed: int) -> tuple[Completed, list[Left]]:
        folder = self._folder()
        left = [
            Left(one.point, folder / f"{number}.json", folder.absolute() / f"{number}.output")
            for number, one in enumerate(asked)
        ]
        described = [
            self._described(one, there, self._turns(one, asked))
            for one, there in zip(asked, left, strict=True)
        ]
        limit = sum((_RUNS + one.point.warm_up) * _commands(one.point.command) for one in asked)
        return self._call(described, seed, self._time_limit * limit), left

    def _folder(self) -> Path:
        folder = self._store.temporary / "processes"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        return folder

    def _call(self, described: Sequence[dict[str, Any]], seed: int, seconds: float) -> Completed:
        file = self._store.temporary / "processes" / "processes.json"
        file.write_text(json.dumps(described), encoding="utf-8")
        command = (str(self._instrument.path), "processes", str(file), "--seed", str(seed))
        in_slices = (*command, "--slice", str(self._slice))
        # The instrument itself is bound nowhere: what it starts would inherit that.
        return run_alone(in_slices, (), seconds + MARGIN_SECONDS)

    def _turns(self, one: Asked, beside: Sequence[Asked]) -> bool | None:
        """Whether it takes turns with those beside it, as it is said or was found out. If one minds, none of
        those does that are to be measured alike.
        """
        said = _said(one)
        if said is not None:
            return said
        alike = [other for other in beside if _is_alike(other)] if _is_alike(one) else [one]
        known = [self._behaviours.of(other.point).turns for other in alike]
        return False if False in known else self._behaviours.of(one.point).turns

    def _described(self, one: Asked, left: Left, turns: bool | None) -> dict[str, Any]:
        point, command = one.point, one.point.command
        program, path = point.program, one.scene.path.absolute() if one.scene is not None else None
        is_benchmark = command is not None and command.benchmark is not None
        is_other_build = command is None and program.sha256 != self._instrument.sha256
        told: dict[str, Any] = {
            "command": point.process_words(path, left.output),
            "environment": dict(point.openmp),
            "most_seconds": self._time_limit,
            "record": str(left.record),
            "tags": [f"{key}={value}" for key, value in one.tags.items()],
            "sources": [str(file) for file in program.sources],
            "threads": point.threads,
            "axes": {key: value for key, value in point.axes.items() if value is not None},
            "warm_ups": point.warm_up,
            "checked": one.checked,
            "scene": str(path) if path is not None else None,
            "written": {str(file): program.hash_of[file] for file in program.written} or None,
            "expected_seconds": self._behaviours.of(point).expected_seconds,
            "build": build_of(program) if is_other_build else None,
            "output": str(left.output) if is_benchmark else None,
            "turns": None if is_benchmark else turns,
        }
        if command is not None:
            told |= self._surroundings(command, path, left.output)
            told |= {
                name: getattr(command, name) for name in ("unit_seconds", "pattern", "benchmark", "rounds")
            }
        return {key: value for key, value in told.items() if value is not None}

    def _surroundings(
        self, command: Command, scene: Path | None = None, output: Path | None = None
    ) -> dict[str, Any]:
        """Where a command is run, with what before and after it, and how it may end."""
        around = {
            "prepare": placed(command.prepare, scene, output),
            "conclude": placed(command.conclude, scene, output),
            "fresh_folder": command.fresh_folder,
            "exit_codes": command.exit_codes,
        }
        where = {"folder": str(command.folder), "most_seconds": self._time_limit}
        return where | {key: value for key, value in around.items() if value}


def slice_of(point: Point, block: int) -> float:
    """How long a slice is; always the same where it is asked what stops do."""
    return SHORT_SECONDS if block % 3 == 1 and point.kind != PAUSES else SLICE_SECONDS


def _said(one: Asked) -> bool | None:
    """Whether it takes turns, if that is not left to be found out."""
    if not one.turns or one.point.apart or one.crowded:
        return False
    if is_left_open(one.point):
        return None
    return one.point.command is not None and bool(one.point.command.turns)


def _is_alike(one: Asked) -> bool:
    return _said(one) is None and is_alike(one.point)


def _was_sliced(one: Asked, left: Left) -> bool:
    """Whether it was, and is not to be if another minds."""
    record = read_json(left.record)
    return _is_alike(one) and isinstance(record, dict) and bool(record.get("turns"))


def _say_why_whole(
    asked: Sequence[Asked], left: Sequence[Left], found: Sequence[str], temporary: Path
) -> None:
    """Write into the records why nobody was stopped, `found` of those that mind."""
    minds = next(one.point.series for one, said in zip(asked, found, strict=True) if said)
    for one, there, said in zip(asked, left, found, strict=True):
        if _is_alike(one):
            _write_why(there, said or f"{minds} must not be, and all are measured alike", temporary)


def _write_why(left: Left, why: str, temporary: Path) -> None:
    record = read_json(left.record)
    if is_record(record) and record["kind"] == PROCESS:
        record["process"]["undisturbed"] = why
        write_json(left.record, record, temporary)


def _commands(command: Command | None) -> int:
    """How many commands a run consists of."""
    return 1 if command is None else 1 + bool(command.prepare) + bool(command.conclude)
