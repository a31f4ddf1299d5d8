"""What of the study is done, missing or failed, as a table for a terminal."""

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from experiments.plan.plan import Experiment
from experiments.plan.site import what_limits
from experiments.results.store import Store
from experiments.run.costs import Costs
from experiments.run.schedule import Part
from experiments.run.study import Settings, Study, summary


class Row:
    """One experiment: its processes, its stale files, the reason of its first failure.

    Every process of a point that failed counts as failed until it is measured: a run does not try it further.
    """

    def __init__(self, experiment: Experiment, store: Store) -> None:
        found = store.find(experiment)
        part = Part(experiment, store, found, Costs())
        failed_points = {point for point, _ in found.failures}
        part.give_up(failed_points)
        self.name = experiment.name
        self.points = len(experiment.points)
        self.blocks, self.is_decided = part.blocks, bool(found.seconds) and part.is_complete
        self.planned = part.planned
        self.missing = len(part.left)
        self.failed = sum(
            (point, block) not in found.seconds for point in failed_points for block in range(part.blocks)
        )
        self.done = self.planned - self.failed - self.missing
        self.stale = sum(found.stale.values())
        self.seconds = sum(found.seconds.values())
        self.in_the_clock = sum(sum(runs) for runs in found.runs.values())
        """Of the seconds of its processes those of timed runs."""
        self.reason = next(iter(found.failures.values()), "")


def rows(store: Store, experiments: Sequence[Experiment]) -> list[Row]:
    """The state of each experiment, read from the files alone."""
    return [Row(experiment, store) for experiment in experiments]


def show_status(settings: Settings) -> int:
    """Print the state of the study; nothing is written, and a run may be under way."""
    study = Study(settings)
    table = new_table(
        "experiment", "points", "blocks", "done", "failed", "missing", "stale", "seconds", "in the clock"
    )
    state = rows(study.store, study.experiments)
    for row in state:
        blocks = str(row.blocks) if row.is_decided else f"{row.blocks} or more"
        table.add_row(row.name, str(row.points), blocks, *_in_columns([row]))
    table.add_row("all", str(sum(row.points for row in state)), "", *_in_columns(state))
    console = new_console()
    console.print(table)
    for row in state:
        if row.failed:
            console.print(f"{row.name}: failed: {row.reason}")
    return 0


def _in_columns(state: Sequence[Row]) -> list[str]:
    """What some experiments have together, from `done` on."""
    names = ("done", "failed", "missing", "stale", "seconds", "in_the_clock")
    *counts, spent, timed = (sum(getattr(row, name) for row in state) for name in names)
    return [*map(str, counts), f"{spent:.1f}", f"{100 * timed / spent:.0f} %" if spent else "-"]


def show_plan(settings: Settings) -> int:
    """Print what a run would do and about how long it would take; nothing is run."""
    study = Study(settings)
    schedule = study.schedule(settle=False)
    table = new_table("experiment", "points", "blocks", "to be run", "figure", "claim", "title")
    for experiment in study.experiments:
        part, question = schedule.parts[experiment.name], experiment.question
        counts = (len(experiment.points), part.blocks, len(part.left))
        told = (question.figure, question.claim or "-", question.title)
        table.add_row(experiment.name, *map(str, counts), *told)
    console = new_console()
    console.print(table)
    for line in (summary(schedule, study.budget_seconds), what_limits()):
        if line:
            console.print(line)
    return 0


def new_console() -> Console:
    """Where tables are printed. Lines are never cut: a terminal wraps them, a file keeps them whole."""
    console = Console(highlight=False, markup=False, soft_wrap=True)
    if not console.is_terminal:
        console.width = 200
    return console


def new_table(*columns: str) -> Table:
    """A table of these columns; numbers stand to the right."""
    table = Table(box=None, pad_edge=False)
    for column in columns:
        numeric = column not in ("partition", "experiment", "figure", "claim", "title")
        table.add_column(column, justify="right" if numeric else "left", no_wrap=True)
    return table
