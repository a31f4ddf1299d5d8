"""The whole study on this machine: measure, decide, report; and go on where an earlier run stopped."""

import contextlib
import io
import math
import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import TypeVar

from experiments.plan.point import Point
from experiments.plan.site import what_limits
from experiments.run.next_blocks import in_turns, next_blocks
from experiments.run.progress import ProgressDisplay, warn
from experiments.run.runner import ProcessResult, Runner
from experiments.run.schedule import FIRST_LOOK, Part, Schedule, may_decide
from experiments.run.study import POINTS_FAILED, REPORT_FAILED, Settings, Study, keep_claims, summary
from experiments.run.task import Task
from experiments.run.together import together
from experiments.run.verdicts import Analysis, Verdicts
from experiments.support.interrupts import stop_if_asked
from support.errors import InputError, cannot
from support.vocabulary import CONTROL

Answer = TypeVar("Answer")

DECIDING_SHARE = 0.25
"""The part of a scale's time that what is open gets for certain."""

REST_SHARE = 0.05
"""The part of the time that is kept for what decides nothing."""

CONTROL_SHARE = 0.05
"""The part of the time that the control has."""

MEASURED_A_LOOK = 4.0
"""The least time measured between two looks, in those that the look took."""

REPORT_PAUSE, REPORT_SHARE = 600.0, 0.02
"""Least seconds between two reports of what is there, and the most of the time that they may take."""


def run(settings: Settings) -> int:
    """Run what is missing of the study, then write the report. Returns the exit code: 0, 2 where a point
    failed, or 1 where the report could not be written.
    """
    study = Study(settings)
    with study.store.opened(), ProgressDisplay() as display:
        display.now("planning")
        keep_claims(settings.questions, settings.results)
        runner = study.runner()
        schedule = study.schedule(settle=True)
        display.line(summary(schedule, study.budget_seconds))
        if limits := what_limits():
            display.line(limits)
        return Session(study, runner, schedule, display).run()


