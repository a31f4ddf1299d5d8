"""One task of a job array: measures the blocks that are its own, within its allocation."""

import time
from collections.abc import Sequence
from pathlib import Path

from experiments.plan.plan import Experiment
from experiments.plan.scenes import SceneFolder
from experiments.plan.site import this_machine
from experiments.run.costs import Costs
from experiments.run.progress import ProgressDisplay
from experiments.run.repeats import process_runs
from experiments.run.runner import ProcessResult, Runner, Task
from experiments.run.study import POINTS_FAILED, Study
from experiments.run.together import together
from experiments.run.whole_blocks import WholeBlocks
from experiments.slurm.jobs import PartitionFolder, Unit, folders, read_job
from experiments.slurm.processors import Processors
from experiments.slurm.task_log import TaskLog
from support.errors import InputError


def work(manifest: Path, index: int) -> int:
    """Measure what is missing of one task. Returns the exit code: 0, or 2 where a point failed.

    Others may work in the same folder, even at the same points: a copy of this task that Slurm started
    because it had lost sight of this one. So everything half-made is in a folder of this process's own, a
    record comes to its place whole, by a rename, and the last one stays. A block that another session has
    begun is left as it is: what is compared is measured by one.
    """
    job = read_job(manifest)
    if not 0 <= index < len(job.tasks):
        raise InputError(f"{manifest}: task {index}: expected a number from 0 to {len(job.tasks) - 1}")
    partitions: dict[str, PartitionFolder] = {one.partition.name: one for one in folders(job.settings)}
    if job.partition not in partitions:
        raise InputError(f'{job.settings.site}: has no partition "{job.partition}" any more')
    folder = partitions[job.partition]
    study, log, machine = folder.study(), TaskLog(manifest, index), this_machine()
    log.begins(machine.name)
    with study.store.shared(), ProgressDisplay() as display:
        worker = _Worker(study, display, log, Processors(folder.partition, machine))
        return worker.run(job.tasks[index])


class _Worker:
    """What one task knows while it runs."""

    def __init__(self, study: Study, display: ProgressDisplay, log: TaskLog, processors: Processors) -> None:
        self._study = study
        self._display = display
        self._log = log
        self._processors = processors
        store = study.store
        # Scenes of its own, since a task with another program would empty a common folder.
        scenes = SceneFolder(store.temporary / "scenes", store.temporary, str(study.generator.sha256))
        self._runner = Runner(store, scenes, study.generator, study.site.time_limit_seconds)
        self._failed: set[tuple[str, str]] = set()
        # What this task has seen itself: others may measure elsewhere.
        self._costs = Costs({}, {})

    def run(self, own: Sequence[Unit]) -> int:
        experiments = {one.name: one for one in self._study.experiments}
        for name, block in own:
            if name in experiments:
                began, failed = time.monotonic(), len(self._failed)
                if self._block(experiments[name], block) and len(self._failed) == failed:
                    self._log.measured((name, block), time.monotonic() - began)
        return POINTS_FAILED if self._failed else 0

    def _block(self, experiment: Experiment, block: int) -> bool:
        """Measure what is missing of a block; says whether that was all of it."""
        found = self._study.store.find_block(experiment, block)
        given, session = experiment.question.blocks.minimum, self._study.store.session
        missing = WholeBlocks(experiment, given, found, session).missing_if_given(block)
        hopeful = [one for one in missing if (experiment.name, one[1].id) not in self._failed]
        blocks, size = experiment.question.blocks.minimum, len(experiment.points)
        for group in together(experiment, block, hopeful):
            runs = process_runs([point for _, point in group], self._costs)
            tasks = [Task(experiment, point, block, at, blocks, size, runs) for at, point in group]
            self._measure([one for one in tasks if not self._study.store.has(one.point, block)])
        return len(hopeful) == size

    def _measure(self, asked: Sequence[Task]) -> None:
        tasks = [one for one in asked if not self._refuse(one)]
        if not tasks:
            return
        began = time.monotonic()
        ended = self._runner.run(tasks)
        self._costs.learn_group([one.point for one in tasks], ended, time.monotonic() - began)
        for task, result in zip(tasks, ended, strict=True):
            self._tell(task, result)

    def _refuse(self, task: Task) -> bool:
        """Whether the point's threads cannot have the processors that they were planned for; says so then."""
        refused = self._processors.refusal(task.point)
        if refused is None:
            return False
        self._study.store.keep_failure(task.point, task.block, refused, task.tags(self._study.store.session))
        self._tell(task, ProcessResult(None, refused.reason, refused.exit_code))
        return True

    def _tell(self, task: Task, result: ProcessResult) -> None:
        point = task.point
        where = f"{point.experiment}, block {task.block + 1}, {point.series}, {point.x_name} {point.x:g}"
        if result.seconds is None:
            self._failed.add((point.experiment, point.id))
            self._display.line(f"{where}: failed: {result.reason}")
        else:
            self._display.line(f"{where}: measured in {result.seconds:.3g} s")
