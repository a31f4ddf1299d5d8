"""The commands as an experiment: one block runs each of them once, and the reference under a second name."""

import os
from collections.abc import Sequence
from dataclasses import replace

from experiments.compare.commands import Compared
from experiments.compare.options import Asked
from experiments.plan.plan import Experiment, Surroundings, plan
from experiments.plan.point import Point
from experiments.plan.question import NamedScene, Question
from experiments.plan.scenes import NoScene
from experiments.plan.series import Benchmark, PrintedTime, Series
from support.errors import InputError
from support.vocabulary import AGAIN

NAME = "compare"
_OPTIONS = {
    "prepare: ": "--prepare: ",
    "conclude: ": "--conclude: ",
    "time.stdout: ": "--time-from: ",
    "time: ": "--time-from: ",
    "turns = false": "`--turns off`",
    "Exec format error": "Exec format error: a script names its interpreter in its first line, as #!/bin/sh",
    "nothing beside what is timed": "nothing beside what is timed (`--setup` starts what is to go on)",
}
"""What a question's file calls what an option says."""
_OPENMP = ("OMP_", "GOMP_", "KMP_")


def experiment_of(asked: Asked, around: Surroundings) -> Experiment:
    """What is run. Raises InputError for a command that is not there or cannot be run."""
    commands = (*asked.commands, again(asked))
    points = [
        _point(one, number, (case, name), asked, around)
        for number, one in enumerate(commands, start=1)
        for case, name in enumerate(asked.cases or [None])
    ]
    question = _question(commands, asked)
    return Experiment(question, tuple(points), f"{around.seed} {NAME}")


def again(asked: Asked) -> Compared:
    """The reference under its second name: a difference between the two is none of the commands."""
    first = next(one for one in asked.commands if one.name == asked.reference)
    return replace(first, name=first.name + AGAIN)


def _question(commands: Sequence[Compared], asked: Asked, case: str | None = None) -> Question:
    return Question(
        name=NAME,
        file=commands[0].folder / NAME,
        title="Commands compared",
        kind="comparison",
        figure="comparison",
        scenes=(NamedScene(NoScene()),),
        series=tuple(_series(one, asked, case) for one in commands),
        margin=asked.margin,
        error=asked.error,
        reference=asked.reference,
        verb="process",
        threads=asked.threads or "hardware_threads",
        warm_up=asked.warm_up,
    )


def _point(
    command: Compared, number: int, case: tuple[int, str | None], asked: Asked, around: Surroundings
) -> Point:
    """That of one command, which has a folder of its own, or of a case of it, with its number."""
    try:
        [point] = plan(_question([command], asked, case[1]), around).points
    except InputError as error:
        # What is wrong with a series of a file here is wrong with a command.
        wrong = str(error).replace(f"{command.folder / NAME}: series[1].", f"{command.called}: ")
        raise InputError(in_options(wrong.replace(": command: ", ": "))) from error
    environment = _environment(asked, point.openmp, command.environment)
    return replace(point, series_number=number, openmp=environment, x=case[0], x_name="case")


def _series(command: Compared, asked: Asked, case: str | None) -> Series:
    [named] = _plain((case or "",))
    rounds = dict(zip((one.name for one in asked.commands), asked.rounds, strict=False))
    return Series(
        name=command.name,
        label=command.name,
        command=_plain(command.words),
        prepare=_plain(command.prepare),
        conclude=_plain(command.conclude),
        writes=None,
        exit_codes=() if asked.exit_codes == (0,) else asked.exit_codes,
        turns=asked.turns,
        rounds=1 if case else rounds.get(command.name.removesuffix(AGAIN)),
        time=PrintedTime(command.time_from, asked.unit) if command.time_from else None,
        benchmark=Benchmark(command.words[0], named) if case else None,
    )


def in_options(reason: str) -> str:
    """A reason in the words of the command line where it has those of a question's file."""
    for key, option in _OPTIONS.items():
        reason = reason.replace(key, option)
    return reason


def _plain(words: tuple[str, ...]) -> tuple[str, ...]:
    """The words, none of whose braces is a placeholder."""
    return tuple(word.replace("{", "{{").replace("}", "}}") for word in words)


def _environment(
    asked: Asked, bound: tuple[tuple[str, str], ...], own: tuple[tuple[str, str], ...]
) -> tuple[tuple[str, str], ...]:
    """OpenMP's variables as a study sets them where threads are asked for, else as the user's environment has
    them; and a command's own.
    """
    users = {key: value for key, value in os.environ.items() if key.startswith(_OPENMP)}
    return tuple(sorted({**(dict(bound) if asked.threads else users), **dict(own)}.items()))
