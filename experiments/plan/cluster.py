"""What a site file says of a Slurm cluster: its partitions, and what their jobs ask for."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from support.errors import InputError


@dataclass(frozen=True)
class Partition:
    """One kind of node, as jobs ask for it.

    `cpus` is what a task asks for (cores, since jobs run without multithreading), `hardware_threads` what the
    node has; `minutes` is the time limit of a task. At most `at_once` tasks of an array run at a time;
    `blocks_per_task` blocks share an allocation. At most `max_submitted` of the user's jobs may be in the
    queue of the partition. `oversubscribed` lets more threads run than a task finds processors for.
    """

    name: str
    cpus: int
    hardware_threads: int
    minutes: int = 60
    account: str | None = None
    qos: str | None = None
    constraint: str | None = None
    modules: tuple[str, ...] = ()
    arguments: tuple[str, ...] = ()
    build: bool = False
    at_once: int = 4
    blocks_per_task: int = 1
    max_submitted: int | None = None
    oversubscribed: bool = False

    @property
    def signal_seconds(self) -> int:
        """How long before the time limit a task is asked to stop: a minute, less where there are few."""
        return min(60, 15 * self.minutes)

    @property
    def measuring_seconds(self) -> int:
        """How long a task may measure before that."""
        return 60 * self.minutes - self.signal_seconds


@dataclass(frozen=True)
class Cluster:
    """A site's partitions, the folder of their results if the site names one, and how many jobs of one user
    the cluster takes, of all partitions together.
    """

    partitions: tuple[Partition, ...]
    results: Path | None = None
    max_submitted: int | None = None


def read_cluster(path: Path, document: Mapping[str, Any]) -> Cluster | None:
    """The table `slurm` of a valid site file; what it says outside the partitions holds for all of them. None
    for a site that is no cluster. Raises InputError for a partition that is named twice.
    """
    if document["kind"] != "slurm":
        return None
    common = dict(document["slurm"])
    tables, results = common.pop("partitions"), common.pop("results", None)
    most = common.pop("max_submitted", None)
    partitions = tuple(_partition({**common, **own}) for own in tables)
    (name, times), *_ = Counter(partition.name for partition in partitions).most_common()
    if times > 1:
        raise InputError(f'{path}: slurm.partitions: found "{name}" twice, expected each name once')
    return Cluster(partitions, Path(results) if results is not None else None, most)


def _partition(table: dict[str, Any]) -> Partition:
    lists = {key: tuple(table.pop(key, ())) for key in ("modules", "arguments")}
    return Partition(**{"hardware_threads": table["cpus"], **table, **lists})
