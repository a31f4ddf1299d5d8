"""The course of one call: blocks and looks, until all is settled, the time is over, or somebody stops it."""

import os
import signal
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import replace

from experiments.compare.answer import Answer, Difference, ask, load
from experiments.compare.blocks import Blocks, Key
from experiments.compare.clock import clock_of
from experiments.compare.earlier import Earlier, How
from experiments.compare.first_run import (
    NotMeantError,
    note_idle,
    require_alike,
    require_fine,
    require_meant,
    rounds_of,
    unstoppable,
)
from experiments.compare.found import Found, Look
from experiments.compare.options import Asked
from experiments.compare.question import experiment_of
from experiments.compare.texts import change
from experiments.compare.watch import Watch
from experiments.plan.plan import Surroundings
from experiments.plan.scenes import sha256_of
from experiments.results.store import Store
from experiments.run.host_lock import WAITS
from experiments.run.progress import about, several, warn
from experiments.run.runner import Runner
from experiments.run.schedule import FIRST_LOOK
from experiments.support.interrupts import stop_if_asked
from support.command_line import can_draw
from support.errors import InputError, Interrupted
from support.vocabulary import AGAIN

_TRIALS = 6
"""So many blocks have to find room, or nothing is stopped: to find out who minds takes as long."""
_USUAL_WIDTH = 80
"""Of a terminal that tells none."""


class Course:
    """Holds what is asked, which learns how many runs count as one, and what has come of it so far."""

    def __init__(
        self, asked: Asked, around: Surroundings, store: Store, runner: Runner, watch: Watch
    ) -> None:
        """Plans it. Raises InputError for a command that is not there or cannot be run."""
        self.asked = asked
        self._watch = watch
        self._results = store.root
        self._loaded: Mapping[str, str] = {}
        """The SHA-256 of each library that was loaded, where that is to be known later."""
        self._around = around
        self.blocks = Blocks(experiment_of(asked, around), store, runner, has_cases=bool(asked.cases))
        self.answer = Answer(next=FIRST_LOOK)
        self._is_known = False
        self.broken: InputError | OSError | None = None
        """What ended it early, with something measured."""
        self.left_out: list[str] = []
        """The names of commands that failed, or the numbers of cases where one did."""
        self.first: dict[Key, float] = {}
        """The seconds of each one's first run."""
        self._looks: list[Look] = []
        self._seconds = 0.0

    def run(self, earlier: Earlier, line: "Line") -> int | None:
        """Measure; returns the signal that stopped it before its end, if one did."""
        self._earlier = earlier
        self._go_on(earlier)
        if self.blocks.done:
            load()
            self.answer = ask(self._results, self.asked.many)
        self.blocks.begin()
        stopped = None
        try:
            if not self._is_enough():
                self._measure(line)
        except Interrupted as interrupted:
            stopped = interrupted.signal_number
            if self.blocks.done == self.answer.next:
                self._look()
        except NotMeantError:
            raise
        except (InputError, OSError) as error:
            if not self.blocks.done:
                raise
            self.broken = error
        self._seconds = self.blocks.seconds
        return stopped

    @property
    def how(self) -> How:
        """How it is measured, for a later call that goes on."""
        asked = self.asked
        return How(asked.rounds, asked.turns, tuple(self.left_out), asked.fixed_layout, self._loaded)

    def found(self, by_wall: tuple[Difference, ...], remarks: tuple[str, ...]) -> Found:
        """What has come of it."""
        return Found(
            asked=self.asked,
            answer=self.answer,
            runs=self.blocks.runs,
            blocks=self.blocks.done,
            before=self.blocks.before,
            seconds=self._seconds,
            seconds_each=self.blocks.seconds_each,
            machine=self._around.machine.name,
            others=self.blocks.others.busy(),
            looks=tuple(self._looks),
            by_wall=by_wall,
            remarks=remarks,
        )

    def _go_on(self, earlier: Earlier) -> None:
        """Count what an earlier call measured, if it was the same."""
        if earlier.how is None:
            return
        before, self.left_out = self.asked, [*earlier.how.left_out]
        # What the user says of turns stands; a session that was measured in another way is not gone on with.
        turns = earlier.how.turns if before.turns is None else before.turns
        self._begin_again(replace(self.asked, rounds=earlier.how.rounds, turns=turns))
        self._loaded = earlier.how.loaded
        told = earlier.how.no_longer(self.asked.fixed_layout) or earlier.go_on(self.blocks)
        if told:
            warn(
                f"carom: --append: a new session begins, since what was measured earlier cannot go on: {told}"
            )
            self.left_out = []
            self._begin_again(before)
        self._is_known = not told and self.blocks.done > 0

    def _begin_again(self, asked: Asked) -> None:
        """Begin again, as it turned out to be better measured."""
        self.asked = asked
        self.blocks.again(experiment_of(asked, self._around))
        self.blocks.leave_out(self.left_out)

    def _measure(self, line: "Line") -> None:
        blocks = self.blocks
        if not self._is_known:
            self._first_block(line)
        while self._has_time():
            line.show(self._so_far)
            self._block()
            if blocks.done == self.answer.next:
                self._look()
                if self._is_enough():
                    return

    def _first_block(self, line: "Line") -> None:
        """One run of each by itself, which tells how they are to be measured; it counts where that is so."""
        asked, blocks = self.asked, self.blocks
        require_alike(asked)
        if asked.warm_up:
            runs = (asked.warm_up + 1) * len(blocks.experiment.points)
            warn(f"carom: --warmup: the first block is {runs} runs, however long they take")
        if asked.turns:
            told = "nobody looks whether a command waits for one that is stopped; --turns auto does"
            warn(f"carom: --turns: {told}")
        line.show(lambda: f"one run of each, {blocks.seconds:.0f} s")
        for name in unstoppable(asked):
            warn(f"carom: {name}: runs as another user, so that it can be neither stopped nor ended here")
            asked = self.asked = replace(asked, turns=False)
        is_open = asked.turns is None and not asked.cases and not asked.has_printed_times
        if is_open:
            self._begin_again(replace(asked, turns=False))
        with self._watch.watching(asked):
            self._block()
        self._require_meant()
        self.first = {key: one.seconds[0] for key, one in blocks.runs.items() if one.seconds}
        if not blocks.done:
            return
        rounds, each = rounds_of(asked, blocks.runs), blocks.seconds_each
        if blocks.seconds + (1 if rounds else 2) * each > asked.seconds + each:
            return
        if rounds:
            if any(one.prepare or one.conclude for one in asked.commands):
                # What comes before and after each run takes its time as well.
                most = max(1, int((asked.seconds - blocks.seconds) / each))
                rounds = tuple(min(one, most) for one in rounds)
            self._begin_again(replace(asked, turns=False, rounds=rounds))
            return
        is_open &= _TRIALS * each <= asked.seconds
        if is_open and not note_idle(asked, blocks.runs, blocks.others.idle_processors):
            self._begin_again(asked)

    def _require_meant(self) -> None:
        """Raises InputError where what ran first, or what it has loaded, is not what was meant."""
        asked = self.asked
        require_meant(asked, self.blocks.runs, self._watch.benchmark)
        loaded = self._watch.loaded([one.folder for one in asked.commands])
        self._watch.require(loaded)
        if asked.earlier is not None:
            self._loaded = {str(path): str(sha256_of(path)) for path in loaded}

    def _block(self) -> None:
        """A block; what failed in it is left out from then on."""
        stop_if_asked()
        blocks, asked = self.blocks, self.asked
        if blocks.run(vary_layout=not asked.fixed_layout):
            return
        for name, case in blocks.failed:
            out = str(case) if asked.cases else name
            self.left_out += [out] if out not in self.left_out else []
        blocks.leave_out(self.left_out)
        blocks.done += self._can_go_on()

    def _can_go_on(self) -> bool:
        """Whether there is something left to be compared, and the reference to be held against itself."""
        names = {point.series for point in self.blocks.experiment.points}
        return len(names) > 2 and {self.asked.reference, self.asked.reference + AGAIN} <= names

    def _has_time(self) -> bool:
        blocks = self.blocks
        is_time = not blocks.done or blocks.seconds + blocks.seconds_each <= self.asked.seconds
        return is_time and self._can_go_on()

    def _look(self) -> None:
        self.blocks.began += load()
        clock = clock_of(self.asked, self.blocks)
        self.answer = answer = ask(self._results, self.asked.many, clock).without(self.left_out)
        require_fine(self.asked, self.blocks.runs, answer)
        self._earlier.keep(self.blocks, self.how)
        blocks, needed = self.blocks, answer.needed
        more = None if needed is None else (needed - blocks.done) * blocks.seconds_each
        foretold = None if more is None else blocks.seconds + more
        self._looks.append(Look(blocks.done, blocks.seconds, foretold))

    def _is_enough(self) -> bool:
        return self.answer.is_enough(self.asked.margin, one_sided=self.asked.one_sided)

    def _so_far(self) -> str:
        """In one line: what is known, and when more will be."""
        asked, blocks, answer = self.asked, self.blocks, self.answer
        left = asked.seconds - blocks.seconds
        told = f"{several(blocks.done, 'block')}, {blocks.seconds:.0f} s"
        if not answer.commands:
            until = (answer.next - blocks.done) * blocks.seconds_each
            kept = f"; --time leaves {about(max(0.0, left))}" if until > left else ""
            return f"{told}; a first interval in {about(until)}{kept}"
        worst = min(answer.commands, key=lambda one: one.is_settled)
        known = f"{told}; {asked.cases[worst.case] if asked.cases else worst.name} {change(worst)}"
        if answer.needed is None:
            return f"{known}; {about(left)} left"
        until = (answer.needed - blocks.done) * blocks.seconds_each
        return f"{known}; {about(min(until, left))} left"


