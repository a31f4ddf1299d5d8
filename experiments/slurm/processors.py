"""Whether a task found the processors on its node that its points were planned for."""

from dataclasses import dataclass

from experiments.plan.cluster import Partition
from experiments.plan.point import Point
from experiments.plan.site import Machine, what_limits
from experiments.support.process import Completed

_REFUSED = 1


@dataclass(frozen=True)
class Processors:
    """What the site's file says of a node, and what the task may use of the `found` one: an affinity mask, a
    control group, or a node without hyperthreads may leave less.
    """

    partition: Partition
    found: Machine

    def refusal(self, point: Point) -> Completed | None:
        """Why the point is not measured here: its threads would share what each was planned to have alone.
        None if it is. A sweep may want more threads than the node is said to have; then all of those are to
        be there.
        """
        said, found, threads = self.partition, self.found, point.threads
        short_of_threads = found.hardware_threads < min(threads, said.hardware_threads)
        short_of_cores = found.cores < threads <= said.cpus
        if said.oversubscribed or not (short_of_threads or short_of_cores):
            return None
        command = (str(point.program.path), point.verb) if point.command is None else point.command.words
        limits = what_limits()
        reason = (
            f"{_count(threads, 'thread')} on {_count(found.cores, 'core')} with "
            f"{_count(found.hardware_threads, 'hardware thread')}, all that the task may use"
            f"{f' ({limits})' if limits else ''}; the site file says cpus = {said.cpus} and "
            f"hardware_threads = {said.hardware_threads}: correct it, or say oversubscribed = true"
        )
        return Completed(command, _REFUSED, "", reason)


def _count(number: int, of_what: str) -> str:
    return f"{number} {of_what}{'s' if number != 1 else ''}"
