"""One process of one point, from its scene to its record or to the reason why there is none."""

import sys
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.plan import Experiment
from experiments.plan.point import Point, Tags
from experiments.plan.program import CHECK_FAILED, Program, generate
from experiments.plan.scenes import AnyScene, SceneFile, SceneFolder, sha256_of
from experiments.results.store import Store, unusable
from experiments.run.host_lock import run_alone
from experiments.run.kept_records import KeptRecords
from experiments.run.limits import measure_limits
from experiments.run.outside import Outside
from experiments.run.verify import Verifier, representative
from experiments.support.errors import InputError
from experiments.support.files import move, read_json
from experiments.support.process import NOT_FOUND, Completed


@dataclass(frozen=True)
class Task:
    """One process: a point in one block of its experiment."""

    experiment: Experiment
    point: Point
    block: int
    position: int
    blocks: int

    def tags(self, session: str) -> Tags:
        """Everything that the record remembers of the plan."""
        return {
            **self.point.tags,
            "title": self.experiment.question.title,
            "block": self.block,
            "position": self.position,
            "session": session,
            "order_seed": self.experiment.order_seed,
            "points_planned": len(self.experiment.points),
            "blocks_planned": self.blocks,
        }


@dataclass(frozen=True)
class Outcome:
    """Seconds of the whole process, or the reason of its failure with the exit code."""

    seconds: float | None
    reason: str = ""
    exit_code: int = 0


class Runner:
    """Runs tasks one at a time; each leaves a record or a failure in the store."""

    def __init__(self, store: Store, scenes: SceneFolder, generator: Program, time_limit: float) -> None:
        self._store = store
        self._scenes = scenes
        self._generator = generator
        self._time_limit = time_limit
        self._verifier = Verifier(store, time_limit)
        self._records = KeptRecords(store, time_limit)
        self._outside = Outside(self._records)

    def run(self, task: Task) -> Outcome:
        """Verify the point's variant if that is still to be done, then measure it.

        Raises InputError only for what concerns the whole study: a program that changed under it.
        """
        point = task.point
        if point.program.sha256 is None:
            command = (str(point.program.path), point.verb)
            return self._fail(task, Completed(command, NOT_FOUND, "", point.program.remedy))
        try:
            scene = self.scene(point.scene)
            checked = self.scene(representative(task.experiment, point).scene)
        except InputError as error:
            return self._fail(task, Completed((str(self._generator.path), "generate"), 1, "", str(error)))
        verdict = self._verifier.check(representative(task.experiment, point), checked)
        if verdict.exit_code != 0:
            return self._fail(task, verdict)
        limits = measure_limits(point, self._records)
        if limits is not None and limits.exit_code != 0:
            return self._fail(task, limits)
        failed = self._outside.measure(point, task.block, scene, task.tags(self._store.session))
        if failed is not None and failed.exit_code != 0:
            print(f"outside engine: not measured: {failed.reason}", file=sys.stderr)
        return self._measure(task, scene)

    def scene(self, scene: AnyScene) -> SceneFile:
        """The scene's file, generated if need be."""
        return self._scenes.get(scene, lambda wanted, path: generate(self._generator, wanted, path))

    def _measure(self, task: Task, scene: SceneFile) -> Outcome:
        point = task.point
        scratch = self._store.temporary / "record.json"
        scratch.unlink(missing_ok=True)
        tags = task.tags(self._store.session)
        timeline = self._store.temporary / "timeline.json" if _is_drawn(task) else None
        command = point.command(scene.path, scratch, tags, timeline, point.besides(task.block))
        done = run_alone(command, point.openmp, self._time_limit)
        record = read_json(scratch)
        if done.exit_code == 0:
            wrong = unusable(record, point, task.block)
            if wrong is None:
                self._store.keep_record(point, task.block, scratch)
                if timeline is not None and timeline.exists():
                    move(timeline, self._store.root / "timelines" / point.timeline)
                return Outcome(float(record["process_seconds"]))
            said = "left no record" if record is None else f"left a record that cannot be used: {wrong}"
            done = Completed(done.command, 1, "", said)
        elif done.exit_code == CHECK_FAILED:
            done = Completed(done.command, CHECK_FAILED, "", _violation(record) or done.reason)
        return self._fail(task, done)

    def _fail(self, task: Task, done: Completed) -> Outcome:
        if task.point.program.sha256 is not None:
            _require_unchanged(task.point.program)
        self._store.keep_failure(task.point, task.block, done, task.tags(self._store.session))
        return Outcome(None, done.reason, done.exit_code)


def _is_drawn(task: Task) -> bool:
    """Whether the process leaves a timeline: one a point of the phases is enough to see who waits."""
    return task.point.verb == "profile" and task.point.figure == "phases" and task.block == 0


def _violation(record: object) -> str | None:
    """The first violation that a record of a failed check names."""
    check = record.get("check") if isinstance(record, dict) else None
    return check.get("reason") if isinstance(check, dict) else None


def _require_unchanged(program: Program) -> None:
    path: Path = program.path
    if sha256_of(path) != program.sha256:
        raise InputError(f"{path}: was built anew while the study ran; run the study again to go on with it")
