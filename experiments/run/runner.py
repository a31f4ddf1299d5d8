"""Points measured, from their scenes to their records or to the reasons why there are none."""

import json
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.point import PROCESS, Point
from experiments.plan.program import CHECK_FAILED, Program, generate
from experiments.plan.scenes import AnyScene, NoScene, SceneFile, SceneFolder
from experiments.results.record import (
    Record,
    failed,
    is_failed,
    new_record,
    runs_of,
    together_in,
    unusable,
)
from experiments.results.store import Found, Store
from experiments.run.host_lock import run_alone
from experiments.run.machine_limits import measure_limits
from experiments.run.processes import Processes, slice_of
from experiments.run.task import Ready, Task
from experiments.run.verify import Verifier
from experiments.support.digest import digest
from experiments.support.process import NOT_FOUND, Completed
from support.errors import InputError
from support.files import move, read_json
from support.record_schema import is_record
from support.vocabulary import COUNTS

SUSPENDED = "while it was measured; measure it again"
"""What the program says at last where it, or the machine, stood still: nothing of that run counts."""

_MOST_SUSPENSIONS = 3
"""One after the other: then they are left to the next run."""


@dataclass(frozen=True)
class ProcessResult:
    """Seconds that a point took of its process, and of its timed runs, or the reason of its failure with the
    exit code.
    """

    seconds: float | None
    reason: str = ""
    exit_code: int = 0
    runs: Sequence[float] = ()


