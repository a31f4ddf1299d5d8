"""The verb `compare`: blocks until all is settled or the time is over, then the result."""

import contextlib
import fcntl
import os
import re
import signal
import stat
import sys
import termios
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from experiments.compare import exports
from experiments.compare.answer import Answer, Difference, ask
from experiments.compare.blocks import Blocks, codes_said, keep_addresses, shell_seconds
from experiments.compare.course import Course, Line, since_now
from experiments.compare.earlier import Earlier
from experiments.compare.first_run import unlike_runs
from experiments.compare.found import Found
from experiments.compare.options import Asked, parse
from experiments.compare.sweeps import contrasts
from experiments.compare.texts import duration, hindered, result
from experiments.compare.watch import Require, Watch
from experiments.plan.plan import Surroundings
from experiments.plan.program import GENERATOR, find_programs
from experiments.plan.scale import find_scale
from experiments.plan.scenes import SceneFolder
from experiments.plan.site import load_site, this_machine
from experiments.results.store import Store, new_session
from experiments.run.progress import several, warn
from experiments.run.runner import Runner
from experiments.support import process
from experiments.support.descendants import children, end_all_but
from experiments.support.interrupts import signals_held
from experiments.support.vanishing import marked, vanishing_folder
from support.errors import InputError, Interrupted
from support.home import BUILDS
from support.vocabulary import AGAIN, ASKED, WALL

COMMAND_FAILED, WITHDRAWN = 2, 5

_FEW = 3
"""Runs after which a failure looks as if the runs before it had left something."""

Say = Callable[[Answer], str]


def compare(arguments: Sequence[str]) -> int:
    """Run the verb; returns the exit code: 0 measured, 2 a command failed, 5 the reference differs from
    itself. Raises InputError before anything is measured.
    """
    return measured(parse(arguments))[0]


def measured(asked: Asked, say: Say = lambda _: "", require: Require = lambda _: None) -> tuple[int, Answer]:
    """Measure and tell the result, with the line that `say` makes of it at the head of exported pages, unless
    what was loaded is not what `require` wants; returns the exit code and what the last look found.
    """
    if sys.stdout is None and not asked.exports and asked.earlier is None:
        raise InputError("standard output: is closed, expected a place for the result")
    exports.require_places(asked.exports, asked.earlier, asked.commands)
    earlier = Earlier(asked.earlier)
    if asked.fixed_layout:
        keep_addresses()
    with vanishing_folder("carom-compare-") as folder, _set_up(asked, folder):
        try:
            return _measured(asked, earlier, Watch(folder, require), folder, say)
        except OSError as error:
            if not str(error.filename).startswith(str(folder)):
                raise
            raise OSError(error.errno, error.strerror, str(folder.parent)) from error


def _measured(asked: Asked, earlier: Earlier, watch: Watch, folder: Path, say: Say) -> tuple[int, Answer]:
    where = load_site("local")
    around = Surroundings(where, this_machine(), find_programs(where, BUILDS), find_scale("paper"))
    generator = around.programs[GENERATOR]
    if generator.sha256 is None:
        raise InputError(generator.remedy)
    store = Store(folder, new_session())
    with store.opened():
        _write_down(asked, store)
        scenes = SceneFolder(folder / "scenes", store.temporary, str(generator.sha256))
        runner = Runner(store, scenes, generator, asked.most_seconds, asked.slice_seconds, tells=False)
        course = Course(asked, around, store, runner, watch)
        with Line(asked.quiet) as line:
            line.show(lambda: "making ready")
            stopped = course.run(earlier, line)
        by_wall: tuple[Difference, ...] = ()
        if course.answer.clock != WALL:
            by_wall = ask(folder, asked.many).without(course.left_out).commands
        found = course.found(by_wall, (*_remarks(course, by_wall), *_stopped_by(stopped)))
        said = result(found)
        try:
            # First what is kept: the terminal may be gone.
            try:
                earlier.keep(course.blocks, course.how)
            finally:
                exports.write(found, said, say(found.answer), lambda: _drawn(folder))
        finally:
            exports.tell(said, asked.exports)
    code = _exit_code(course.blocks, found, stopped)
    if course.broken is not None:
        raise course.broken
    return code, found.answer


def _drawn(results: Path) -> Path:
    """The file of the intervals and the blocks, an SVG in the folder of results."""
    with signals_held():
        from analysis.commands.programs_picture import programs_picture
    return programs_picture(results)


