"""The whole study on this machine: plan, measure, draw; and go on where an earlier run stopped."""

import math
import sys
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from experiments.plan import question, site
from experiments.plan.plan import SEED, Experiment, Surroundings, plan
from experiments.plan.point import Point
from experiments.plan.program import GENERATOR, Program, find_programs
from experiments.plan.question import load_questions, with_blocks
from experiments.plan.scale import find_scale
from experiments.plan.scenes import SceneFolder
from experiments.plan.site import Machine
from experiments.results.store import Store, new_session, seconds_by_point
from experiments.run.costs import PROBE, Costs, Probe, kept_probes, probe, probe_key, to_probe
from experiments.run.progress import Report, about, warn
from experiments.run.runner import Outcome, Runner, Task
from experiments.run.schedule import Schedule, split
from experiments.run.together import together
from experiments.support.errors import InputError
from experiments.support.process import NOT_FOUND, Coprocess

COSTS = "costs.json"
POINTS_FAILED = 2

REPORT_SECONDS = 40.0
"""What the report takes, which comes after the study and out of the same budget."""

FIGURE_SECONDS = 2.0
"""What drawing one experiment's figure takes, until one has been drawn."""

DRAWING_PAUSE = 10.0
"""Seconds between two drawings: what is complete sooner is drawn together, which takes less time."""

DRAWING_LIMIT = 600.0
"""Seconds after which a drawing is given up."""


@dataclass(frozen=True)
class Settings:
    """What the command line says."""

    study: tuple[str, ...] = ()
    scale: str = "paper"
    site: str = "local"
    results: Path = Path("results")
    build: Path = Path("build")
    builds: tuple[str, ...] = ()
    questions: Path = question.FOLDER
    blocks: int | None = None
    budget_seconds: float | None = None
    seed: int = SEED
    figures: bool = True


class Study:
    """The questions chosen, planned for a machine, and the folder that holds their results."""

    def __init__(self, settings: Settings, machine: Machine | None = None) -> None:
        """Plan for this machine, or for another one that is named."""
        self.settings = settings
        self.site = site.load_site(settings.site)
        self.scale = find_scale(settings.scale)
        self.budget_seconds = settings.budget_seconds or self.scale.budget_seconds
        if self.site.cluster is not None and machine is None:
            raise InputError(f"site {self.site.name}: is a cluster; use `make submit SITE={settings.site}`")
        programs = find_programs(self.site, settings.build)
        self.generator: Program = programs[GENERATOR]
        if self.generator.sha256 is None:
            raise InputError(self.generator.remedy)
        around = Surroundings(self.site, machine or site.this_machine(), programs, self.scale, settings.seed)
        all_questions = load_questions(settings.questions, settings.study)
        questions = [
            one for one in all_questions if not settings.builds or one.programs <= {*settings.builds}
        ]
        report_seconds = REPORT_SECONDS if settings.figures else 0.0
        self.is_whole = len(questions) == len(all_questions)
        self.measuring_seconds = (self.budget_seconds - report_seconds) * len(questions) / len(all_questions)
        self.experiments: tuple[Experiment, ...] = tuple(
            plan(with_blocks(self.scale.question(one), settings.blocks), around) for one in questions
        )
        self.store = Store(settings.results, new_session())

    def drawing_command(self) -> list[str]:
        """What draws the figures of the experiments that it is told, some a line."""
        return [sys.executable, "-m", "analysis", "figures", "--results", str(self.store.root), "--follow"]

    def scenes(self) -> SceneFolder:
        """The generated scenes; the results folder must be held."""
        return SceneFolder(self.store.root / "scenes", self.store.temporary, str(self.generator.sha256))

    def runner(self) -> Runner:
        """What runs one task; the results folder must be held."""
        return Runner(self.store, self.scenes(), self.generator, self.site.time_limit_seconds)

    def schedule(self, runner: Runner, *, settle: bool) -> Schedule:
        """What is there and what is to be run; `settle` moves stale records out of the way first."""
        look = self.store.settle if settle else self.store.find
        found = {experiment.name: look(experiment) for experiment in self.experiments}
        costs = Costs(self._probes(runner), seconds_by_point(found.values()))
        figure_seconds = FIGURE_SECONDS if self.settings.figures else 0.0
        more = self.settings.budget_seconds is not None
        schedule = Schedule(self.store, self.experiments, found, costs, figure_seconds, more=more)
        schedule.decide(self.measuring_seconds - schedule.status().seconds_done)
        return schedule

    def _probes(self, runner: Runner) -> dict[str, Probe]:
        probes = kept_probes(self.store.note(COSTS))
        points = [point for experiment in self.experiments for point in experiment.points]
        wanted = to_probe(points, probes)
        for point in wanted:
            record = self.store.temporary / "probe.json"
            record.unlink(missing_ok=True)
            timed = probe(point, runner.scene(PROBE).path, record, self.site.time_limit_seconds)
            if timed is not None:
                probes[probe_key(point)] = timed
        if wanted:
            content = {key: {"step": one.step, "process": one.process} for key, one in probes.items()}
            self.store.keep_note(COSTS, content)
        return probes


