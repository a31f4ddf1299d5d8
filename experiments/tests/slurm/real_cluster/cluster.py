"""A Slurm cluster on this machine: a controller and three nodes, each a partition that feigns its CPUs."""

import os
import re
import secrets
import socket
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import IO

from experiments.tests.conftest import until
from experiments.tests.slurm.real_cluster import reaper
from experiments.tests.slurm.real_cluster.packages import UnavailableError, libraries, unpacked

PARTITIONS = {"xs-4114": 20, "w5-3423": 12, "i7-13700": 24}
MAX_ARRAY_SIZE = 16
"""Few, so that a small study meets the limit."""

_CONFIGURATION = """\
ClusterName=carom-tests
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={port}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser={user}
SlurmdUser={user}
PluginDir={plugins}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/run/munge.sock,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/run/slurmctld.pid
SlurmdPidFile={folder}/run/slurmd-%n.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/slurmd-%n.log
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
ReturnToService=2
SlurmdTimeout=10
KillWait=2
MinJobAge=3600
PropagateResourceLimits=NONE
MailProg=/bin/true
MaxArraySize={max_array_size}
"""


class Cluster:
    """Its daemons are children in the foreground; `reaper.py` ends them whatever becomes of this process."""

    def __init__(self) -> None:
        self._root = unpacked()
        # A folder of its own below the temporary one: munge wants every folder above its socket to be open.
        self.folder = Path(tempfile.mkdtemp(prefix="carom-slurm-"))
        self.folder.chmod(0o755)
        for name in ("run", "log", "state", "spool"):
            (self.folder / name).mkdir()
        self._children: dict[str, subprocess.Popen[bytes]] = {}
        command = [sys.executable, "-I", reaper.__file__, os.fspath(self.folder)]
        self._reaper = subprocess.Popen(command, stdin=subprocess.PIPE, start_new_session=True)
        self._configure()

    @property
    def environment(self) -> Mapping[str, str]:
        """What makes Slurm's commands talk to this cluster."""
        library = libraries(self._root)
        path = f"{self._root}/usr/bin:{self._root}/usr/sbin:{os.environ['PATH']}"
        return {
            "SLURM_CONF": f"{self.folder}/slurm.conf",
            "LD_LIBRARY_PATH": f"{library}:{library}/slurm-wlm",
            "PATH": path,
        }

    def start(self) -> None:
        """Start every daemon and wait for the nodes. Raises UnavailableError if they do not come up."""
        run = self.folder / "run"
        key = run / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(secrets.token_bytes(128))
        options = {"key-file": key, "socket": run / "munge.sock", "pid-file": run / "munged.pid"}
        options |= {"log-file": self.folder / "log" / "munged.log", "seed-file": run / "munge.seed"}
        self._daemon("munged", "--foreground", *(f"--{name}={path}" for name, path in options.items()))
        until(lambda: options["socket"].exists(), "munged does not answer", 20)
        self._daemon("slurmctld", "-D")
        for partition in PARTITIONS:
            self.start_node(node_of(partition))
        try:
            until(lambda: self.nodes("idle") == len(PARTITIONS), "", 30)
        except AssertionError:
            raise UnavailableError(f"Slurm does not start here: {self._complaint()}") from None

    def stop(self) -> None:
        """End everything and remove the folder."""
        assert self._reaper.stdin is not None
        self._reaper.stdin.close()
        self._reaper.wait(30)
        for child in self._children.values():
            child.wait(30)

    def start_node(self, node: str) -> None:
        """Start a node's daemon, for the first time or again."""
        stepd = self._root / "usr" / "sbin" / "slurmstepd"
        self._daemon("slurmd", "-D", "-N", node, "-d", os.fspath(stepd), name=node)

    def lose_power(self, node: str) -> None:
        """Kill a node with all that runs on it, and let the controller know at once."""
        self._children[node].kill()
        self._children[node].wait()
        reaper.kill(self.folder, node)
        self.ask("scontrol", "update", f"nodename={node}", "state=down", "reason=test")

    def ask(self, *command: str) -> str:
        """What one of Slurm's commands says."""
        done = self._call(*command)
        assert done.returncode == 0, f"{command}: {done.stderr}"
        return done.stdout

    def _call(self, *command: str) -> "subprocess.CompletedProcess[str]":
        around = {**os.environ, **self.environment}
        return subprocess.run(command, env=around, capture_output=True, text=True, timeout=60, check=False)

    def nodes(self, state: str) -> int:
        """How many nodes are in a state, e.g. `idle`."""
        return self._call("sinfo", "--Node", "--noheader", "--format=%t").stdout.split().count(state)

    def tasks(self, state: str) -> list[str]:
        """Ids, as JOB_INDEX, of the tasks in a state, e.g. `RUNNING`."""
        command = ("squeue", "--array", "--noheader", f"--states={state}", "--format=%F_%K")
        return self.ask(*command).split()

    def start_at_once(self) -> None:
        """Let tasks that were put back into the queue not wait for the time that Slurm has them wait."""
        until(lambda: bool(self.tasks("PENDING")), "nothing was put back into the queue", 30)
        for task in self.tasks("PENDING"):
            self.ask("scontrol", "update", f"jobid={task}", "starttime=now")

    def wait_until_idle(self, seconds: float = 90) -> None:
        """Wait until nothing waits or runs."""
        until(lambda: not self.ask("squeue", "--noheader").strip(), "jobs do not end", seconds)

    def _configure(self) -> None:
        ports = _free_ports(1 + len(PARTITIONS))
        user = Path("/proc/self").owner()
        text = _CONFIGURATION.format(
            port=ports[0],
            user=user,
            folder=self.folder,
            plugins=libraries(self._root) / "slurm-wlm",
            max_array_size=MAX_ARRAY_SIZE,
        )
        for (partition, cpus), port in zip(PARTITIONS.items(), ports[1:], strict=True):
            node = node_of(partition)
            where = f"NodeHostname=localhost NodeAddr=127.0.0.1 Port={port}"
            text += f"NodeName={node} {where} CPUs={cpus} RealMemory=1000\n"
            text += f"PartitionName={partition} Nodes={node} State=UP\n"
        (self.folder / "slurm.conf").write_text(text, encoding="utf-8")

    def _daemon(self, *command: str, name: str = "") -> None:
        log: IO[bytes]
        with (self.folder / "log" / f"{name or command[0]}.output").open("ab") as log:
            self._children[name or command[0]] = subprocess.Popen(
                [f"{self._root}/usr/sbin/{command[0]}", *command[1:]],
                env={**os.environ, **self.environment},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )

    def _complaint(self) -> str:
        logs = "\n".join(path.read_text(errors="replace") for path in (self.folder / "log").iterdir())
        found = re.search(r"^.*(fatal|error).*$", logs, re.MULTILINE | re.IGNORECASE)
        return found.group(0) if found else "no reason given"


def node_of(partition: str) -> str:
    """The name of the one node of a partition."""
    return f"n-{partition}"


def _free_ports(number: int) -> list[int]:
    sockets = [socket.socket() for _ in range(number)]
    try:
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()
