"""The cluster of the tests itself: it leaves nothing behind, even when the tests die."""

import os
import signal
import subprocess
import sys
from pathlib import Path

from experiments.tests.conftest import ROOT, until
from experiments.tests.slurm.real_cluster import reaper
from experiments.tests.slurm.real_cluster.cluster import Cluster

DYING = """
import time
from experiments.tests.slurm.real_cluster.cluster import Cluster
cluster = Cluster()
cluster.start()
cluster.ask("sbatch", "--partition=w5-3423", "--output=/dev/null", "--wrap=srun sleep 600")
until(lambda: "sleep" in cluster.ask("squeue", "--noheader", "--steps"), "no step", 30)
print(cluster.folder, flush=True)
time.sleep(600)
"""


def test_nothing_outlives_tests_that_were_killed(cluster: Cluster) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    tests = subprocess.Popen(
        [sys.executable, "-c", DYING], stdout=subprocess.PIPE, text=True, env=environment
    )
    assert tests.stdout is not None
    folder = Path(tests.stdout.readline().strip())
    assert len(reaper.processes(folder)) > 5, "daemons, steps and jobs"
    os.kill(tests.pid, signal.SIGKILL)
    tests.communicate()
    until(lambda: not folder.exists(), "the folder is left", 30)
    assert not reaper.processes(folder)
    assert cluster.nodes("idle") > 0, "another cluster of the same tests is not touched"