def _exit_code(blocks: Blocks, found: Found, stopped: int | None) -> int:
    """What the end comes to; says what failed."""
    cases = found.asked.cases
    called = {one.name: one.called for one in found.asked.commands}
    for name, case in {(name.removesuffix(AGAIN), case): None for name, case in blocks.failed}:
        same = [blocks.runs[key] for key in ((name, case), (name + AGAIN, case)) if key in blocks.runs]
        runs, reason = sum(one.tries for one in same), next(one.reason for one in same if one.reason)
        again = "; `--prepare` of `carom compare` puts back what a run leaves" if 0 < runs <= _FEW else ""
        if code := re.match("exit code ([0-9]+)", reason):
            again = f"{again}; `--ignore-exit {code[1]}` lets it count"
        well = f"{several(runs, 'run')}{' that ended well' if runs else ''}"
        whose = f"{called[name]}, {cases[case]}" if cases else called[name]
        warn(f"carom: {whose}: failed after {well}: {reason}{again}")
    if stopped is not None:
        return 128 + stopped
    return COMMAND_FAILED if blocks.failed else WITHDRAWN if found.answer.is_withdrawn else 0


def _stopped_by(number: int | None) -> tuple[str, ...]:
    if number is None:
        return ()
    left = "a command that ran then was killed, and may leave files of its own"
    return (f"stopped by {signal.Signals(number).name} before it was done: {left}",)


def _write_down(asked: Asked, store: Store) -> None:
    """What the analysis has to know beside the records."""
    levels = {one.name: one.levels for one in asked.commands}
    told = [{"name": one.name, "weights": dict(one.weights)} for one in contrasts(levels)]
    store.keep_note(ASKED, {"cases": asked.cases, "contrasts": told})


def _remarks(course: Course, by_wall: Sequence[Difference]) -> tuple[str, ...]:
    """What is to be known of how it was measured."""
    asked, busy = course.asked, course.blocks.others.remark()
    remarks = [] if busy is None else [f"{busy}. {hindered(by_wall)}"]
    if asked.rounds:
        often = zip(asked.commands, asked.rounds, strict=True)
        told = ", ".join(f"{one.name} {number}" for one, number in often)
        remarks.append(f"runs of each in a block, in random order and none of them stopped: {told}")
    if not (asked.has_printed_times or asked.cases):
        runs_of = {one.name: len(course.blocks.runs[one.name, 0].all) for one in asked.commands}
        once = [name for name, number in runs_of.items() if number == 1]
        names = ["each command"] if len(once) == len(runs_of) else once
        remarks += [f"{name} ran once, and a first run may find more to do than others" for name in names]
        for one in asked.commands:
            both = [(name, 0) for name in (one.name, one.name + AGAIN)]
            if course.blocks.runs[one.name, 0].all:
                of_both = [course.blocks.runs[key] for key in both if key in course.blocks.runs]
                remarks += unlike_runs(one, max(course.first.get(key, 0.0) for key in both), of_both)
    if _has_unread():
        remarks.append("standard input has something that no command was given: `--input FILE` gives it")
    codes = {one.name: course.blocks.runs[one.name, 0].codes for one in asked.commands}
    if len({tuple(one) for one in codes.values() if one}) > 1:
        told = "; ".join(f"{name}: {codes_said(one)}" for name, one in codes.items() if one)
        remarks.append(f"not all end alike: {told}")
    if any(one.has_shell for one in asked.commands):
        took = duration(shell_seconds())
        remarks.append(
            f"a shell starts lines that are more than plain words or have an input; its start takes {took}, "
            "and counts"
        )
    return tuple(remarks)


def _has_unread() -> bool:
    """Whether somebody has put something into standard input."""
    if sys.stdin is None:
        return False
    there = os.fstat(0)
    if stat.S_ISFIFO(there.st_mode):
        return int.from_bytes(fcntl.ioctl(0, termios.FIONREAD, bytes(4)), sys.byteorder) > 0
    return stat.S_ISREG(there.st_mode) and os.lseek(0, 0, os.SEEK_CUR) < there.st_size


@contextlib.contextmanager
def _set_up(asked: Asked, folder: Path) -> Iterator[None]:
    """Run what comes once before everything, and what comes after it whatever happens. What the first has
    started, such as a server, goes on until then.
    """
    known = children()
    try:
        _once("--setup", asked.setup, folder, asked.quiet)
        yield
    finally:
        _once("--cleanup", asked.cleanup, folder, asked.quiet)
        end_all_but(known)


def _once(option: str, lines: Sequence[str], folder: Path, quiet: bool) -> None:
    for line in lines:
        try:
            with Line(quiet) as shown:
                shown.show(since_now(f"{option}: {line}"))
                done = process.run(("sh", "-c", line), marked(os.environ, folder), ends_all=False)
        except Interrupted:
            warn(f"carom: {option}: {line}: was stopped before its end")
            raise
        if done.exit_code != 0:
            raise InputError(f"{option}: {line}: {done.reason}")
