"""When a growing number of blocks is looked at, and which part of the error each look may use.

A study looks before it decides whether to measure more. Looking at 6, 7, ... 64 blocks, each time with an
interval of 95 %, finds a difference where there is none far more often than in 5 % of all cases. So there are
planned looks, and the error is shared out among them (alpha spending: Lan and DeMets, Biometrika 70, 1983;
here by Bonferroni's inequality, which asks nothing of the data and holds at every level, as Holm's correction
needs). All intervals of a comparison then hold together in at least 95 % of studies, at whichever look it
stops. What is measured between two looks is not looked at before the next one, so that a report, a share of
time or a resumed study adds no look.

Intervals that hold at any time (Howard, Ramdas, McAuliffe and Sekhon, Ann. Stat. 49, 2021) need no plan; what
they cost is in docs/reference/method.md.
"""

from bisect import bisect_right

from analysis.support.values import Floats

ERROR = 0.05
"""The error of one comparison, over all looks."""

LOOKS = (6, 9, 14, 21, 32, 48)
"""Blocks of the planned looks, each about 1.5 times the one before; further ones grow alike."""
GROWTH = 1.5
LATER = 0.1
"""The share of all looks after those, of which each takes half of what is left."""


_PLANNED = list(LOOKS)
while _PLANNED[-1] < 10**9:
    _PLANNED.append(round(_PLANNED[-1] * GROWTH))


def share(blocks: int) -> float:
    """Return the share of `ERROR` that the look at so many blocks may use.

    Any number of blocks between two looks has the share of the one before.
    """
    later = bisect_right(_PLANNED, blocks) - len(LOOKS)
    return (1 - LATER) / len(LOOKS) if later <= 0 else LATER / 2**later


def next_look(blocks: int) -> int:
    """Return the least number of blocks above `blocks` at which there is a look."""
    return _PLANNED[bisect_right(_PLANNED, blocks)]


def looks_up_to(most: float) -> list[int]:
    """Return the planned looks at no more than so many blocks."""
    return _PLANNED[: bisect_right(_PLANNED, most)]


def last_look(blocks: int) -> int:
    """Return the greatest number of at most `blocks` blocks with a look; `blocks` before the first."""
    return max(looks_up_to(blocks), default=blocks)


def seen(values: Floats) -> Floats:
    """Return the first of the values (blocks, in the order of time), up to the last planned look."""
    return values[: last_look(len(values))]
