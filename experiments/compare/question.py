"""The commands as an experiment: one block runs each of them once, and the reference under a second name."""

import os
from dataclasses import replace
from pathlib import Path

from experiments.compare.commands import Compared
from experiments.compare.options import Asked
from experiments.plan.benchmark_cases import filter_of
from experiments.plan.command import Command, Place, resolved
from experiments.plan.executable import UnfitError
from experiments.plan.plan import Curve, Experiment, Surroundings
from experiments.plan.point import PROCESS, Point
from experiments.plan.program import GENERATOR, Program
from experiments.plan.question import Question, Sweep
from experiments.plan.scenes import NoScene
from experiments.plan.series import SECONDS_OF_UNIT, Series, literal
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
    question = Question(
        NAME, Path(NAME), "Commands compared", "comparison", "comparison", (), (), Sweep(x_name="case"),
        margin=asked.margin, error=asked.error, reference=asked.reference, verb=PROCESS,
        warm_up=asked.warm_up,
    )  # fmt: skip
    points = [
        _point(question, one, number, case, asked, around)
        for number, one in enumerate((*asked.commands, again(asked)), start=1)
        for case in enumerate(asked.cases or [None])
    ]
    return Experiment(question, tuple(points), f"{around.seed} {NAME}")


def again(asked: Asked) -> Compared:
    """The reference under its second name: a difference between the two is none of the commands."""
    first = next(one for one in asked.commands if one.name == asked.reference)
    return replace(first, name=first.name + AGAIN)


def _point(
    question: Question,
    one: Compared,
    number: int,
    case: tuple[int, str | None],
    asked: Asked,
    around: Surroundings,
) -> Point:
    """That of one command, which has a folder of its own, or of a case of it, with its number."""
    threads = min(asked.threads or around.machine.hardware_threads, around.machine.hardware_threads)
    bound = around.site.binding.environment(threads, around.machine)
    command, program = _command(one, case[1], asked, around)
    openmp = _environment(asked, bound, one.environment)
    run = {"scene": NoScene(), "threads": threads, "program": program, "command": command, "openmp": openmp}
    return Curve(question, number, Series(one.name, label=one.name), around).point_at(case[0], **run)


def _command(one: Compared, case: str | None, asked: Asked, around: Surroundings) -> tuple[Command, Program]:
    """Its words, in which nothing is a placeholder, and its program. Each may write any file among them."""
    words, prepare, conclude = (tuple(map(literal, each)) for each in (one.words, one.prepare, one.conclude))
    place = Place(one.folder, str(around.programs[GENERATOR].sha256), None)
    unit = SECONDS_OF_UNIT.get(asked.unit or "") if one.time_from else 1.0
    rounds = dict(zip((each.name for each in asked.commands), asked.rounds, strict=False))
    command = Command(
        words if case is None else (*words, literal(filter_of(case))),
        one.folder,
        place.instrument,
        pattern=one.time_from,
        unit_seconds=unit,
        benchmark=case,
        prepare=prepare,
        conclude=conclude,
        exit_codes=() if asked.exit_codes == (0,) else asked.exit_codes,
        turns=asked.turns,
        rounds=1 if case else rounds.get(one.name.removesuffix(AGAIN)),
    )
    try:
        return resolved(command, place)
    except UnfitError as unfit:
        option = "" if unfit.part == "command" else f"--{unfit.part}: "
        raise InputError(f"{one.called}: {option}{unfit.told}") from unfit


def in_options(reason: str) -> str:
    """A reason in the words of the command line where it has those of a question's file."""
    for key, option in _OPTIONS.items():
        # What a program has said stands behind other words, and stays as it is.
        if not key.endswith(": "):
            reason = reason.replace(key, option)
        elif reason.startswith(key):
            return option + in_options(reason.removeprefix(key))
    return reason


def _environment(
    asked: Asked, bound: dict[str, str], own: tuple[tuple[str, str], ...]
) -> tuple[tuple[str, str], ...]:
    """OpenMP's variables as a study sets them where threads are asked for, else as the user's environment has
    them; and a command's own.
    """
    users = {key: value for key, value in os.environ.items() if key.startswith(_OPENMP)}
    return tuple(sorted({**(bound if asked.threads else users), **dict(own)}.items()))
