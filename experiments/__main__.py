"""`carom study`: plan, run and look after a study."""

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any

from experiments.calibration.command import add_options as add_calibrate_options
from experiments.calibration.command import calibrate
from experiments.plan import site
from experiments.plan.new_question import new_question
from experiments.plan.plan import Surroundings, plan
from experiments.plan.program import BESIDE, GENERATOR, find_programs
from experiments.plan.question import load_questions
from experiments.plan.scale import SCALES, find_scale
from experiments.plan.site import load_site
from experiments.results.collect import collect
from experiments.run.session import run
from experiments.run.status import show_plan, show_status
from experiments.run.study import Settings, keep_claims
from experiments.slurm.jobs import folders
from experiments.slurm.status import show_cluster_status
from experiments.slurm.submit import resume, submit
from experiments.slurm.task import work
from experiments.support.interrupts import stop_at_signals
from support.command_line import Parser, exit_code_of, number_above_zero, print_anything
from support.errors import InputError
from support.files import require_room_for_folder

Run = Callable[[argparse.Namespace], int]
Options = Callable[[argparse.ArgumentParser], None]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one verb; returns the exit code. Bad input is one line on standard error and 1."""
    stop_at_signals()
    print_anything()
    options = _parser().parse_args(arguments)
    kept = "what is finished is kept; the same command goes on with the rest"
    return exit_code_of(lambda: options.run(options), kept)


def _check(options: argparse.Namespace) -> int:
    """Read every question and site, plan each question at both scales, and say how many there are."""
    questions = load_questions(options.questions, options.study)
    sites = [load_site(str(path)) for path in sorted(site.FOLDER.glob("*.toml"))]
    where = load_site(options.site)
    programs = find_programs(where, options.build)
    for scale in SCALES.values():
        around = Surroundings(where, site.this_machine(), programs, scale)
        for one in questions:
            plan(one, around)
    asked = {name for one in questions for name in one.programs if name in programs}
    unbuilt = [programs[name].remedy for name in sorted(asked) if programs[name].sha256 is None]
    print(f"{len(questions)} questions and {len(sites)} sites are valid")
    for remedy in unbuilt:
        print(f"whether its variants exist could not be looked up: {remedy}")
    return 0


def _builds(options: argparse.Namespace) -> int:
    """The one that makes the scenes, and what the questions cannot do without."""
    find_scale(options.scale)
    questions = load_questions(options.questions, options.study)
    where = load_site(options.site)
    if where.cluster is not None:
        raise InputError(f"site {where.name}: is a cluster; use `carom study submit --site {options.site}`")
    require_room_for_folder("results", options.results)
    asked = {GENERATOR}.union(*(one.programs for one in questions))
    print(*(name for name in (*where.programs, *BESIDE) if name in asked))
    return 0


def _status(options: argparse.Namespace) -> int:
    settings = _settings(options)
    if not settings.results.is_dir() and settings.results != Settings.results:
        raise InputError(f"results: found {settings.results}, expected a folder that is there")
    is_local = load_site(settings.site).cluster is None
    return show_status(settings) if is_local else show_cluster_status(settings)


def _collect(options: argparse.Namespace) -> int:
    """From the folders named, or else from the partitions of the site."""
    settings = _settings(options)
    sources = options.folders or [folder.path for folder in folders(settings)]
    code = collect(sources, settings.results)
    keep_claims(settings.questions, settings.results)
    return code


def _submit(hand: Callable[..., int], options: argparse.Namespace) -> int:
    return hand(_settings(options), dry_run=options.dry_run)


def _calibrate(options: argparse.Namespace) -> int:
    """Measure, then tell."""
    if code := calibrate(options):
        return code
    from analysis.cli import main as tell

    return tell(["calibration", "--results", str(options.results)])


def _settings(options: argparse.Namespace) -> Settings:
    """Every setting is an option."""
    require_room_for_folder("results", options.results)
    return Settings(**{field.name: getattr(options, field.name) for field in fields(Settings)})


def _parser() -> argparse.ArgumentParser:
    parser = Parser(prog="carom study", description="Plan, run and look after a study.")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")

    def add(name: str, run: Run, told: str, options: Options = _add_options, *, listed: bool = True) -> None:
        # What only the runner and batch scripts call is not listed.
        shown: dict[str, Any] = {"help": told} if listed else {}
        verb = verbs.add_parser(name, description=told, **shown)
        options(verb)
        verb.set_defaults(run=run)

    add("run", lambda options: run(_settings(options)), "measure what is missing, then write the report")
    told = "say what a run would do and about how long it would take"
    add("plan", lambda options: show_plan(_settings(options)), told)
    add("status", _status, "say what is done, missing and failed")
    add("check", _check, "read every question and site file")
    new = "write a commented question to start from"
    add("new", lambda options: new_question(options.name, options.questions), new, _add_new_options)
    add("builds", _builds, "say which builds of the program the questions need", listed=False)
    for name, hand, told in (
        ("submit", submit, "hand what is missing to a Slurm cluster"),
        ("resume", resume, "hand to a Slurm cluster what is missing of all that was submitted"),
    ):
        add(name, partial(_submit, hand), told, _add_submit_options)
    told = "measure one task of a job array; batch scripts call it"
    add("work", lambda options: work(options.job, options.task), told, _add_work_options, listed=False)
    told = "measure contenders whose true ratios are known, and tell how often verdicts are wrong here"
    add("calibrate", _calibrate, told, add_calibrate_options)
    add("collect", _collect, "merge other results folders into this one", _add_collect_options)
    return parser


def _add_options(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--study", type=names, metavar="A,B", help="questions, beside the control (default: all)")
    add("--scale", metavar="|".join(SCALES), help="size of scenes (default: %(default)s)")
    add("--site", help="a name in experiments/sites, or a file (default: %(default)s)")
    add("--results", type=Path, help="folder of the records (default: %(default)s)")
    add("--build", type=Path, help="folder of the programs (default: %(default)s)")
    built = "only the least blocks of what these builds can measure; all else comes later"
    add("--builds", type=names, metavar="A,B", help=built)
    add("--questions", type=Path, help="folder of questions (default: this package's)")
    add("--blocks", type=positive_number, help="repeat every experiment so many times, whatever the budget")
    budget = "time for the whole study, or further time for one that is finished (default: the scale's)"
    add("--budget", type=minutes, dest="budget_seconds", metavar="MINUTES", help=budget)
    until = (
        "measure until all that can be decided is decided, instead of for a time (--budget: the longest time)"
    )
    add("--until-decided", action="store_true", help=until)
    add("--seed", type=int, help="of the order within blocks (default: %(default)s)")
    add("--no-figures", action="store_false", dest="figures", help="write no report, look at no verdict")
    parser.set_defaults(**{field.name: field.default for field in fields(Settings)})


def _add_submit_options(parser: argparse.ArgumentParser) -> None:
    _add_options(parser)
    parser.add_argument("--dry-run", action="store_true", help="print the batch scripts, submit nothing")


def _add_collect_options(parser: argparse.ArgumentParser) -> None:
    _add_options(parser)
    parser.add_argument("folders", type=Path, nargs="*", help="results folders (default: those of --site)")


def _add_new_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", help="of the question")
    told = "folder of your questions (default: %(default)s)"
    parser.add_argument("--questions", type=Path, default=Path("questions"), help=told)


def _add_work_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("job", type=Path, help="the job's list of blocks, a file *.json")
    parser.add_argument("task", type=int, help="the task's index in the array")


def names(text: str) -> tuple[str, ...]:
    """The names between commas. Raises what the parser makes a line of."""
    found = tuple(name.strip() for name in text.split(",") if name.strip())
    if not found:
        raise argparse.ArgumentTypeError(f"found '{text}', expected names between commas")
    return found


def positive_number(text: str) -> int:
    """A whole number of at least 1. Raises what the parser makes a line of."""
    if not (text.isascii() and text.isdigit() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"found {text}, expected a whole number of at least 1")
    return int(text)


def minutes(text: str) -> float:
    """A number of minutes above 0, in seconds. Raises what the parser makes a line of."""
    return 60 * number_above_zero(text, "minutes")


if __name__ == "__main__":
    sys.exit(main())
