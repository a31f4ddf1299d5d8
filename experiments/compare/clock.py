"""Which time is judged: that which passes, or on a busy machine that in which a processor computed."""

import statistics

from experiments.compare.blocks import WAITS_COUNTED, Blocks, Runs
from experiments.compare.options import Asked
from support.vocabulary import PROCESSOR, WALL

_ONE = 1.05
"""Processors busy: whoever has no more computes on one."""

_WAITS_A_SECOND, _WAITS = 20, 10
"""How often a program that computes alone waits at most, beside what its start needs."""


def clock_of(asked: Asked, blocks: Blocks) -> str:
    """By which clock the blocks so far are judged, whatever they say of the commands.

    Of a program that computes on one processor and waits for nothing else, the time that passes is that in
    which it computes and that in which it waits for a processor. On a busy machine the second is noise.
    """
    is_timed = not (asked.cases or asked.has_printed_times)
    names = [one.name for one in asked.commands if (one.name, 0) in blocks.runs]
    computes = is_timed and all(_computes_alone(blocks.runs[name, 0]) for name in names)
    return PROCESSOR if computes and blocks.others.are_in_the_way else WALL


def _computes_alone(runs: Runs) -> bool:
    waits = runs.counts.get(WAITS_COUNTED)
    if not waits or max(runs.cores) > _ONE:
        return False
    return statistics.median(waits) <= _WAITS + _WAITS_A_SECOND * runs.median("seconds")
