"""Short commands: several runs in a row count as one, so that starting them does not drown them."""

import math
import shutil
from collections.abc import Iterable

from experiments.compare.options import Asked

SHORT = 0.05
"""Seconds: what takes less is repeated."""

LONG_ENOUGH = 0.1
"""Seconds that the runs in a row take together."""

MOST = 1000
"""Runs in a row."""

_IN_A_ROW = """n=$1 fine=$2
shift 2
while [ $n -gt 0 ]; do
    n=$((n - 1))
    "$@"
    code=$?
    case $fine in *" $code "*) ;; *) exit $code ;; esac
done
exit $code"""
"""For a shell: so many runs, one after another, up to the first whose exit code is none of those."""


def runs_in_a_row(asked: Asked, medians: Iterable[float]) -> int:
    """How many runs of each command count as one, by the times that one run of each took: 1 unless a command
    is short, and as many for all. What is prepared, or tells its own time, is never repeated.
    """
    is_one_run = asked.cases or asked.time_from or any(one.prepare or one.conclude for one in asked.commands)
    shortest = min(medians)
    if is_one_run or shortest >= SHORT:
        return 1
    return min(MOST, math.ceil(LONG_ENOUGH / max(shortest, LONG_ENOUGH / MOST)))


def in_a_row(words: tuple[str, ...], times: int, exit_codes: Iterable[int]) -> tuple[str, ...]:
    """The words of a shell that runs these words so many times, as a program, also where it has a command of
    its own of that name.
    """
    if times == 1:
        return words
    program = shutil.which(words[0]) or words[0]
    fine = f" {' '.join(map(str, exit_codes))} "
    return ("sh", "-c", _IN_A_ROW, "sh", str(times), fine, program, *words[1:])
