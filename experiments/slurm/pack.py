"""How blocks are shared out among the tasks of an array, within what the cluster takes."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from experiments.plan.cluster import Cluster, Partition
from experiments.slurm.jobs import Unit


def pack(wanted: Sequence[Unit], blocks_per_task: int, array_size: int) -> list[list[Unit]]:
    """Share blocks out among tasks: so many each, or more where the array would else be too long."""
    each = max(blocks_per_task, -(-len(wanted) // array_size))
    return [list(wanted[first : first + each]) for first in range(0, len(wanted), each)]


def within_time(
    tasks: Iterable[Sequence[Unit]], partition: Partition, seconds: Mapping[str, float]
) -> list[list[Unit]]:
    """The tasks without the blocks that would not be measured before the signal that ends them, as far as the
    `seconds` of a block of an experiment are known. As many as the site wishes stay in any case.
    """
    limit = 60 * partition.minutes - partition.signal_seconds
    return [_first(task, partition.blocks_per_task, limit, seconds) for task in tasks]


def _first(task: Sequence[Unit], fewest: int, limit: float, seconds: Mapping[str, float]) -> list[Unit]:
    left, kept = limit, list[Unit]()
    for unit in task:
        left -= seconds.get(unit[0], 0.0)
        if left < 0 and len(kept) >= fewest:
            break
        kept.append(unit)
    return kept


@dataclass
class Room:
    """How many jobs of this user the cluster still takes, as far as the site's file says."""

    cluster: Cluster
    queued: Counter[str]
    """The user's jobs in the queue, by partition."""

    @property
    def is_limited(self) -> bool:
        """Whether the site's file says anything about it."""
        limits = [self.cluster.max_submitted, *(one.max_submitted for one in self.cluster.partitions)]
        return any(limit is not None for limit in limits)

    def of(self, partition: Partition, sharing: int) -> int | None:
        """How many tasks may be submitted to one partition, where so many, with itself, want some; None for
        any number.
        """
        room = []
        if self.cluster.max_submitted is not None:
            left = max(0, self.cluster.max_submitted - self.queued.total())
            room.append(-(-left // max(1, sharing)))
        if partition.max_submitted is not None:
            room.append(max(0, partition.max_submitted - self.queued[partition.name]))
        return min(room, default=None)

    def take(self, partition: Partition, tasks: int) -> None:
        """Count what was submitted."""
        self.queued[partition.name] += tasks
