"""What of a study on a cluster is measured, running, waiting, failed or missing, why, and until when."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from pathlib import Path
from statistics import fmean

from experiments.run.progress import about, warn
from experiments.run.status import new_console, new_table
from experiments.run.study import Settings
from experiments.slurm import scheduler
from experiments.slurm.jobs import Standing, folders, submitted
from experiments.slurm.scheduler import Queue, TaskState
from support.errors import InputError

_STATES = ("done", "running", "waiting", "failed", "missing")
_WIDTH = 24
"""Of a bar."""

Expected = tuple[TaskState, float | None]
"""A task and the seconds that its blocks will take, if that can be known."""


@dataclass(frozen=True)
class Row:
    """One experiment on one partition: its processes by state, and the reasons of its failures."""

    experiment: str
    counts: Counter[str]
    reasons: Counter[str]


def show_cluster_status(settings: Settings) -> int:
    """Print the state of what has been submitted; nothing is written. Returns the exit code, 0.

    What is done and what failed is told by the files. Slurm tells what runs and waits, and as what a task
    ended; without its answer both count as missing.
    """
    chosen = submitted(settings) or settings
    if settings.study:
        chosen = replace(chosen, study=settings.study)
    answer = _queue()
    screen, shown = new_console(), new_table("partition", "experiment", *_STATES)
    bars, explained = [], []
    for folder in folders(chosen):
        one = Standing(folder, folder.study(to_be_built=True), answer or {})
        state = rows(one)
        for row in state:
            shown.add_row(one.name, row.experiment, *(str(row.counts[name]) for name in _STATES))
        counts = sum((row.counts for row in state), Counter[str]())
        tasks = _expected(one) if answer is not None else None
        at_once = len({job.name for job, *_ in one.tasks}) * folder.partition.at_once
        bars.append(progress_line(one.name, counts, tasks, at_once, datetime.now().astimezone()))
        explained += [
            f"{one.name}: {row.experiment}: {number} failed: {reason}"
            for row in state
            for reason, number in row.reasons.items()
        ]
        explained += [*_explain(one, answer or {}), *one.said_of_too_long()]
    screen.print(shown)
    for line in (*bars, *explained):
        screen.print(line)
    return 0


def _queue() -> Queue | None:
    """The queue, or None with a line where Slurm does not answer."""
    try:
        return scheduler.queue()
    except InputError as error:
        warn(f"{error}; what runs and what waits is shown as missing")
        return None


def rows(one: Standing) -> list[Row]:
    """The state of each experiment on one partition."""
    result = {
        each.name: Row(each.name, Counter(done=len(each.points) * each.question.blocks.minimum), Counter())
        for each in one.study.experiments
    }
    for (name, block), points in one.missing.items():
        result[name].counts["done"] -= len(points)
        for point in points:
            state = one.active.get((name, block))
            reason = one.found[name].failures.get((point.id, block))
            if state is None and reason is not None:
                state = "failed"
                result[name].reasons[reason] += 1
            result[name].counts[state or "missing"] += 1
    return list(result.values())


def _explain(one: Standing, queue: Queue) -> list[str]:
    """Why tasks wait, and what became of those that left blocks unfinished."""
    unfinished = set(one.missing)
    told: Counter[tuple[str, str]] = Counter()
    # Of the jobs that a block was part of, the last one tells what became of it.
    for job in reversed(one.jobs):
        number = job.name.rpartition("-")[2]
        for index, task in enumerate(job.tasks):
            own = unfinished.intersection(task)
            unfinished -= own
            state = queue.get((job.name, index))
            if own and not (state is not None and state.runs):
                told[number, _fate(state, one.folder.jobs / f"{number}-{index}.log")] += 1
    return [
        f"{one.name}: job {number}: {count} of the tasks {became}" for (number, became), count in told.items()
    ]


def _fate(state: TaskState | None, log: Path) -> str:
    """What became of a task that left blocks unfinished; `state` is None if Slurm has forgotten it."""
    if state is not None and state.waits:
        return f"wait: {state.reason}"
    if not log.exists():
        return "never started, and have left the queue (cancelled?)"
    ended = f"ended as {state.state}" if state is not None else "have ended"
    return f"{ended} and left processes unfinished; their logs are in {log.parent}"


def _expected(one: Standing) -> list[Expected]:
    """The tasks of a partition; a block of an unknown experiment takes as long as others on average."""
    known = one.block_seconds
    usual = fmean(known.values()) if known else None
    return [
        (state, sum(known.get(unit[0], usual) for unit in task if unit in one.missing) if usual else None)
        for _, task, state in one.tasks
    ]


def progress_line(
    name: str, counts: Counter[str], tasks: Sequence[Expected] | None, at_once: int, now: datetime
) -> str:
    """The line of one partition, whose processes have these states. `tasks` is None where Slurm does not tell
    them; so many may run `at_once`, and `now` is the local time.
    """
    all_of_them, done = counts.total(), counts["done"]
    filled = int(_WIDTH * done / all_of_them) if all_of_them else _WIDTH
    parts = [f"{name}: [{'#' * filled}{'-' * (_WIDTH - filled)}] {done} of {all_of_them} processes"]
    if tasks is None:
        parts.append("what runs and waits is not known")
    elif tasks:
        running = sum(state.runs for state, _ in tasks)
        run = "task runs" if running == 1 else "tasks run"
        left = [seconds for _, seconds in tasks if seconds is not None]
        parts += [f"{running} {run}, {len(tasks) - running} wait", _end(left, min(at_once, len(tasks)), now)]
        if suspended := sum(state.is_suspended for state, _ in tasks):
            parts.append(f"{suspended} suspended: what the pause cut through is measured again")
    elif done < all_of_them:
        parts.append("no task runs or waits: `carom study resume` submits what is missing")
    return "; ".join(parts)


def _end(left: Sequence[float], together: int, now: datetime) -> str:
    """When tasks that take so many seconds will be done, no sooner than the longest of them."""
    if not left:
        return "when they will be done is not known: nothing is measured yet"
    seconds = max(*left, sum(left) / together)
    end = now + timedelta(seconds=seconds)
    at = f"{end:%H:%M}" if end.date() == now.date() else f"{end:%Y-%m-%d %H:%M}"
    return f"{about(seconds)} left if {together} run at a time, done at {at}"
