"""Files are whole or not there, whatever ends their writer; what is left half-written is read by nobody."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.slurm.jobs import folders
from experiments.support.vanishing import vanishing_folder
from experiments.tests.conftest import ROOT, Workplace
from experiments.tests.slurm.test_script import site
from support.files import write_json, write_text

KILLED_WHILE_WRITING = """
import os, signal, sys
from pathlib import Path
from support.files import write_json
os.fsync = lambda file: os.kill(os.getpid(), signal.SIGKILL)
path = Path(sys.argv[1])
path.parent.mkdir(parents=True, exist_ok=True)
write_json(path, {"job": "new"}, path.parent)
"""


@pytest.mark.parametrize("reason", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_file_that_cannot_be_finished_leaves_the_old_one_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, reason: BaseException
) -> None:
    path = tmp_path / "a.json"
    write_json(path, {"a": 1}, tmp_path)

    def fails(_: int) -> None:
        raise reason

    monkeypatch.setattr(os, "fsync", fails)
    with pytest.raises(type(reason)):
        write_text(path, "torn", tmp_path)
    assert json.loads(path.read_text()) == {"a": 1}
    assert list(tmp_path.iterdir()) == [path]
    with vanishing_folder("carom-test-") as fleeting:
        write_text(fleeting / "a.json", "no disk is waited for", fleeting)


def test_what_a_kill_left_half_written_is_no_job(workplace: Workplace) -> None:
    (folder,) = folders(replace(workplace.settings, site=site(workplace.root)))
    command = [sys.executable, "-c", KILLED_WHILE_WRITING, str(folder.jobs / "0001.json")]
    done = subprocess.run(command, env={**os.environ, "PYTHONPATH": str(ROOT)}, check=False)
    assert done.returncode == -9
    (left,) = folder.jobs.iterdir()
    assert left.name.endswith(".part")
    assert folder.known_jobs() == []
    assert folder.next_job([])[1].name == "0001.json"