class Runner:
    """Runs tasks, one process at a time; each process leaves a record in the store."""

    def __init__(
        self,
        store: Store,
        scenes: SceneFolder,
        generator: Program,
        time_limit: float,
        slice_seconds: float | None = None,
        *,
        tells: bool = True,
        refuse: Callable[[Point], Completed | None] = lambda _: None,
    ) -> None:
        """`refuse` says why a point cannot be measured on this machine, if so."""
        self._store = store
        self._scenes = scenes
        self._generator = generator
        self._time_limit = time_limit
        self.slice_seconds = slice_seconds
        """How long a whole program runs before the next does; see `slice_of` without it."""
        self._refuse = refuse
        self._processes = Processes(store, generator, time_limit, tells=tells)
        self._right_ends: dict[str, str] = {}
        """By point, the hash of the final state whose last step was found right: it is the same each time."""
        self._verifier = Verifier(store, generator, self._processes, time_limit)

    def run(self, tasks: Sequence[Task], found: Found | None = None) -> list[ProcessResult]:
        """Verify the points' variants as far as that is still to be done, then measure the points: several of
        them in turns, in one process. What came of it is taken into what was `found`.

        Raises InputError only for what concerns the whole study: a program that changed under it.
        """
        prepared = [self._prepare(task) for task in tasks]
        ready = [
            (task, one) for task, one in zip(tasks, prepared, strict=True) if not isinstance(one, Completed)
        ]
        record = self._measure_undisturbed(ready) if ready else new_record("failure", ())
        measured = iter(record["contenders"])
        contenders = [
            self._failed(task, one) if isinstance(one, Completed) else next(measured)
            for task, one in zip(tasks, prepared, strict=True)
        ]
        for task, one in zip(tasks, contenders, strict=True):
            if is_failed(one):
                _require_unchanged(task.point)
        is_measured = not all(map(is_failed, contenders))
        record = record | {"contenders": contenders} if is_measured else new_record("failure", contenders)
        path = self._store.keep(record)
        if found is not None:
            found.take(record, path)
        for task, one in zip(tasks, contenders, strict=True):
            if not is_failed(one):
                task.point.program.require_nothing_made()
        return [_result(record, one) for one in contenders]

    def _measure_undisturbed(self, ready: Sequence[Ready]) -> Record:
        """All of them, and all of them again if one was suspended: alone it would be no pair."""
        for attempt in range(1, _MOST_SUSPENSIONS + 1):
            record = self._measure_all(ready)
            ended = record["contenders"]
            if attempt == _MOST_SUSPENSIONS or not any(SUSPENDED in one.get("reason", "") for one in ended):
                break
        return record

    def _measure_all(self, ready: Sequence[Ready]) -> Record:
        if ready[0][0].point.verb == PROCESS:
            return self._measure_processes(ready)
        if len(ready) > 1:
            record = self._measure_in_turns(ready)
            if record is not None:
                return record
        return together_in([self._measure(task, scene) for task, scene in ready])

    def _prepare(self, task: Task) -> SceneFile | Completed | None:
        """The point's scene, if it has one, once what runs is verified; or why it cannot be measured."""
        point = task.point
        refused = self._refuse(point)
        if point.refused:
            assert point.command is not None
            refused = Completed(point.command.words, NOT_FOUND, "", point.refused)
        if refused is not None:
            return refused
        if isinstance(point.scene, NoScene):
            return None
        if point.program.sha256 is None:
            command = (str(point.program.path), point.verb)
            return Completed(command, NOT_FOUND, "", point.program.remedy)
        try:
            scene = self.scene(point.scene)
            checked = self.scene(task.checked.scene)
        except InputError as error:
            return Completed((str(self._generator.path), "generate"), 1, "", str(error))
        if point.is_checked:
            verdict = self._verifier.check(task.checked, checked)
            if verdict.exit_code != 0:
                return verdict
        return measure_limits(self._store, point, self._time_limit) or scene

    def scene(self, scene: AnyScene) -> SceneFile:
        """The scene's file, generated if need be."""
        return self._scenes.get(scene, lambda wanted, path: generate(self._generator, wanted, path))

    def _measure_processes(self, ready: Sequence[Ready]) -> Record:
        """Whole processes that are compared, side by side in slices of time."""
        first = ready[0][0]
        slice_seconds = self.slice_seconds or slice_of(first.point, first.block)
        record, outputs = self._processes.measure(ready, seed_of(first), slice_seconds)
        done = Completed((str(self._generator.path), "processes"), 0, "", "")
        measured = zip(ready, record["contenders"], outputs, strict=True)
        contenders = [
            self._checked_output(task, scene, self._usable(task, record, one, done), output)
            for (task, scene), one, output in measured
        ]
        return record | {"contenders": contenders}

    def _checked_output(self, task: Task, scene: SceneFile | None, one: Record, output: Path) -> Record:
        """A process; of one that wrote a trajectory only if that is right."""
        command = task.point.command
        if is_failed(one) or command is None or not command.writes_trajectory or scene is None:
            return one
        wrong = self._verifier.check_own_output(task.point, scene, output)
        output.unlink(missing_ok=True)
        return one if wrong is None else self._failed(task, wrong)

    def _measure_in_turns(self, ready: Sequence[Ready]) -> Record | None:
        """All of them in one process; None if it broke off: each must show alone what is wrong with it.

        Nothing is wrong with those that stood still: they have failed, and are measured together again by the
        next run. Alone they would be no pairs.
        """
        folder = self._store.temporary / "turns"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        commands = [
            task.point.bench_words(_path(scene), task.tags(self._store.session)) for task, scene in ready
        ]
        first = ready[0][0]
        contenders, scratch = folder / "contenders.json", folder / "record.json"
        contenders.write_text(json.dumps([words[2:] for words in commands]), encoding="utf-8")
        is_count = first.point.kind == COUNTS
        options = ("--counts",) if is_count else ("--seed", str(seed_of(first)), "--runs", str(first.runs))
        ends = {self._right_ends[one.point.id] for one, _ in ready if one.point.id in self._right_ends}
        if ends and not is_count:
            options = (*options, "--right-ends", *sorted(ends))
        command = (commands[0][0], "turns", str(contenders), "--record", str(scratch), *options)
        done = run_alone(command, first.point.openmp, self._time_limit * len(ready) * first.runs)
        if done.exit_code > 0 and SUSPENDED in done.reason:
            return new_record("failure", [self._failed(task, done) for task, _ in ready])
        record = read_json(scratch)
        if done.exit_code not in (0, CHECK_FAILED) or not is_record(record):
            return None
        measured = [*zip(ready, commands, record["contenders"], strict=True)]
        for (task, _), _, one in measured:
            if not is_failed(one) and one["check"]["verdict"] == "passed":
                self._right_ends[task.point.id] = one["state_hash"]
        return record | {
            "contenders": [
                self._usable(task, record, one, Completed(words, done.exit_code, "", done.error))
                for (task, _), words, one in measured
            ]
        }

    def _measure(self, task: Task, scene: SceneFile | None) -> Record:
        point = task.point
        scratch = self._store.temporary / "record.json"
        scratch.unlink(missing_ok=True)
        drawn = is_drawn(point, task.block)
        timeline = self._store.temporary / "timeline.json" if drawn else None
        words = point.bench_words(
            _path(scene), task.tags(self._store.session), timeline, point.besides(task.block)
        )
        done = run_alone((*words, "--record", str(scratch)), point.openmp, self._time_limit)
        record = read_json(scratch)
        if done.exit_code not in (0, CHECK_FAILED) or not is_record(record):
            if done.exit_code == 0:
                unlike = "a record that cannot be used: it does not match the record schema"
                done = Completed(done.command, 1, "", f"left {'no record' if record is None else unlike}")
            return new_record("failure", [self._failed(task, done)])
        one = self._usable(task, record, record["contenders"][0], done)
        if timeline is not None and timeline.exists() and not is_failed(one):
            move(timeline, self._store.root / "timelines" / point.timeline)
        return new_record("failure", [one]) if is_failed(one) else record | {"contenders": [one]}

    def _usable(self, task: Task, record: Record, one: Record, done: Completed) -> Record:
        """A contender as a process left it, or why it does not count."""
        if is_failed(one):
            return self._failed(task, Completed(tuple(one["command"]), one["exit_code"], "", one["reason"]))
        wrong = unusable(record, one, task.point, task.block)
        if wrong is None:
            return one
        violation = one["check"]["reason"]
        if done.exit_code == CHECK_FAILED and violation:
            return self._failed(task, Completed(done.command, CHECK_FAILED, "", violation))
        return self._failed(
            task, Completed(done.command, 1, "", f"left a record that cannot be used: {wrong}")
        )

    def _failed(self, task: Task, done: Completed) -> Record:
        return failed(task.point, done, task.tags(self._store.session))


def _result(record: Record, one: Record) -> ProcessResult:
    if is_failed(one):
        return ProcessResult(None, one["reason"], one["exit_code"])
    return ProcessResult(float(one["process_seconds"]), runs=runs_of(record, one))


def _require_unchanged(point: Point) -> None:
    """Raises InputError where a file of the point's program is not what it was."""
    if point.program.sha256 is not None and not point.refused:
        point.program.require_unchanged()


def _path(scene: SceneFile | None) -> Path:
    assert scene is not None
    return scene.path


def seed_of(task: Task) -> int:
    """Of the order of turns: another one for every block and every seed of the study, odd in every second
    block, which begins with half a turn. It fits into 32 bits, which any reader of JSON holds.
    """
    drawn = int(digest(f"turns {task.experiment.order_seed} {task.block}")[:8], 16)
    return drawn // 2 * 2 + task.block % 2


def is_drawn(point: Point, block: int) -> bool:
    """Whether the process leaves a timeline: one a point of the phases is enough to see who waits."""
    return point.verb == "profile" and point.kind == "phases" and block == 0
