"""Where the study runs: the site's file, the machine found there, and how threads are bound to it."""

import os
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.cluster import Cluster, read_cluster
from experiments.plan.cpu_quota import read_cpu_quota
from experiments.support.schema import read_toml
from support.errors import InputError, not_one_of

FOLDER = Path(__file__).parents[1] / "sites"

OPENMP_VARIABLES = ("OMP_", "GOMP_", "KMP_")
"""How their names begin."""


_LOOK_OUT = {"GOMP_SPINCOUNT": "300000", "KMP_BLOCKTIME": "8"}
"""So many looks, which is what libgomp takes by itself, and in milliseconds about as long."""
_SLEEP_SOON = {"GOMP_SPINCOUNT": "1000", "KMP_BLOCKTIME": "0"}
"""As libgomp does by itself with more threads than processors."""


@dataclass(frozen=True)
class Machine:
    """One kind of machine: what the threads of a point are chosen by."""

    name: str
    cores: int
    hardware_threads: int


@dataclass(frozen=True)
class Binding:
    """OMP_PLACES and OMP_PROC_BIND, the latter also for more threads than cores."""

    places: str
    proc_bind: str
    proc_bind_oversubscribed: str

    def environment(self, threads: int, machine: Machine, *, bound: bool = True) -> dict[str, str]:
        """The OpenMP variables of a process; not `bound`: those of more threads than cores, however few.

        They say how threads wait, which each runtime else decides for itself: they look out for each other
        for some milliseconds before they sleep, or hardly, where they share cores.
        """
        oversubscribed = threads > machine.cores or not bound
        return {
            **(_SLEEP_SOON if oversubscribed else _LOOK_OUT),
            "OMP_DYNAMIC": "false",
            "OMP_NUM_THREADS": str(threads),
            "OMP_PLACES": self.places,
            "OMP_PROC_BIND": self.proc_bind_oversubscribed if oversubscribed else self.proc_bind,
        }


@dataclass(frozen=True)
class Site:
    """A site file: its name is that of the file."""

    name: str
    kind: str
    programs: Mapping[str, str]
    binding: Binding
    time_limit_seconds: float
    cluster: Cluster | None = None


def load_site(name_or_path: str) -> Site:
    """The site of a file, or of a name in `experiments/sites`. Raises InputError with one line."""
    path = Path(name_or_path)
    if path.suffix != ".toml":
        path = FOLDER / f"{name_or_path}.toml"
        names = sorted(file.stem for file in FOLDER.glob("*.toml"))
        if path.stem not in names:
            raise InputError(f"site: {not_one_of(name_or_path, [*names, 'a file *.toml'])}")
    document = read_toml(path, FOLDER / "site.schema.json")
    return Site(
        name=path.stem,
        kind=document["kind"],
        programs=document["programs"],
        binding=Binding(**document["openmp"]),
        time_limit_seconds=document.get("time_limit_seconds", 600.0),
        cluster=read_cluster(path, document),
    )


def this_machine() -> Machine:
    """The machine that this process runs on, as far as its affinity mask and its CPU quota let it: of a quota
    whole processors count, one at least.
    """
    processors = os.sched_getaffinity(0)
    siblings = (
        Path(f"/sys/devices/system/cpu/cpu{number}/topology/thread_siblings_list") for number in processors
    )
    cores = {path.read_text(encoding="ascii") if path.exists() else str(path) for path in siblings}
    quota = read_cpu_quota()
    most = max(1, int(quota)) if quota is not None else len(processors)
    return Machine(_cpu_model(), min(len(cores), most), min(len(processors), most))


def what_limits() -> str:
    """In one line, why not all of this machine's processors can be used; empty if they can."""
    processors, quota = len(os.sched_getaffinity(0)), read_cpu_quota()
    online = os.cpu_count() or processors
    limits = []
    if processors < online:
        limits.append(f"an affinity of {processors} of {online} processors")
    if quota is not None and quota < processors:
        limits.append(f"a CPU quota of {quota:g} processor{'s' if quota != 1 else ''}")
    if not limits:
        return ""
    machine = this_machine()
    threads = f"{machine.hardware_threads} hardware thread{'s' if machine.hardware_threads != 1 else ''}"
    return f"this machine counts as one with {threads}, because of {' and '.join(limits)}"


def clean_environment(openmp: Mapping[str, str]) -> dict[str, str]:
    """This process's environment with no OpenMP variable in it but those given.

    A stray OMP_SCHEDULE of the user's shell would otherwise decide what is measured.
    """
    inherited = {key: value for key, value in os.environ.items() if not key.startswith(OPENMP_VARIABLES)}
    return {**inherited, **openmp}


def _cpu_model() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    return next(models, platform.machine())
