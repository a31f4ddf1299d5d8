"""The verb `gate`: is this commit not slower than that one? The answer is an exit code."""

import argparse
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from experiments.compare import exports, values
from experiments.compare.answer import Answer
from experiments.compare.command import WITHDRAWN, measured
from experiments.compare.commands import WORDS, Compared, split_off
from experiments.compare.options import add_measuring, asked_of, cases_of
from experiments.compare.worktrees import build, repository
from experiments.run.progress import warn
from support.command_line import Parser
from support.errors import InputError

SLOWER, UNDECIDED = 3, 4


def gate(arguments: Sequence[str]) -> int:
    """Run the verb; returns 0 where it is established that the commit is not slower by more than the margin,
    3 where it is slower, 4 where the time did not settle it, 2 where a command failed, 5 where the base
    differs from itself. Raises InputError before anything is measured.
    """
    words, run = split_off(arguments)
    options = _parser().parse_args(words)
    if not run:
        raise InputError(
            f"found no command, expected `{WORDS} WORDS` at the end: what is run of both commits"
        )
    accepted = _accepted(options.accept)

    def end(answer: Answer) -> End:
        return verdict(answer, options.margin, accepted, options.fail_on)

    with tempfile.TemporaryDirectory(prefix="carom-gate-") as folder, ExitStack() as trees:
        commands = _built(options, run, Path(folder), trees)
        asked = asked_of(options, commands, commands[0].name)
        exports.require_places(asked.exports)
        asked = replace(asked, one_sided=True, many=options.many, cases=cases_of(options, commands))
        warn(f"carom: {promise(asked.error, options.many)}")
        code, answer = measured(asked, lambda answer: end(answer).said)
    if code:
        return code
    print(end(answer).said)
    return end(answer).code


def _built(
    options: argparse.Namespace, run: Sequence[str], folder: Path, trees: ExitStack
) -> tuple[Compared, ...]:
    """The command in each of the two commits, checked out and built."""
    where = repository()
    commits = {name: where.commit(getattr(options, name), f"--{name}") for name in ("base", "head")}
    if where.is_changed:
        warn("carom: what is not committed is not measured")
    commands = []
    for name, commit in commits.items():
        tree = trees.enter_context(where.checked_out(commit, folder / name))
        if options.build is not None:
            build(options.build, tree, commit)
        commands.append(Compared(f"{name} {commit.short}", tuple(run), " ".join(run), folder=tree))
    return tuple(commands)


@dataclass(frozen=True)
class End:
    """What it comes to, in a line and as an exit code."""

    said: str
    code: int


def verdict(answer: Answer, margin: float, accepted: str, fail_on: str) -> End:
    """What it comes to."""
    if answer.is_withdrawn:
        return End("gate: nothing is certain: the base differs from itself", WITHDRAWN)
    if answer.is_not_slower(margin):
        return End("gate: passed: not slower by more than the margin", 0)
    if answer.is_slower(margin):
        if accepted:
            return End(f"gate: passed: slower, as is accepted: {accepted}", 0)
        return End("gate: failed: slower", SLOWER)
    return End("gate: the time did not settle it", UNDECIDED if fail_on == "undecided" else 0)


def promise(error: float, many: int) -> str:
    """How often a commit that changes nothing is called slower, which one side of the error allows."""
    share = f"{error * 50:g} %"
    if many == 1:
        return f"a commit that changes nothing is called slower in at most {share} of calls"
    return f"of {many} commits that change nothing, the chance that any is called slower is at most {share}"


def _accepted(file: Path | None) -> str:
    """The first line of the file that accepts a slower commit; empty without one."""
    if file is None or not file.exists():
        return ""
    said = file.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    if not said:
        raise InputError(f"--accept: {file}: is empty, expected the reason in a line")
    return said[0]


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="carom gate",
        usage="carom gate --base COMMIT [--build LINE] [OPTIONS] -- WORDS",
        description="Build two commits, run a command of both in turns, and say whether one is slower.",
        epilog="Exit codes: 0 not slower by more than the margin; 1 wrong usage or a failed build; 2 a "
        "failed command; 3 slower by more than the margin; 4 not settled in time; 5 the base differs from "
        "itself. 0 and 3 are established; after 5 nothing is certain.",
    )
    add = parser.add_argument
    add("--base", required=True, metavar="COMMIT", help="what it is compared with, such as origin/main")
    add("--head", default="HEAD", metavar="COMMIT", help="what is judged (default: %(default)s)")
    add("--build", metavar="LINE", help="a line for a shell that builds a commit, in its folder")
    told = "what is a failure: slower alone, or undecided as well (default: %(default)s)"
    add("--fail-on", choices=("slower", "undecided"), default="undecided", help=told)
    told = "so many calls share the error, such as those of a year (default: %(default)s)"
    add("--many", type=values.positive, default=1, metavar="N", help=told)
    told = "a file; where it is there, a slower commit passes, and its first line says why"
    add("--accept", type=Path, metavar="FILE", help=told)
    add_measuring(parser)
    return parser
