"""The verbs of `carom` that tell of what was measured: report, claims, figures, export and a few more."""

import argparse
import signal
import sys
import tempfile
from collections.abc import Callable, Sequence
from itertools import chain
from pathlib import Path

from support.command_line import Parser, exit_code_of, print_anything
from support.errors import InputError

Verb = Callable[[argparse.Namespace], int]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a verb; return its exit code: 0 done, 1 bad input, and those of `compare`."""
    # Where whoever started this ignores the ends of children, Python takes all of them for successes.
    if signal.getsignal(signal.SIGCHLD) is signal.SIG_IGN:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    print_anything()
    options = _parser().parse_args(arguments)
    return exit_code_of(lambda: int(options.run(options)))


def _parser() -> argparse.ArgumentParser:
    parser = Parser(prog="carom", description=__doc__)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def verb(run: Verb, text: str, results: str = "", description: str = "") -> argparse.ArgumentParser:
        """Add the verb that a function is called after, with a folder of results where it has one."""
        command = commands.add_parser(run.__name__.strip("_"), help=text, description=description or text)
        command.set_defaults(run=run)
        if results:
            told = f"default: {results}"
            command.add_argument("--results", type=Path, default=Path(results), metavar="DIR", help=told)
        return command

    figures = verb(_figures, "draw the figures of whatever records are there", "results")
    figures.add_argument("--experiment", metavar="A,B", help="only the figures of these experiments")
    told = "the questions that were asked, which lead the report"
    report = verb(_report, "write report.html", "results")
    report.add_argument("--study", metavar="A,B", default="", help=told)
    claims = verb(_claims, "print each published claim with its verdict, a line each", "results")
    claims.add_argument("--verbose", action="store_true", help="and below it all that is known of it")
    export = verb(_export, "write a CSV table with a row a timed repetition, for other tools", "results")
    told = "default: measurements.csv in the results; - is standard output"
    export.add_argument("--output", type=Path, metavar="FILE", help=told)
    told = "tell how often verdicts are wrong here, from what `carom study calibrate` measured"
    verb(_calibration, told, "results/calibration")
    _add_movie(verb(_movie, "draw a run as an animation, or one step of it as a picture"))
    return parser


def _add_movie(movie: argparse.ArgumentParser) -> None:
    movie.add_argument("scene", type=Path, metavar="SCENE", help="a scene file")
    told = "its run, from `carom run --trajectory`; without it the scene is simulated"
    movie.add_argument("trajectory", type=Path, nargs="?", metavar="TRAJECTORY", help=told)
    told = "what simulates it (default: %(default)s)"
    movie.add_argument("--variant", default="published", metavar="NAME", help=told)
    movie.add_argument("--program", type=Path, help=argparse.SUPPRESS)  # `carom` tells where it is
    movie.add_argument("--output", type=Path, metavar="FILE", help="*.mp4 (needs ffmpeg), *.gif or *.png")
    movie.add_argument("--step", type=_step, metavar="S", help="of a picture (default: the last)")


def _step(text: str) -> int:
    try:
        return int(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"found {text}, expected the number of a step") from error


# The imports below are inside the functions: drawing and printing libraries take seconds to load.


def _figures(options: argparse.Namespace) -> int:
    from analysis.figures import draw_all
    from analysis.report.all_claims import draw_all_claims
    from analysis.support.parallel import in_parallel

    wanted = options.experiment.split(",") if options.experiment else ()

    def files(of_claims: int) -> list[Path]:
        if of_claims:
            return draw_all_claims(options.results)
        return [figure.files[0] for figure in draw_all(options.results, wanted, pdf=True)]

    drawn, *claims = in_parallel(files, 1 if wanted else 2)
    for file in chain(drawn, *claims):
        print(file)
    if not drawn:
        print(f"{options.results}: no records to draw yet", file=sys.stderr)
    return 0


def _report(options: argparse.Namespace) -> int:
    from analysis.report import write

    print(write(options.results, options.study.replace(",", " ").split()))
    return 0


def _claims(options: argparse.Namespace) -> int:
    from analysis import claims
    from analysis.commands.claims_told import told

    found = claims.evidence_of(options.results)
    if not found:
        raise InputError(f"{options.results}: no records yet (they are made by `make experiments`)")
    for one in found:
        print(*told(one.study.name, claims.evaluate(one), verbose=options.verbose), sep="\n")
    if not options.verbose:
        print("What was measured, on what, and why it is open: carom claims --verbose")
    return 0


def _export(options: argparse.Namespace) -> int:
    from analysis.commands.export import write

    written = write(options.results, options.output)
    if written is not None:
        print(written)
    return 0


def _calibration(options: argparse.Namespace) -> int:
    from analysis.calibration.result import write

    text, files = write(options.results)
    print(text, *files, sep="\n")
    return 0


def _movie(options: argparse.Namespace) -> int:
    from analysis.commands import movie

    movie.target_of(options.scene, options.output, options.step)  # a mistake is told before it is simulated
    if options.trajectory is None and options.program is None:
        raise InputError("TRAJECTORY: missing, expected a file that `carom run --trajectory` wrote")
    with tempfile.TemporaryDirectory(prefix="carom-") as folder:
        run = options.trajectory or Path(folder) / "trajectory"
        if options.trajectory is None:
            code = movie.simulate(options.program, options.scene, options.variant, run)
            if code:
                return code
        print(movie.draw(options.scene, run, options.output, options.step))
    return 0