def since_now(what: str) -> Callable[[], str]:
    """What is done, with the seconds since now."""
    began = time.monotonic()
    return lambda: f"{what}, {time.monotonic() - began:.0f} s"


class Line:
    """One line on a terminal that tells how far it is, drawn anew each second; a context manager."""

    def __init__(self, quiet: bool) -> None:
        self._is_shown = not quiet and can_draw()
        self._told: Callable[[], str] = str

    def __enter__(self) -> "Line":
        if self._is_shown:
            # A thread would take time from what is measured whenever it likes.
            signal.signal(signal.SIGALRM, lambda *_: self._draw())
            signal.setitimer(signal.ITIMER_REAL, 1, 1)
        return self

    def __exit__(self, *_: object) -> None:
        if self._is_shown:
            signal.setitimer(signal.ITIMER_REAL, 0)
            self.show(str)

    def show(self, told: Callable[[], str]) -> None:
        """Put what it tells in the place of the line before, from now on."""
        self._told = told
        self._draw()

    def _draw(self) -> None:
        if not self._is_shown:
            return
        try:
            width = os.get_terminal_size(sys.stderr.fileno()).columns or _USUAL_WIDTH
            told = "waits for another measurement" if WAITS.is_waiting else self._told()
            sys.stderr.write(f"\r\x1b[K{told[: max(1, width - 1)]}")
            sys.stderr.flush()
        except OSError:
            self._is_shown = False  # the terminal is closed
