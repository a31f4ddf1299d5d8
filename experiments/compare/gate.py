"""The verb `gate`: is this commit not slower than that one? The answer is an exit code."""

import argparse
import shlex
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from experiments.compare import exports, values
from experiments.compare.answer import Answer
from experiments.compare.command import WITHDRAWN, measured
from experiments.compare.commands import WORDS, Compared, split_off
from experiments.compare.course import Line, since_now
from experiments.compare.options import add_measuring, asked_of, read, with_cases
from experiments.compare.same_program import (
    require_two_files,
    require_two_libraries,
    require_two_programs,
    tell_own_path,
    tell_shared_places,
)
from experiments.compare.watch import Require
from experiments.compare.worktrees import Commit, Repository, Tree, build, repository
from experiments.plan.executable import found
from experiments.run.progress import warn
from experiments.support.vanishing import vanishing_folder
from support.command_line import Once, Parser
from support.errors import InputError

SLOWER, UNDECIDED = 3, 4


def gate(arguments: Sequence[str]) -> int:
    """Run the verb; returns 0 where it is established that the commit is not slower by more than the margin,
    3 where it is slower, 4 where the time did not settle it, 2 where a command failed, 5 where the base
    differs from itself. Raises InputError before anything is measured.
    """
    words, run = split_off(arguments)
    options = read(_parser(), words)
    if not run:
        raise InputError(
            f"found no command, expected `{WORDS} WORDS` at the end: what is run of both commits"
        )
    accepted = _accepted(options.accept)

    def end(answer: Answer) -> End:
        return verdict(answer, options.margin, accepted, options.fail_on)

    with ExitStack() as stack:
        commands, require = _built(options, run, stack)
        asked = asked_of(options, commands, commands[0].name)
        asked = replace(with_cases(asked, options), one_sided=True, many=options.many)
        warn(f"carom: {promise(asked.error, options.many)}")
        code, answer = measured(asked, lambda answer: end(answer).said, require)
    if code:
        return code
    exports.tell([end(answer).said], asked.exports)
    return end(answer).code


def _commits(options: argparse.Namespace, where: Repository) -> dict[str, Commit]:
    """What is compared with, and what is judged; says what may be unexpected of them. Raises InputError."""
    base, head = where.commit(options.base, "--base"), where.commit(options.head, "--head")
    committed = ""
    if base.sha == head.sha:
        warn(f"carom: {base.name} and {head.name} are the same commit, {head.short}: it is measured twice")
        committed = f": commit it first, then --base {head.short}"
    elif not options.base_exactly:
        base = where.merge_base(base, head)
    if where.is_changed:
        warn(f"carom: what is not committed is not measured{committed}")
    return {"base": base, "head": head}


def _built(
    options: argparse.Namespace, run: Sequence[str], stack: ExitStack
) -> tuple[tuple[Compared, ...], Require]:
    """The command in each of the two commits, checked out and built, and what is wanted of the libraries that
    they load. Raises InputError where both would run the same program.
    """
    where = repository()
    commits = _commits(options, where)
    prune = f"git -C {shlex.quote(str(where.top))} worktree prune"
    folder = stack.enter_context(vanishing_folder("carom-gate-", prune))
    since, trees = folder.stat().st_ctime_ns, dict[str, Tree]()
    for name, commit in commits.items():
        trees[name] = stack.enter_context(where.checked_out(commit, folder / name))
        if options.build is not None:
            with Line(options.quiet) as shown:
                shown.show(since_now(f"builds {name} {commit.short}"))
                build(options.build, trees[name])
        is_own = options.build is None or "/" in run[0]
        if is_own and not found(run[0], trees[name].folder).exists():
            how = (
                "a build that makes it in its own folder, whatever that is"
                if options.build
                else "--build LINE"
            )
            told = f"found {run[0]}, which is not there{' once it is built' * bool(options.build)}"
            raise InputError(f"{name} {commit.short}: {told}; expected {how} if it is to be built")
    if commits["base"].sha != commits["head"].sha:
        require_two_files(run, trees["base"], trees["head"], since, is_accepted=options.same_bytes)
        tell_own_path(trees["base"])
        if not options.same_bytes:
            require_two_programs(run, trees["base"], trees["head"])
            if options.build:
                tell_shared_places(options.build, trees["base"], since)
    words, line, pattern = tuple(run), " ".join(run), options.time_from
    commands = tuple(
        Compared(name, words, line, folder=tree.folder, time_from=pattern, called=name)
        for name, tree in ((f"{name} {tree.commit.short}", tree) for name, tree in trees.items())
    )

    def require(loaded: Sequence[Path]) -> None:
        if commits["base"].sha != commits["head"].sha:
            require_two_libraries(loaded, folder, since)

    return commands, require


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
    parser.register("action", None, Once)
    add = parser.add_argument
    told = "the branch that it is to go into, such as origin/main: compared with where --head left it"
    add("--base", required=True, metavar="COMMIT", help=told)
    told = "compare with that commit itself, and not with the one at which --head left it"
    add("--base-exactly", action="store_true", help=told)
    add("--head", default="HEAD", metavar="COMMIT", help="what is judged (default: %(default)s)")
    add("--build", metavar="LINE", help="a line for a shell that builds a commit, in its folder")
    told = "compare also where both builds give the same bytes although the sources differ"
    add("--same-bytes", action="store_true", help=told)
    told = "what is a failure: slower alone, or undecided as well (default: %(default)s)"
    add("--fail-on", choices=("slower", "undecided"), default="undecided", help=told)
    told = "so many calls share the error, such as those of a year (default: %(default)s)"
    add("--many", type=values.positive, default=1, metavar="N", help=told)
    told = "a file; where it is there, a slower commit passes, and its first line says why"
    add("--accept", type=Path, metavar="FILE", help=told)
    add_measuring(parser)
    return parser
