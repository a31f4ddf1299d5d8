"""`make docs`: the generated pages, then the figures and tables named, or else those that are stale."""

import os
import subprocess
import sys
from collections.abc import Sequence

from docs.generate import figures, pages, remake
from support.command_line import Parser, exit_code_of, print_anything
from support.errors import InputError
from support.home import ROOT


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit code: 0 done, 1 wrong input, 2 a command that failed."""
    print_anything()
    parser = Parser(prog="docs.generate", description=__doc__)
    told = "figures or tables of docs/figures/figures.toml to make again (default: all that are stale)"
    parser.add_argument("--figures", metavar="A,B", default="", help=told)
    parser.add_argument(
        "--list", action="store_true", help="say what is stale and how long it takes; make nothing"
    )
    parser.add_argument("--pages", action="store_true", help="make the pages alone")
    options = parser.parse_args(arguments)
    os.chdir(ROOT)
    return exit_code_of(lambda: _run(options.figures, only_list=options.list, only_pages=options.pages))


def _run(names: str, *, only_list: bool, only_pages: bool) -> int:
    if only_list:
        print(figures.listing())
        return 0
    wanted = figures.chosen(names)
    try:
        print(*pages.write(), sep="\n")
    except subprocess.CalledProcessError as error:
        told = f"ended with exit code {error.returncode}, expected its help"
        raise InputError(f"{pages.PROGRAM}: {told}") from error
    except FileNotFoundError as error:
        raise InputError(f"{pages.PROGRAM}: is not built, expected what `make build` makes") from error
    return 0 if only_pages else remake.make(wanted)


if __name__ == "__main__":
    sys.exit(main())
