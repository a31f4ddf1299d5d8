"""How many blocks a comparison that is still open would need, if its effect and its noise are as measured."""

import math

from analysis.statistics import quantiles
from analysis.statistics.dependence import widening_of_independent
from analysis.statistics.looks import ERROR, LOOKS, looks_up_to, next_look, share

MOST_BLOCKS = 1000
"""Of more, an estimate would say nothing."""


def blocks_to_decide(p: float, blocks: int, family: int = 1) -> float:
    """Return at which look, beyond so many blocks, a verdict is expected; infinite if it is not in sight.

    `p` is that of the verdict best supported, over all looks and not cut at 1 (`verdicts.judge_one`). The
    statistic that it stands for grows as the error of the centre falls; it has to reach what the look asks,
    corrected for `family` claims that are open.
    """
    if blocks < LOOKS[0]:
        return LOOKS[0]
    alone = p * share(blocks)
    if not 0 < alone < 1:
        return math.inf if alone else next_look(blocks)
    per_block = -quantiles.student(alone / 2, blocks - 1) * _error(blocks)
    for look in looks_up_to(MOST_BLOCKS):
        if look > blocks and per_block >= -quantiles.student(
            ERROR * share(look) / family / 2, look - 1
        ) * _error(look):
            return look
    return math.inf


def _error(blocks: int) -> float:
    """Return the error of a centre in standard deviations of a block, as the interval takes it."""
    return widening_of_independent(blocks) / math.sqrt(blocks)
