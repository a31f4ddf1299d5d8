"""Which time is judged: all that passes, or on a busy machine that without waiting for a processor."""

from experiments.compare.blocks import Blocks
from experiments.compare.options import Asked
from support.vocabulary import OWN, WALL


def clock_of(asked: Asked, blocks: Blocks) -> str:
    """By which clock the blocks so far are judged, whatever they say of the commands.

    On a busy machine what a command waits for a processor is the noise. What else it waits for is its own.
    """
    names = [one.name for one in asked.commands if (one.name, 0) in blocks.runs]
    is_known = all(blocks.runs[name, 0].knows_waiting for name in names)
    is_timed = not (asked.cases or asked.has_printed_times)
    return OWN if is_timed and is_known and blocks.others.are_in_the_way else WALL
