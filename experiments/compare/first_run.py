"""What the first run of each command tells: how often a short one is run, and what nobody meant to time."""

import math
import os
import re
import stat
import statistics
from collections.abc import Mapping, Sequence

from experiments.compare.answer import Answer
from experiments.compare.benchmarks import call_of
from experiments.compare.blocks import Key, Runs
from experiments.compare.commands import Compared
from experiments.compare.options import Asked
from experiments.compare.texts import duration
from experiments.plan.executable import found, is_file
from experiments.side_by_side.contest import LEAST_IDLE, idle_told
from experiments.side_by_side.printed_time import half_a_digit
from support.errors import InputError

SHORT = 0.05
"""Seconds: what takes less runs several times in a block."""

LONG_ENOUGH = 0.1
"""Seconds that the runs of a short command take together in a block."""

MOST = 15
"""Runs of a command in a block."""

NOT_FOUND = re.compile(r"^(?:\S*sh|env|xargs): .*(?:not found|No such file)")
"""What a shell says of a word that is no program, whose exit code may be lost behind it."""

_TABLE = ("Benchmark", "Time", "CPU", "Iterations")
"""The head of what a Google Benchmark prints."""


_PIPE = re.compile(r"(?<!\|)\|(?!\|)")


class NotMeantError(InputError):
    """What would be timed is surely not what was meant."""


def unstoppable(asked: Asked) -> list[str]:
    """The commands whose program gets another user's rights when it starts (set-user-ID), so that
    this user may not send it a signal.
    """
    if os.geteuid() == 0:
        return []
    files = [(one.called, found(one.words[0], one.folder)) for one in asked.commands]
    owners = [(name, file.stat()) for name, file in files if is_file(file)]
    return [name for name, one in owners if one.st_mode & stat.S_ISUID and one.st_uid != os.geteuid()]


def rounds_of(asked: Asked, runs: Mapping[Key, Runs]) -> tuple[int, ...]:
    """How often each command runs in a block, by the time that one run took; nothing where none is short."""
    if asked.cases or asked.has_printed_times:
        return ()
    known = [runs[one.name, 0] for one in asked.commands]
    seconds = [one.median("seconds") if one.seconds else math.inf for one in known]
    if min(seconds) >= SHORT:
        return ()
    return tuple(min(MOST, max(1, math.ceil(LONG_ENOUGH / max(one, 1e-6)))) for one in seconds)


def note_idle(asked: Asked, runs: Mapping[Key, Runs], idle_processors: float) -> bool:
    """Whether one of them waits for most of its time, though not for a processor, so that none is to be
    stopped; notes why.
    """
    for one in asked.commands:
        of_one = runs[one.name, 0]
        if of_one.seconds and of_one.median("seconds") > SHORT and idle_processors > LEAST_IDLE:
            of_one.undisturbed = idle_told(of_one.median("cores")) or of_one.undisturbed
    return any(one.undisturbed for one in runs.values())


def require_alike(asked: Asked) -> None:
    """Raises InputError for a Google Benchmark beside a command that is none. None is run to find out."""
    if asked.is_whole or asked.cases:
        return
    for one in asked.commands:
        if call_of(one) is not None:
            other = next(each.called for each in asked.commands if call_of(each) is None)
            told = f"{one.called}: is a Google Benchmark, and {other} is none"
            raise InputError(f"{told}; expected cases of all, or --no-gb to time whole programs")


def require_meant(asked: Asked, runs: Mapping[Key, Runs], benchmark: str | None) -> None:
    """Raises InputError for a Google Benchmark that would be timed as a whole although nobody said so: one
    that was seen to run, or whose table a command prints.
    """
    if benchmark is not None:
        told = f"{benchmark}: is a Google Benchmark, which repeats its cases until their time is full"
        expected = "expected that program with its arguments alone, or --no-gb to time it as a whole"
        raise NotMeantError(f"{told}; {expected}")
    for one in asked.commands:
        heads = (tuple(line.split()[:4]) for line in runs[one.name, 0].output.splitlines())
        if not (asked.is_whole or asked.cases) and _TABLE in heads:
            told = f"{one.called}: runs a Google Benchmark, which repeats its cases until their time is full"
            expected = "expected that program with its arguments alone, or --no-gb to time it as a whole"
            raise NotMeantError(f"{told}; {expected}")


def require_fine(asked: Asked, runs: Mapping[Key, Runs], answer: Answer) -> None:
    """Raises InputError for printed times that are always the same and have too few digits for the margin,
    where all that is known of a difference is that it is below half of the last digit.
    """
    for one in asked.commands:
        of_one = runs[one.name, 0]
        half = half_a_digit(of_one.output.encode().split(b"\n"), one.time_from) if one.time_from else 0.0
        is_hidden = any(abs(each.ratio - 1) <= half for each in answer.commands)
        if half > asked.margin and is_hidden and len({*of_one.all}) == 1:
            told = f"{one.called}: prints {duration(of_one.all[0])} in all of {len(of_one.all)} runs"
            expected = f"expected more digits for a margin of {100 * asked.margin:g} %"
            raise NotMeantError(f"{told}, which is known to {100 * half:.2g} %; {expected}")


def unlike_runs(one: Compared, first: float, of_both: Sequence[Runs]) -> list[str]:
    """Lines on runs that took so much longer or shorter than the others that they did something else, and on
    what may have failed without an exit code. `of_both` are those of the command, and of the reference also
    those under its second name: of a single block one of the two tells what the other found to do.
    """
    name, runs, told = one.name, of_both[0], []
    usual = min(each.median("all") for each in of_both if each.all)
    if first - usual > _LEAST and first > usual * 3:
        took = f"the first run of {name} took {duration(first)}, the others {duration(usual)}"
        told.append(
            f"{took}: it found something to do, or in memory, that they did not. `--prepare` of "
            "`carom compare` puts things back before each run"
        )
    if runs.left_behind and (share := statistics.median(runs.left_behind)) > 0.1:
        told.append(f"{100 * share:.0f} % of the time of {name} is of what it has left in the background")
    has_pipe = one.has_shell and _PIPE.search(one.line) is not None
    if runs.error and (has_pipe or NOT_FOUND.search(runs.error)):
        hint = " (of commands in a pipe the last alone has an exit code)" if has_pipe else ""
        told.append(f"{name} writes to standard error: {runs.error}{hint}")
    few = [one for one in runs.all if one < usual / 5 and usual - one > _LEAST]
    if few:
        took = f"{len(few)} of {len(runs.all)} runs of {name} took {duration(max(few))} at most"
        told.append(f"{took}, the others {duration(usual)}: they may have done nothing")
    return told


_LEAST = 0.02
"""Seconds by which runs differ at least, to be told."""
