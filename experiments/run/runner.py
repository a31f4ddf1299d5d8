"""Points measured, from their scenes to their records or to the reasons why there are none."""

import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.plan import Experiment
from experiments.plan.point import PROCESS, Point, Tags
from experiments.plan.program import CHECK_FAILED, Program, generate
from experiments.plan.scenes import AnyScene, NoScene, SceneFile, SceneFolder
from experiments.results.store import Store
from experiments.results.summary import summary_of, unusable
from experiments.run.host_lock import run_alone
from experiments.run.machine_limits import measure_limits
from experiments.run.processes import Asked, Left, Processes, slice_of
from experiments.run.together import have_room, is_alike
from experiments.run.verify import Verifier, representative, scope_of
from experiments.support.digest import digest
from experiments.support.process import NOT_FOUND, Completed
from support.errors import InputError
from support.files import move, read_json, write_json
from support.record_schema import is_record
from support.vocabulary import COUNTS

SUSPENDED = "while it was measured; measure it again"
"""What the program says at last where it, or the machine, stood still: nothing of that run counts."""

_MOST_SUSPENSIONS = 3
"""One after the other: then they are left to the next run."""


@dataclass(frozen=True)
class Task:
    """A point in one block of its experiment; planned are so many `blocks`, and `points` in this one."""

    experiment: Experiment
    point: Point
    block: int
    position: int
    blocks: int
    points: int
    runs: int = 1
    """Timed runs of each point in the process, where several points take turns in it."""

    def tags(self, session: str) -> Tags:
        """Everything that the record remembers of the plan."""
        return {
            **self.point.tags,
            "title": self.experiment.question.title,
            "block": self.block,
            "position": self.position,
            "session": session,
            "order_seed": self.experiment.order_seed,
            "points_planned": self.points,
            "blocks_planned": self.blocks,
        }


@dataclass(frozen=True)
class ProcessResult:
    """Seconds of the whole process and of its timed runs, or the reason of its failure with the exit code."""

    seconds: float | None
    reason: str = ""
    exit_code: int = 0
    runs: Sequence[float] = ()


Ready = tuple[Task, SceneFile | None]
"""A task whose point may be measured, and its scene's file."""


