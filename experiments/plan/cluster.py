"""What a site file says of a Slurm cluster: its partitions, and what their jobs ask for."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any


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


@dataclass(frozen=True)
class Cluster:
    """A site's partitions, the folder of their results if the site names one, and how many jobs of one user
    the cluster takes, of all partitions together.
    """

    partitions: tuple[Partition, ...]
    results: Path | None = None
    max_submitted: int | None = None


def read_cluster(table: Mapping[str, Any]) -> Cluster:
    """The table `slurm` of a valid site file; what it says outside the partitions holds for all of them."""
    of_all = ("partitions", "results", "max_submitted")
    common = {key: value for key, value in table.items() if key not in of_all}
    results = Path(table["results"]) if "results" in table else None
    partitions = tuple(_partition({**common, **own}) for own in table["partitions"])
    return Cluster(partitions, results, table.get("max_submitted"))


def _partition(table: dict[str, Any]) -> Partition:
    lists = {key: tuple(table.pop(key, ())) for key in ("modules", "arguments")}
    return Partition(**{"hardware_threads": table["cpus"], **table, **lists})
