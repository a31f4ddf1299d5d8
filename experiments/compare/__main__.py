"""`carom compare` and `carom gate`: commands against one another, until it is settled."""

import os
import sys

from experiments.compare.command import compare
from experiments.compare.gate import gate
from experiments.support.interrupts import stop_at_signals
from support.command_line import exit_code_of, print_anything
from support.errors import InputError

_VERBS = {"compare": compare, "gate": gate}


def main() -> int:
    """Run a verb; returns its exit code. Bad input is one line on standard error and 1."""
    stop_at_signals()
    print_anything()
    return exit_code_of(_run, "no half-written file is left")


def _run() -> int:
    verb, *arguments = sys.argv[1:] or [""]
    if verb not in _VERBS:
        raise InputError(f"found {verb!r}, expected compare or gate")
    if not os.stat(".").st_nlink:  # noqa: PTH116 - a folder that is removed has no path
        raise InputError("is called in a folder that is gone, expected one that is there")
    return _VERBS[verb](arguments)


if __name__ == "__main__":
    sys.exit(main())