class Session:
    """One invocation: the first block of every experiment, the control in between; then whatever settles what
    is open; then the least number of blocks of all, and the rest of the time shared out.
    """

    def __init__(self, study: Study, runner: Runner, schedule: Schedule, display: ProgressDisplay) -> None:
        self._began = time.monotonic()
        self._study = study
        self._runner = runner
        self._schedule = schedule
        self._display = display
        self._analysis = Analysis(study.store.root, study.settings.study)
        self._failures: Counter[str] = Counter()
        self._report_due = time.monotonic() + REPORT_PAUSE
        self._said: set[str] = set()
        parts = schedule.parts.values()
        self._control = schedule.parts.get(CONTROL)
        self._others = [one for one in parts if one is not self._control]
        self._incomplete = [one for one in self._others if not one.is_complete]
        self._has_more = bool(self._incomplete) or not study.is_finished
        self._until = self._end()
        self._control_seconds = 0.0

    def _end(self) -> float:
        """When measuring stops. What is finished gets all of a budget that is given for it."""
        study, now = self._study, time.monotonic()
        given = study.settings.budget_seconds is not None
        if study.settings.until_decided and not given:
            return math.inf
        if given and not self._has_more:
            return now + study.measuring_seconds
        return now + study.measuring_seconds - max(self._schedule.status().seconds_done, study.seconds_begun)

    def _keep_time_to_decide(self) -> None:
        """On a slow machine the least of everything takes all of a scale's time, and what is open may need
        seconds. Who names a budget gets no more than that.
        """
        if self._study.settings.budget_seconds is None:
            for_certain = DECIDING_SHARE * self._study.measuring_seconds
            self._until = max(self._until, time.monotonic() + for_certain)

    def run(self) -> int:
        """Run what is missing. What may decide something comes first, and of it first blocks, which tell what
        each block costs here. Before all builds are there nothing is decided: what needs the others is to
        have its part of the time.
        """
        for one in self._schedule.parts.values():
            if one.is_complete:
                one.begin()  # it may have fewer points than when it was completed
        settings = self._study.settings
        looks = (settings.figures or bool(settings.builds)) and settings.blocks is None
        self._keep_time_to_decide()
        if looks:
            self._first_blocks([one for one in self._incomplete if self._may_decide(one)])
        else:
            for one in self._incomplete:
                self._first_block(one)
            self._measure([one for one in self._incomplete if one.asked.wanted > 1])
        if settings.builds:
            self._study.begin(time.monotonic() - self._began)
            return self._failed()
        if self._has_more or settings.until_decided or settings.budget_seconds is not None:
            verdicts = self._decide() if looks else Verdicts()
            while not settings.until_decided and (more := self._next_of_rest(verdicts)) is not None:
                self._measure([more])
        self._run_control(everything=True)
        self._study.finish()
        failed = self._failed()
        return self._report_all() or failed

    def _first_blocks(self, parts: Sequence[Part]) -> None:
        """Measure the first block of each, the cheapest first, as far as there is time for a first look."""
        for one in sorted(parts, key=lambda one: one.status.seconds_left):
            if one.seconds_of(min(FIRST_LOOK, one.asked.wanted)) <= self._time_left():
                self._first_block(one)

    def _first_block(self, part: Part) -> None:
        """Measure the first block, which is all of what wants no more."""
        self._run_control(everything=False)
        while part.next == 0:
            self._block(part, 0)
        if part.asked.wanted == 1:
            self._measure([part])

    def _may_decide(self, part: Part) -> bool:
        return may_decide(part.experiment, self._study.scale.name)

    def _time_left(self) -> float:
        """Seconds until measuring stops."""
        return self._until - time.monotonic()

    def _decide(self) -> Verdicts:
        """Settle what can be settled in most of the time; then measure what decides nothing as far as it
        fits, the cheapest first; then settle more in what is left. Returns what the last look found.
        """
        self._keep_time_to_decide()
        rest = [one for one in self._incomplete if not self._may_decide(one)]
        whole = self._until
        if rest:
            self._until -= REST_SHARE * max(0.0, whole - time.monotonic())
        verdicts = self._settle()
        self._until = whole
        # A block tells at least what a claim is about.
        for one in sorted(rest, key=lambda one: (not one.experiment.question.claim, one.status.seconds_left)):
            if one.status.seconds_left <= self._time_left():
                self._measure([one])
        return self._settle() if rest and verdicts != Verdicts() else verdicts

    def _settle(self) -> Verdicts:
        """Measure what settles something soonest, and look again, as long as there is time; what is settled
        gets no more. Returns what the last look found.
        """
        while True:
            self._display.now("looking at what is decided", self._schedule.status)
            began = time.monotonic()
            unknown = "what is open is not known, so that nothing is measured to settle it"
            verdicts = _told(unknown, self._analysis.verdicts)
            if verdicts is None:
                return Verdicts()
            for name, said in verdicts.said.items():
                if name not in self._said:
                    self._display.line(f"decided: {name} {said}")
            self._said.update(verdicts.said)
            looked = time.monotonic()
            if not self._measure_next(verdicts, least_seconds=MEASURED_A_LOOK * (looked - began)):
                return verdicts

    def _measure_next(self, verdicts: Verdicts, least_seconds: float) -> bool:
        """Bring what is settled at the least expense to its next look. Returns whether there was any."""
        waiting = list(self._schedule.waiting(verdicts))
        blocks = next_blocks(waiting, self._time_left(), least_seconds)
        chosen = [one for one in self._others if one.name in blocks]
        for one in chosen:
            one.give(verdicts.open[one.name].next)
        self._measure(chosen)
        return bool(chosen)

    def _next_of_rest(self, verdicts: Verdicts) -> Part | None:
        """Who gets the rest of the time next, as far as it fits: who lacks blocks that it was given, then who
        is furthest from the blocks that it wants. What is settled gets no more; what is open has no time for
        its next look, and comes last.
        """
        left = self._time_left()
        lacking = (one for one in self._others if not one.is_complete and one.status.seconds_left <= left)
        if (first := next(lacking, None)) is not None:
            return first
        growing = [
            one
            for one in self._others
            if one.name not in verdicts.settled and one.is_complete and one.growth
            if one.growth * one.seconds_each <= left
        ]
        chosen = min(growing, key=lambda one: (one.name in verdicts.open, one.share), default=None)
        if chosen is not None:
            chosen.give(chosen.blocks + chosen.growth)
        return chosen

    def _measure(self, parts: Sequence[Part]) -> None:
        """Run what is missing of these, a block of one and a block of another in turn."""
        for one in parts:
            one.begin()
        of_name = {one.name: one for one in parts}
        for name in in_turns({one.name: len(one.lacking) for one in parts}):
            self._run_control(everything=False)
            if (block := of_name[name].next) is not None:
                self._block(of_name[name], block)
        for one in parts:
            # There are more where something that had failed succeeded.
            while (block := one.next) is not None:
                self._block(one, block)
            one.begin()

    def _run_control(self, *, everything: bool) -> None:
        """The same thing under two labels, measured all along the study, must come out equal: it has its
        share of the time by the clock, or in the end the least of its blocks.
        """
        control = self._control
        if control is None or not (everything or self._is_control_due(control)):
            return
        if control.is_complete:
            if everything or self._study.settings.blocks is not None or not self._has_more:
                return
            control.give(control.blocks + 1)
        control.begin()
        began = time.monotonic()
        while (block := control.next) is not None:
            self._block(control, block)
            if not everything:
                break
        self._control_seconds += time.monotonic() - began

    def _is_control_due(self, control: Part) -> bool:
        taken = self._control_seconds + control.seconds_each
        is_due = taken <= CONTROL_SHARE * (time.monotonic() - self._began)
        return is_due or not control.found.seconds

    def _block(self, part: Part, block: int) -> None:
        stop_if_asked()
        blocks, experiment = part.blocks, part.experiment
        what, size = f"{part.name}, block {block + 1} of {blocks}", len(experiment.points)
        groups = together(experiment, block, part.lacking[block])
        part.clear(block)
        for group in groups:
            self._display.now(what, self._schedule.status)
            runs = self._schedule.costs.runs([point for _, point in group])
            tasks = [Task(experiment, point, block, at, blocks, size, runs) for at, point in group]
            began = time.monotonic()
            ended = self._runner.run(tasks, part.found)
            self._schedule.finish(tasks, ended, time.monotonic() - began)
            for (_, point), result in zip(group, ended, strict=True):
                if result.seconds is None:
                    self._tell(point, result)
        self._display.block(what, self._schedule.status)
        self._report_meanwhile()

    def _tell(self, point: Point, failed: ProcessResult) -> None:
        where = f"{point.experiment}, {point.series}, {point.x_name} {point.x:g}"
        self._display.line(f"{where}: failed: {failed.reason}")
        # A build that is not there is a gap with a remedy, not a wrong result.
        if point.program.sha256 is not None:
            self._failures[point.experiment] += 1

    def _report_meanwhile(self) -> None:
        """Write the report of what is there every few minutes, which says that the study goes on."""
        began = time.monotonic()
        if not self._study.settings.figures or began < self._report_due:
            return
        self._display.now("writing the report of what is there")
        failed, how_far = "the report of what is there could not be written", str(self._schedule.status())
        page = _told(failed, lambda: self._analysis.report(how_far))
        now = time.monotonic()
        self._report_due = now + max(REPORT_PAUSE, (now - began) / REPORT_SHARE)
        if page is not None:
            self._display.line(f"report of what is there: {page}")

    def _report_all(self) -> int:
        """Write the report with all its figures. Returns the exit code."""
        if not self._study.settings.figures:
            return 0
        self._display.now("writing the report")
        page = _told("the report could not be written", self._analysis.report)
        if page is None:
            return REPORT_FAILED
        self._display.line(str(page))
        return 0

    def _failed(self) -> int:
        """Tell what became of the study; returns the exit code that its points make."""
        root = self._study.store.root
        if not self._failures:
            if self._study.is_whole and not self._study.settings.builds:
                self._display.line(f"the study is complete: {root / 'records'}")
            return 0
        points = ", ".join(f"{name} ({number})" for name, number in self._failures.items())
        warn(f"points failed: {points}; the reasons are in {root / 'records'} and in the report")
        return POINTS_FAILED


def _told(failed: str, ask: Callable[[], Answer]) -> Answer | None:
    """What the analysis answers, and the lines that it says besides; None, and why, where it does not."""
    answer, said = None, io.StringIO()
    with contextlib.redirect_stderr(said):
        try:
            answer = ask()
        except (InputError, OSError) as error:
            print(f"{failed}: {cannot(error) if isinstance(error, OSError) else error}", file=said)
        except Exception as error:
            print(f"{failed}: {type(error).__name__}: {error}", file=said)
    for line in said.getvalue().splitlines():
        warn(line)
    return answer
