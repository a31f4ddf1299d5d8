"""One task of a job array: measures the blocks that are its own, within its allocation."""

import time
from collections.abc import Sequence
from pathlib import Path

from experiments.plan.cluster import Partition
from experiments.plan.plan import Experiment
from experiments.plan.point import Point
from experiments.plan.site import Machine, this_machine, what_limits
from experiments.run.costs import Costs
from experiments.run.missing import missing
from experiments.run.progress import ProgressDisplay, several
from experiments.run.runner import ProcessResult
from experiments.run.study import POINTS_FAILED, Study
from experiments.run.task import Task
from experiments.run.together import together
from experiments.slurm.jobs import folders, read_job
from experiments.support.process import Completed
from support.errors import InputError


def work(manifest: Path, index: int) -> int:
    """Measure what is missing of one task. Returns the exit code: 0, or 2 where a point failed.

    Others may work in the same folder, even at the same points: a copy of this task that Slurm started
    because it had lost sight of this one. So everything half-made is in a folder of this process's own, a
    record comes to its place whole, by a rename, and the last one stays. A block that another session has
    begun is measured anew: what is compared is measured by one.
    """
    job = read_job(manifest)
    if not 0 <= index < len(job.tasks):
        raise InputError(f"{manifest}: task {index}: expected a number from 0 to {len(job.tasks) - 1}")
    partitions = {one.partition.name: one for one in folders(job.settings)}
    if job.partition not in partitions:
        raise InputError(f'{job.settings.site}: has no partition "{job.partition}" any more')
    folder = partitions[job.partition]
    study = folder.study()
    experiments = {one.name: one for one in study.experiments}
    with study.store.shared(), ProgressDisplay() as display:
        worker = _Worker(study, display, folder.partition, this_machine())
        for name, block in job.tasks[index]:
            if name in experiments:
                worker.measure(experiments[name], block)
        return POINTS_FAILED if worker.failed else 0


class _Worker:
    """What one task knows while it runs: the study, its partition, and the machine that it found."""

    def __init__(
        self, study: Study, display: ProgressDisplay, partition: Partition, machine: Machine
    ) -> None:
        self._study = study
        self._display = display
        # Scenes of its own, since a task with another program would empty a common folder.
        scenes = study.store.temporary / "scenes"
        self._runner = study.runner(scenes, refuse=lambda point: refusal(point, partition, machine))
        self.failed: set[tuple[str, str]] = set()
        # What this task has seen itself: others may measure elsewhere.
        self._costs = Costs()

    def measure(self, experiment: Experiment, block: int) -> None:
        """Measure what is missing of a block."""
        store = self._study.store
        found = store.find(experiment, block)
        lacking = missing(experiment, found, block, store.session)
        hopeful = [one for one in lacking if (experiment.name, one[1].id) not in self.failed]
        store.clear(found, [(point.id, block) for _, point in lacking])
        blocks, size = experiment.question.blocks.minimum, len(experiment.points)
        for group in together(experiment, block, hopeful):
            runs = self._costs.runs([point for _, point in group])
            self._measure([Task(experiment, point, block, at, blocks, size, runs) for at, point in group])

    def _measure(self, tasks: Sequence[Task]) -> None:
        began = time.monotonic()
        ended = self._runner.run(tasks)
        self._costs.learn([one.point for one in tasks], ended, time.monotonic() - began)
        for task, result in zip(tasks, ended, strict=True):
            self._tell(task, result)

    def _tell(self, task: Task, result: ProcessResult) -> None:
        point = task.point
        where = f"{point.experiment}, block {task.block + 1}, {point.series}, {point.x_name} {point.x:g}"
        if result.seconds is None:
            self.failed.add((point.experiment, point.id))
            self._display.line(f"{where}: failed: {result.reason}")
        else:
            self._display.line(f"{where}: measured in {result.seconds:.3g} s")


def refusal(point: Point, said: Partition, found: Machine) -> Completed | None:
    """Why a point is not measured on a node of which the site's file `said` one thing and a task `found`
    another: its threads would share what each was planned to have alone. None if it is. An affinity mask, a
    control group, or a node without hyperthreads may leave less than is said. A sweep may want more threads
    than the node is said to have; then all of those are to be there.
    """
    threads = point.threads
    short_of_threads = found.hardware_threads < min(threads, said.hardware_threads)
    short_of_cores = found.cores < threads <= said.cpus
    if said.oversubscribed or not (short_of_threads or short_of_cores):
        return None
    command = (str(point.program.path), point.verb) if point.command is None else point.command.words
    limits = what_limits()
    reason = (
        f"{several(threads, 'thread')} on {several(found.cores, 'core')} with "
        f"{several(found.hardware_threads, 'hardware thread')}, all that the task may use"
        f"{f' ({limits})' if limits else ''}; the site file says cpus = {said.cpus} and "
        f"hardware_threads = {said.hardware_threads}: correct it, or say oversubscribed = true"
    )
    return Completed(command, 1, "", reason)