def run(settings: Settings) -> int:
    """Run what is missing of the study. Returns the exit code: 0, or 2 where a point failed."""
    study = Study(settings)
    with study.store.opened(), Report() as report:
        report.now("planning")
        runner = study.runner()
        schedule = study.schedule(runner, settle=True)
        report.line(summary(schedule, study.budget_seconds))
        with Coprocess(study.drawing_command()) as painter:
            return _Session(study, runner, schedule, report, painter).run()


def summary(schedule: Schedule, budget_seconds: float) -> str:
    """What is about to be run, in one line."""
    status = schedule.status()
    points = sum(len(experiment.points) for experiment in schedule.experiments)
    text = f"{len(schedule.experiments)} experiments, {points} points, {status.planned} processes; "
    if status.done == status.planned:
        return text + "all of them are done"
    text += f"{status.planned - status.done} of them to be run: {about(status.seconds_left)}"
    if status.seconds_left > budget_seconds:
        text += (
            f", although the budget is {about(budget_seconds)}: the least number of blocks takes that long"
            " (less: --study picks questions, --scale quick is the small study)"
        )
    return text


class _Session:
    """One invocation: a first block of every experiment, then one after the other, the control in between."""

    def __init__(
        self, study: Study, runner: Runner, schedule: Schedule, report: Report, painter: Coprocess
    ) -> None:
        self._study = study
        self._runner = runner
        self._schedule = schedule
        self._report = report
        self._painter = painter
        self._failures: Counter[str] = Counter()
        self._to_draw: list[str] = []
        self._drawn_at = -math.inf
        self._others, self._control = split(study.experiments)
        self._until = time.monotonic() + study.measuring_seconds - schedule.status().seconds_done

    def run(self) -> int:
        """Run what is missing. First blocks come first: they tell what each block costs here, by which the
        rest of the time is then shared out.
        """
        incomplete = [one for one in self._others if not self._schedule.is_complete(one)]
        for experiment in incomplete:
            self._run_control(everything=False)
            self._block(experiment, 0)
            self._decide()
            if experiment.question.blocks.wanted == 1:
                self._rest(experiment)
        for experiment in incomplete:
            if experiment.question.blocks.wanted > 1:
                self._rest(experiment)
        self._run_control(everything=True)
        self._draw()
        return self._conclude()

    def _decide(self) -> None:
        self._schedule.decide(self._until - time.monotonic())

    def _rest(self, experiment: Experiment) -> None:
        self._decide()
        for block in range(self._schedule.begin(experiment)):
            self._run_control(everything=False)
            self._block(experiment, block)
        self._complete(experiment)

    def _run_control(self, *, everything: bool) -> None:
        """The same thing under two labels, measured all along the study, must come out equal."""
        control = self._control
        if control is None or self._schedule.is_complete(control):
            return
        blocks = self._schedule.begin(control)
        for block in range(blocks if everything else self._schedule.control_due(control)):
            self._block(control, block)
        if self._schedule.is_complete(control):
            self._complete(control)

    def _block(self, experiment: Experiment, block: int) -> None:
        missing = self._schedule.missing(experiment, block)
        blocks = self._schedule.promised(experiment)
        what = f"{experiment.name}, block {block + 1} of {blocks}"
        for group in together(experiment, block, missing):
            self._report.now(what, self._schedule.status)
            tasks = [Task(experiment, point, block, position, blocks) for position, point in group]
            for (_, point), outcome in zip(group, self._runner.run(tasks), strict=True):
                self._schedule.finish(experiment, point, block, outcome.seconds)
                if outcome.seconds is None:
                    self._tell(point, outcome)
        if missing:
            self._report.block(what, self._schedule.status)

    def _tell(self, point: Point, failed: Outcome) -> None:
        where = f"{point.experiment}, {point.series}, {point.x_name} {point.x:g}"
        self._report.line(f"{where}: failed: {failed.reason}")
        # A build that is not there is a gap with a remedy, not a wrong result.
        if failed.exit_code != NOT_FOUND:
            self._failures[point.experiment] += 1

    def _complete(self, experiment: Experiment) -> None:
        self._to_draw.append(experiment.name)
        if time.monotonic() - self._drawn_at > DRAWING_PAUSE:
            self._draw()

    def _draw(self) -> None:
        """Draw what was completed since the last time: together, on all processors; what fails, alone."""
        names, self._to_draw = self._to_draw, []
        if not names or not self._study.settings.figures:
            return
        self._report.now(f"{', '.join(names)}: drawing")
        began = time.monotonic()
        together = self._painter.ask(",".join(names), DRAWING_LIMIT)
        for name in names:
            done = together
            if together.exit_code != 0 and len(names) > 1:
                done = self._painter.ask(name, DRAWING_LIMIT)
            if done.exit_code == 0:
                self._report.line(f"{name}: complete, drawn into {self._study.store.root / 'figures'}")
            else:
                warn(f"{name}: complete, but its figure could not be drawn: {done.reason}")
        self._drawn_at = time.monotonic()
        self._schedule.figure_seconds = (self._drawn_at - began) / len(names)

    def _conclude(self) -> int:
        root = self._study.store.root
        if not self._failures:
            if self._study.is_whole:
                self._report.line(f"the study is complete: {root / 'records'}")
            return 0
        points = ", ".join(f"{name} ({number})" for name, number in self._failures.items())
        warn(f"points failed: {points}; the reasons are in {root / 'failures'} and in the report")
        return POINTS_FAILED
