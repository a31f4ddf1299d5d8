"""A cluster for all tests that need one, and a workplace whose site it is."""

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from experiments.tests.conftest import ROOT, SCENE, SLURM_SITE, Workplace
from experiments.tests.slurm.real_cluster.cluster import PARTITIONS, Cluster
from experiments.tests.slurm.real_cluster.packages import UnavailableError

MACHINE = f"""
title = "Machine"
figure = "machine"
claim = "machine"
tolerance = "published"
threads = 16
{SCENE}
[[series]]
name = "checkered"
variant = "published"

[blocks]
minimum = 5
wanted = 5
"""

SITE = SLURM_SITE + "minutes = 5\n"


@dataclass(frozen=True)
class ClusterWorkplace:
    """A workplace on the cluster."""

    workplace: Workplace
    cluster: Cluster

    def site(self, *partitions: str, common: str = "", each: str = "hardware_threads = 24") -> None:
        """Write the site's file; all partitions if none is named."""
        text = SITE + common
        for name in partitions or PARTITIONS:
            text += f'\n[[slurm.partitions]]\nname = "{name}"\ncpus = {PARTITIONS.get(name, 2)}\n{each}\n'
        (self.workplace.root / "cluster.toml").write_text(text, encoding="utf-8")

    def folder(self, partition: str) -> Path:
        return self.workplace.results / "slurm" / "cluster" / partition

    def records(self, partition: str = "*") -> list[Path]:
        return sorted(self.workplace.results.glob(f"slurm/cluster/{partition}/records/*/*/*.json"))

    def say(self, verb: str, *more: str, code: int = 0) -> str:
        """Run one verb for the site; returns what it prints, on standard error where it fails."""
        process = self.workplace.start(verb, "--site", "cluster.toml", *more)
        output, error = process.communicate(timeout=120)
        assert process.returncode == code, output + error
        return error if code else output

    def measured(self) -> list[dict[str, Any]]:
        """Every process that measured a point."""
        return [call for call in self.workplace.calls() if "--tag" in call["words"]]

    def report(self) -> str:
        """The report of what was collected."""
        command = [sys.executable, "-m", "analysis", "report", "--results", str(self.workplace.results)]
        subprocess.run(command, cwd=ROOT, check=True, capture_output=True, timeout=900)
        return (self.workplace.results / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def cluster() -> Iterator[Cluster]:
    try:
        cluster = Cluster()
    except UnavailableError as reason:
        pytest.skip(str(reason))
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()


@pytest.fixture
def place(cluster: Cluster, empty_workplace: Workplace) -> Iterator[ClusterWorkplace]:
    empty_workplace.question("machine", MACHINE)
    empty_workplace.behave(**cluster.environment)
    place = ClusterWorkplace(empty_workplace, cluster)
    place.site()
    yield place
    cluster.ask("scancel", "--me")
    cluster.wait_until_idle()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Whatever stands in this folder needs Slurm."""
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.slurm)