class Runner:
    """Runs tasks, one process at a time; each leaves a record or a failure in the store."""

    def __init__(
        self,
        store: Store,
        scenes: SceneFolder,
        generator: Program,
        time_limit: float,
        slice_seconds: float | None = None,
        *,
        tells: bool = True,
    ) -> None:
        self._store = store
        self._scenes = scenes
        self._generator = generator
        self._time_limit = time_limit
        self.slice_seconds = slice_seconds
        """How long a whole program runs before the next does; see `slice_of` without it."""
        self._processes = Processes(store, generator, time_limit, tells=tells)
        self._verifier = Verifier(store, generator, self._processes, time_limit)

    def run(self, tasks: Sequence[Task]) -> list[ProcessResult]:
        """Verify the points' variants as far as that is still to be done, then measure the points: several of
        them in turns, in one process.

        Raises InputError only for what concerns the whole study: a program that changed under it.
        """
        prepared = [self._prepare(task) for task in tasks]
        ready = [
            (task, scene)
            for task, scene in zip(tasks, prepared, strict=True)
            if not isinstance(scene, ProcessResult)
        ]
        measured = iter(self._measure_undisturbed(ready))
        return [one if isinstance(one, ProcessResult) else next(measured) for one in prepared]

    def _measure_undisturbed(self, ready: Sequence[Ready]) -> list[ProcessResult]:
        """All of them, and all of them again if one was suspended: alone it would be no pair."""
        for attempt in range(1, _MOST_SUSPENSIONS + 1):
            ended = self._measure_all(ready)
            if attempt == _MOST_SUSPENSIONS or not any(SUSPENDED in one.reason for one in ended):
                break
        return ended

    def _measure_all(self, ready: Sequence[Ready]) -> list[ProcessResult]:
        if ready and ready[0][0].point.verb == PROCESS:
            return self._measure_processes(ready)
        if len(ready) > 1:
            ended = self._measure_in_turns(ready)
            if ended is not None:
                return ended
        return [self._measure(task, scene) for task, scene in ready]

    def _prepare(self, task: Task) -> SceneFile | ProcessResult | None:
        """The point's scene, if it has one, once what runs is verified; or why it cannot be measured."""
        point = task.point
        if point.refused:
            assert point.command is not None
            return self._fail(task, Completed(point.command.words, NOT_FOUND, "", point.refused))
        if isinstance(point.scene, NoScene):
            return None
        if point.program.sha256 is None:
            command = (str(point.program.path), point.verb)
            return self._fail(task, Completed(command, NOT_FOUND, "", point.program.remedy))
        try:
            scene = self.scene(point.scene)
            checked = self.scene(representative(task.experiment, point).scene)
        except InputError as error:
            return self._fail(task, Completed((str(self._generator.path), "generate"), 1, "", str(error)))
        if point.is_checked:
            verdict = self._verifier.check(representative(task.experiment, point), checked)
            if verdict.exit_code != 0:
                return self._fail(task, verdict)
        failed = measure_limits(self._store, point, self._time_limit)
        return self._fail(task, failed) if failed is not None else scene

    def scene(self, scene: AnyScene) -> SceneFile:
        """The scene's file, generated if need be."""
        return self._scenes.get(scene, lambda wanted, path: generate(self._generator, wanted, path))

    def _measure_processes(self, ready: Sequence[Ready]) -> list[ProcessResult]:
        """Whole processes that are compared, side by side in slices of time."""
        first = ready[0][0]
        is_crowded = not have_room(first.experiment, first.point)
        asked = [
            Asked(
                task.point,
                scene,
                task.tags(self._store.session),
                scope_of(representative(task.experiment, task.point)),
                turns=task.experiment.question.turns,
                crowded=is_crowded and is_alike(task.point),
            )
            for task, scene in ready
        ]
        left = self._processes.measure(
            asked, seed_of(first), self.slice_seconds or slice_of(first.point, first.block)
        )
        return [
            self._keep_process(task, scene, there) for (task, scene), there in zip(ready, left, strict=True)
        ]

    def _keep_process(self, task: Task, scene: SceneFile | None, left: Left) -> ProcessResult:
        """Take in the record of a process; of one that wrote a trajectory only if that is right."""
        command, path = task.point.command, self._store.temporary / "record.json"
        is_measured = left.record["kind"] == PROCESS
        if is_measured and command is not None and command.writes_trajectory and scene is not None:
            wrong = self._verifier.check_own_output(task.point, scene, left.output)
            left.output.unlink(missing_ok=True)
            if wrong is not None:
                return self._fail(task, wrong)
        write_json(path, left.record, self._store.temporary)
        return self._keep(task, path, Completed((str(self._generator.path), "processes"), 0, "", ""))

    def _measure_in_turns(self, ready: Sequence[Ready]) -> list[ProcessResult] | None:
        """All of them in one process; None if it broke off: each must show alone what is wrong with it.

        Nothing is wrong with those that stood still: they have failed, and are measured together again by the
        next run. Alone they would be no pairs.
        """
        folder = self._store.temporary / "turns"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        commands = [
            task.point.bench_words(_path(scene), folder / f"{number}.json", task.tags(self._store.session))
            for number, (task, scene) in enumerate(ready)
        ]
        first = ready[0][0]
        contenders = folder / "contenders.json"
        contenders.write_text(json.dumps([words[2:] for words in commands]), encoding="utf-8")
        is_count = first.point.kind == COUNTS
        options = ("--counts",) if is_count else ("--seed", str(seed_of(first)), "--runs", str(first.runs))
        command = (commands[0][0], "turns", str(contenders), *options)
        done = run_alone(command, first.point.openmp, self._time_limit * len(ready) * first.runs)
        if done.exit_code not in (0, CHECK_FAILED):
            is_suspended = done.exit_code > 0 and SUSPENDED in done.reason
            return [self._fail(task, done) for task, _ in ready] if is_suspended else None
        return [
            self._keep(task, folder / f"{number}.json", Completed(words, done.exit_code, "", done.error))
            for number, ((task, _), words) in enumerate(zip(ready, commands, strict=True))
        ]

    def _measure(self, task: Task, scene: SceneFile | None) -> ProcessResult:
        point = task.point
        scratch = self._store.temporary / "record.json"
        scratch.unlink(missing_ok=True)
        tags = task.tags(self._store.session)
        drawn = is_drawn(point, task.block)
        timeline = self._store.temporary / "timeline.json" if drawn else None
        command = point.bench_words(_path(scene), scratch, tags, timeline, point.besides(task.block))
        done = run_alone(command, point.openmp, self._time_limit)
        result = self._keep(task, scratch, done)
        if result.seconds is not None and timeline is not None and timeline.exists():
            move(timeline, self._store.root / "timelines" / point.timeline)
        return result

    def _keep(self, task: Task, scratch: Path, done: Completed) -> ProcessResult:
        """Take in the record that a process left of a point, or the reason why there is none."""
        record = read_json(scratch)
        if is_record(record) and record["kind"] == "failure":
            return self._fail(
                task, Completed(tuple(record["command"]), record["exit_code"], "", record["reason"])
            )
        if done.exit_code not in (0, CHECK_FAILED) and task.point.verb != PROCESS:
            return self._fail(task, done)
        summary = summary_of(record)
        wrong = unusable(summary, task.point, task.block)
        if wrong is None:
            assert summary is not None
            self._store.keep_record(task.point, task.block, scratch)
            task.point.program.require_nothing_made()
            return ProcessResult(summary.seconds, runs=summary.runs)
        violation = _violation(record)
        if done.exit_code == CHECK_FAILED and (violation or record is None):
            return self._fail(task, Completed(done.command, CHECK_FAILED, "", violation or done.reason))
        said = "left no record" if record is None else f"left a record that cannot be used: {wrong}"
        return self._fail(task, Completed(done.command, 1, "", said))

    def _fail(self, task: Task, done: Completed) -> ProcessResult:
        _require_unchanged(task.point)
        self._store.keep_failure(task.point, task.block, done, task.tags(self._store.session))
        return ProcessResult(None, done.reason, done.exit_code)


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


def _violation(record: object) -> str | None:
    """The first violation that a record of a failed check names."""
    check = record.get("check") if isinstance(record, dict) else None
    return check.get("reason") if isinstance(check, dict) else None
