"""Whole processes, of variants and of anybody's programs, timed from outside, in turns."""

import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from experiments.plan.command import placed
from experiments.plan.point import Point
from experiments.plan.program import Program, build_of
from experiments.plan.scenes import SceneFile
from experiments.results.record import Record, is_failed
from experiments.results.store import Store
from experiments.run.behaviour import Behaviours
from experiments.run.host_lock import host_lock
from experiments.run.process_record import Described, process_record
from experiments.run.progress import warn
from experiments.run.sources import Sources
from experiments.run.task import Ready, Task
from experiments.side_by_side.contest import Contender, Contest, Entrant
from experiments.side_by_side.sampler import Sampler, SamplerError
from experiments.support.process import Completed
from support.vocabulary import PAUSES

CROWDED = "too many are compared to wait in memory side by side"
"""Why a program is not stopped."""

SLICE_SECONDS, SHORT_SECONDS = 0.01, 0.002
"""Of a slice, and of one in every third block: from the two the analysis knows what a stop costs
(analysis/statistics/turns.py). The noise of a virtual machine changes within some milliseconds.
"""

HINDERED_SECONDS = 0.025
"""Of a slice where other programs have the processors: who goes on there is often moved to another one, whose
caches hold nothing of it."""


class Processes:
    """Measures whole processes beside each other, and tells their record.

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

    def measure(self, ready: Sequence[Ready], seed: int, slice_seconds: float) -> tuple[Record, list[Path]]:
        """Their record, and what each wrote itself, if it was to; the shortest runs for so many seconds
        before the next does.

        All are measured a second time where one turns out to mind being stopped and others were in slices: on
        a busy machine a program takes another time in slices than as a whole.
        """
        self._slice = slice_seconds
        tasks = [task for task, _ in ready]
        record, outputs = self._run(ready, seed)
        found = self._learn(tasks, record)
        if any(found) and any(map(_was_sliced, tasks, record["contenders"])):
            record, outputs = self._run(ready, seed)
            _say_why_whole(tasks, record, found)
        for task, there in zip(tasks, record["contenders"], strict=True):
            if task.is_crowded:
                _say_why(there, CROWDED)
        return record, outputs

    def _learn(self, tasks: Sequence[Task], record: Record) -> list[str]:
        """Take in what the record tells; returns of each why it is not to be stopped, if that is news."""
        is_open = [self._turns(one, tasks) is None for one in tasks]
        found = [
            self._behaviours.learn(one.point, there, found_out=left_open)
            for one, there, left_open in zip(tasks, record["contenders"], is_open, strict=True)
        ]
        for one, said in zip(tasks, found, strict=True):
            if said and self._tells:
                warn(f"{one.point.experiment}, {one.point.series}: measured without a pause: {said}")
        return found

    def write_trajectory(self, point: Point, scene: Path, output: Path) -> Completed:
        """Run the point's command for a trajectory, with all that it starts, once and untimed."""
        command = point.command
        assert command is not None
        words = placed(command.trajectory, scene, output)
        whole = self._undisturbed(point, words, scene, output)
        contender = replace(whole, pattern=None, benchmark=None, rounds=None)
        with host_lock(), Sampler(self._instrument.path) as sampler:
            [ended] = Contest(sampler, [contender], self._slice, 1, self._folder()).measure()
        return Completed(words, ended.exit_code if ended.failure else 0, "", ended.failure)

    def _run(self, ready: Sequence[Ready], seed: int) -> tuple[Record, list[Path]]:
        folder = self._folder()
        outputs = [folder.absolute() / f"{number}.output" for number in range(len(ready))]
        turns = [self._turns(task, [one for one, _ in ready]) for task, _ in ready]
        contenders = [
            self._contender(task.point, _path(scene), output, its)
            for (task, scene), output, its in zip(ready, outputs, turns, strict=True)
        ]
        sources = [_sources_of(task.point.program) for task, _ in ready]
        # The instrument itself is bound nowhere: what it starts would inherit that.
        with host_lock(), Sampler(self._instrument.path) as sampler:
            ended = Contest(sampler, contenders, self._slice, seed, folder).measure()
            described = [
                self._described(sampler, one, *its, files)
                for one, its, files in zip(ended, ready, sources, strict=True)
            ]
        return process_record([*zip(ended, described, strict=True)], seed), outputs

    def _described(
        self, sampler: Sampler, ended: Entrant, task: Task, scene: SceneFile | None, sources: Sources
    ) -> Described:
        point = task.point
        is_other_build = point.command is None and point.program.sha256 != self._instrument.sha256
        surroundings: tuple[Record, Any] = {}, None
        try:
            if not ended.failure:
                surroundings = sampler.surroundings(point.threads, _path(scene))
        except SamplerError as error:
            ended.failure = str(error)
        return Described(
            task.tags(self._store.session),
            {key: value for key, value in point.axes.items() if value is not None},
            sources,
            task.scope,
            build_of(point.program) if is_other_build else None,
            surroundings,
        )

    def _folder(self) -> Path:
        folder = self._store.temporary / "processes"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        return folder

    def _turns(self, one: Task, beside: Sequence[Task]) -> bool | None:
        """Whether it takes turns with those beside it, as it is said or was found out. If one minds, none of
        those does that are to be measured alike.
        """
        if one.turns is not None:
            return one.turns
        alike = [other for other in beside if other.is_alike] if one.is_alike else [one]
        known = [self._behaviours.of(other.point).turns for other in alike]
        return False if False in known else self._behaviours.of(one.point).turns

    def _contender(self, point: Point, path: Path | None, output: Path, turns: bool | None) -> Contender:
        return replace(
            self._undisturbed(point, point.process_words(path, output), path, output),
            warm_ups=point.warm_up,
            expected_seconds=self._behaviours.of(point).expected_seconds or 0.0,
            turns=turns,
            output=output,
        )

    def _undisturbed(
        self, point: Point, words: tuple[str, ...], scene: Path | None, output: Path
    ) -> Contender:
        """Words that are run as the point's command is, with what goes before and after it."""
        folder, manner = "", dict[str, Any]()
        if (command := point.command) is not None:
            folder = str(command.folder)
            manner = command.manner
            manner |= {name: placed(manner[name], scene, output) for name in ("prepare", "conclude")}
        return Contender(words, folder, dict(point.openmp), self._time_limit, **manner)


def slice_of(point: Point, block: int) -> float:
    """How long a slice is; always the same where it is asked what stops do."""
    return SHORT_SECONDS if block % 3 == 1 and point.kind != PAUSES else SLICE_SECONDS


def _path(scene: SceneFile | None) -> Path | None:
    return scene.path.absolute() if scene is not None else None


def _was_sliced(one: Task, there: Record) -> bool:
    """Whether it was, and is not to be if another minds."""
    return one.is_alike and bool(there.get("slices"))


def _say_why_whole(tasks: Sequence[Task], record: Record, found: Sequence[str]) -> None:
    """Let the record say why nobody was stopped, `found` of those that mind."""
    minds = next(one.point.series for one, said in zip(tasks, found, strict=True) if said)
    for one, there, said in zip(tasks, record["contenders"], found, strict=True):
        if one.is_alike:
            _say_why(there, said or f"{minds} must not be, and all are measured alike")


def _say_why(there: Record, why: str) -> None:
    if not is_failed(there):
        there["process"]["undisturbed"] = why


def _sources_of(program: Program) -> Sources:
    known = program.hash_of
    return Sources(program.sources, {file: known.get(file) or "" for file in program.written})
