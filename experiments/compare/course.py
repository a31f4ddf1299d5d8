"""The course of one call: blocks and looks, until all is settled, the time is over, or somebody stops it."""

import os
import sys
from dataclasses import replace

from experiments.compare.answer import Answer, ask
from experiments.compare.blocks import Blocks
from experiments.compare.earlier import Earlier
from experiments.compare.found import Found, Look
from experiments.compare.options import Asked
from experiments.compare.question import experiment_of
from experiments.compare.short import runs_in_a_row
from experiments.compare.texts import blocks_said, change
from experiments.plan.plan import Surroundings
from experiments.results.store import Store
from experiments.run.progress import about, warn
from experiments.run.runner import Runner
from experiments.support.process import Coprocess
from support.errors import Interrupted


class Course:
    """Holds what is asked, which learns how many runs count as one, and what has come of it so far."""

    def __init__(self, asked: Asked, around: Surroundings, store: Store, runner: Runner) -> None:
        """Plans it. Raises InputError for a command that is not there or cannot be run."""
        self.asked = asked
        self._around = around
        self.blocks = Blocks(experiment_of(asked, around), store, runner)
        self._answer = Answer()
        self._looks: list[Look] = []
        self._seconds = 0.0

    def run(self, judge: Coprocess, earlier: Earlier, line: "Line") -> int | None:
        """Measure; returns the signal that stopped it before its end, if one did."""
        self._go_on(earlier)
        # The first look takes seconds, in which the analysis loads what it needs.
        self._answer = ask(judge, self.asked.many)
        self.blocks.begin()
        stopped = None
        try:
            if not self._is_enough():
                self._measure(judge, line)
        except Interrupted as interrupted:
            stopped = interrupted.signal_number
        self._seconds = self.blocks.seconds
        return stopped

    def found(self, remarks: tuple[str, ...]) -> Found:
        """What has come of it."""
        return Found(
            asked=self.asked,
            answer=self._answer,
            runs=self.blocks.runs,
            blocks=self.blocks.done,
            before=self.blocks.before,
            seconds=self._seconds,
            machine=self._around.machine.name,
            others=self.blocks.others.busy(),
            looks=tuple(self._looks),
            remarks=remarks,
        )

    def _go_on(self, earlier: Earlier) -> None:
        """Count what an earlier call measured, if it was the same."""
        if earlier.in_a_row > 1:
            self._repeat(earlier.in_a_row)
        if told := earlier.go_on(self.blocks):
            warn(
                f"carom: --append: a new session begins, since what was measured earlier cannot go on: {told}"
            )
            if earlier.in_a_row > 1:
                self._repeat(1)

    def _repeat(self, times: int) -> None:
        """Begin again, with so many runs of each command counted as one."""
        self.asked = replace(self.asked, in_a_row=times)
        self.blocks.repeat(experiment_of(self.asked, self._around), times)

    def _measure(self, judge: Coprocess, line: "Line") -> None:
        blocks, asked = self.blocks, self.asked
        while blocks.run(vary_layout=not asked.fixed_layout):
            if blocks.done == 1 and blocks.in_a_row == 1:
                times = runs_in_a_row(asked, [runs.median("seconds") for runs in blocks.runs.values()])
                if times > 1:
                    self._repeat(times)
                    continue
            if blocks.done == self._answer.next:
                self._look(judge)
                if self._is_enough():
                    return
            line.show(self._so_far())
            if blocks.seconds + blocks.seconds_each > asked.seconds:
                return

    def _look(self, judge: Coprocess) -> None:
        self._answer = answer = ask(judge, self.asked.many)
        blocks, needed = self.blocks, answer.needed
        more = None if needed is None else (needed - blocks.done) * blocks.seconds_each
        foretold = None if more is None else blocks.seconds + more
        self._looks.append(Look(blocks.done, blocks.seconds, foretold))

    def _is_enough(self) -> bool:
        return self._answer.is_enough(self.asked.margin, one_sided=self.asked.one_sided)

    def _so_far(self) -> str:
        """In one line: what is known, and when more will be."""
        asked, blocks, answer = self.asked, self.blocks, self._answer
        left = asked.seconds - blocks.seconds
        told = f"{blocks_said(blocks.done)}, {blocks.seconds:.0f} s"
        if not answer.commands:
            return f"{told}; a first interval in {about((answer.next - blocks.done) * blocks.seconds_each)}"
        worst = min(answer.commands, key=lambda one: one.is_settled)
        known = f"{told}; {asked.cases[worst.case] if asked.cases else worst.name} {change(worst)}"
        if answer.needed is None:
            return f"{known}; {about(left)} left"
        until = (answer.needed - blocks.done) * blocks.seconds_each
        return f"{known}; {about(min(until, left))} left"


class Line:
    """One line on a terminal that tells how far it is, drawn between blocks only; a context manager."""

    def __init__(self, quiet: bool) -> None:
        self._is_shown = sys.stderr.isatty() and not quiet

    def __enter__(self) -> "Line":
        return self

    def __exit__(self, *_: object) -> None:
        self.show("")

    def show(self, text: str) -> None:
        """Put the text in the place of the one before."""
        if self._is_shown:
            width = os.get_terminal_size(sys.stderr.fileno()).columns
            sys.stderr.write(f"\r\x1b[K{text[: max(1, width - 1)]}")
            sys.stderr.flush()
