"""When a growing number of blocks is looked at, and which part of the error each look may use.

A study looks before it decides whether to measure more. Looking at 4, 5, ... 64 blocks, each time with an
interval of 95 %, finds a difference where there is none in 15 % of all cases. So there are planned looks, and
the error of 5 % is shared out among them (alpha spending: Lan and DeMets, Biometrika 70, 1983; here by
Bonferroni's inequality, which asks nothing of the data and holds at every level, as Holm's correction needs).
All intervals of a comparison then hold together in at least 95 % of studies, at whichever look it stops.

Chosen by simulation among looks that grow by 1.3, 1.5 and 2, rising shares, Pocock's and O'Brien and
Fleming's boundaries, and a time-uniform t mixture (Wang and Ramdas, 2024): for effects of half to four
standard deviations of a block beyond the border it needs at most 15 % more blocks than the best of them, and
fewer than each of them somewhere.
"""

ERROR = 0.05
"""The error of one comparison, over all looks."""

LOOKS = (4, 6, 9, 14, 21, 32, 48)
"""Blocks of the planned looks, each about 1.5 times the one before; further ones grow alike."""
GROWTH = 1.5
LATER = 0.1
"""The share of all looks after those, of which each takes half of what is left."""


def share(blocks: int) -> float:
    """Return the share of `ERROR` that the look at so many blocks may use.

    A study that was stopped between two looks uses the share of the one before, which it then replaces.
    """
    if blocks < LOOKS[-1] * GROWTH:
        return (1 - LATER) / len(LOOKS)
    left, look = LATER, LOOKS[-1] * GROWTH
    while blocks >= look:
        left, look = left / 2, round(look * GROWTH)
    return left


def next_look(blocks: int) -> int:
    """Return the least number of blocks above `blocks` at which there is a look."""
    look = next((one for one in LOOKS if one > blocks), round(LOOKS[-1] * GROWTH))
    while look <= blocks:
        look = round(look * GROWTH)
    return look
