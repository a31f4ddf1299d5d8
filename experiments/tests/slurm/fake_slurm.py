"""A cluster that is feigned: sbatch, squeue and scontrol as scripts on the path, which answer as real ones
do.
"""

import json
import os
import sys
from pathlib import Path
from typing import Any

from experiments.tests.conftest import Workplace

COMMANDS = Path(__file__).with_name("fake_slurm_commands.py")


class FakeSlurm:
    """The state of the cluster is one file, which tests and scripts read and write."""

    def __init__(self, workplace: Workplace, **config: object) -> None:
        folder = workplace.root / "slurm-tools"
        folder.mkdir()
        self._file = folder / "state.json"
        text = f"#!{sys.executable} -IS\n{COMMANDS.read_text(encoding='utf-8')}"
        for name in ("sbatch", "squeue", "scontrol"):
            (folder / name).write_text(text, encoding="utf-8")
            (folder / name).chmod(0o755)
        self._write({"config": config, "jobs": [], "asked": []})
        workplace.behave(FAKE_SLURM=os.fspath(self._file), PATH=f"{folder}{os.pathsep}{os.environ['PATH']}")

    def configure(self, **config: object) -> None:
        """Let the cluster be different from now on."""
        state = self._read()
        self._write(state | {"config": state["config"] | config})

    def arrays(self, partition: str = "") -> list[int]:
        """How many tasks each job that was taken has."""
        jobs = self._read()["jobs"]
        return [len(job["tasks"]) for job in jobs if job["partition"] == partition or not partition]

    def asked(self) -> list[int]:
        """How many tasks each job has that sbatch was given, taken or not."""
        return [int(number) for number in self._read()["asked"]]

    def becomes(self, index: int, state: str, reason: str = "None") -> None:
        """Let a task of the last job be in another state."""
        told = self._read()
        told["jobs"][-1]["tasks"][index] = {"state": state, "reason": reason}
        self._write(told)

    def ends(self, state: str = "COMPLETED") -> None:
        """Let all tasks have ended."""
        told = self._read()
        for job in told["jobs"]:
            job["tasks"] = [{"state": state, "reason": "None"} for _ in job["tasks"]]
        self._write(told)

    def _read(self) -> dict[str, Any]:
        return dict(json.loads(self._file.read_text(encoding="utf-8")))

    def _write(self, state: dict[str, Any]) -> None:
        self._file.write_text(json.dumps(state), encoding="utf-8")
