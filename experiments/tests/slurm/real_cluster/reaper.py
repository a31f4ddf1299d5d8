"""Ends everything of a test cluster, also when the tests died: it waits for the end of its standard input.

`python reaper.py FOLDER` is started by the tests with a pipe; whichever way they end, the kernel closes it.
"""

import contextlib
import os
import shutil
import signal
import sys
import time
from pathlib import Path


def processes(folder: Path, node: str | None = None) -> list[int]:
    """Ids of all processes of the cluster in `folder`, or of the jobs and steps of one of its nodes."""
    return [
        int(process.name)
        for process in Path("/proc").iterdir()
        if process.name.isdigit() and int(process.name) != os.getpid() and _belongs(process, folder, node)
    ]


def kill(folder: Path, node: str | None = None) -> None:
    """End them, and what they start meanwhile."""
    for _ in range(100):
        found = processes(folder, node)
        if not found:
            return
        for number in found:
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        time.sleep(0.05)


def _belongs(process: Path, folder: Path, node: str | None) -> bool:
    try:
        if _state(process) == "Z":
            return False
        if "slurmstepd" in (process / "exe").readlink().name:
            # Steps have no environment, but hold the log of their node's daemon.
            log = os.fspath(folder / "log" / f"slurmd-{node}.log" if node else folder / "log")
            return any(_target(file).startswith(log) for file in (process / "fd").iterdir())
        environment = (process / "environ").read_bytes().split(b"\0")
    except OSError:
        return False
    marks = [f"SLURM_CONF={folder / 'slurm.conf'}"]
    if node:
        marks.append(f"SLURMD_NODENAME={node}")
    return all(mark.encode() in environment for mark in marks)


def _state(process: Path) -> str:
    return (process / "stat").read_text().rpartition(")")[2].split()[0]


def _target(link: Path) -> str:
    with contextlib.suppress(OSError):
        return os.fspath(link.readlink())
    return ""


if __name__ == "__main__":
    sys.stdin.read()
    kill(Path(sys.argv[1]))
    shutil.rmtree(sys.argv[1], ignore_errors=True)
