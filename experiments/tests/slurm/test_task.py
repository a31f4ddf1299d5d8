"""One task of a job array without a cluster: twins, gaps, signals; and clients that do not answer."""

import json
import os
import signal
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.slurm import scheduler
from experiments.slurm.jobs import PartitionFolder, Standing, Unit, folders
from experiments.slurm.scheduler import TaskState
from experiments.slurm.task import work
from experiments.tests.conftest import PAIR_APART, ROOT, Workplace, start
from experiments.tests.slurm.test_script import site
from experiments.tests.slurm.test_submit import took
from support.errors import InputError
from support.files import write_json
from support.record_schema import is_record


def folder_of(workplace: Workplace) -> PartitionFolder:
    return folders(replace(workplace.settings, site=site(workplace.root)))[0]


def job_of(workplace: Workplace, tasks: int = 1, folder: PartitionFolder | None = None) -> Path:
    """Write the list of blocks of a job, dealt out to so many tasks."""
    folder = folder or folder_of(workplace)
    wanted = [*Standing(folder, folder.study(), {}).missing]
    job, path = folder.next_job([wanted[first::tasks] for first in range(tasks)])
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, job.content(), path.parent)
    return path


def start_task(manifest: Path, task: int) -> "subprocess.Popen[str]":
    return start(["work", os.fspath(manifest), str(task)], ROOT)


def records(workplace: Workplace) -> dict[str, bytes]:
    """All that were compared shared a process: 2 of `chunks`, 2 of `pair` and 3 of `control`."""
    paths = workplace.results.glob("slurm/cluster/xs/records/*/*/*.json")
    return {path.name: path.read_bytes() for path in paths}


@pytest.mark.parametrize("started", [[0, 1], [0, 0, 0]], ids=["two tasks", "copies of one"])
def test_those_who_share_a_folder_tear_nothing(workplace: Workplace, started: list[int]) -> None:
    workplace.behave(FAKE_SECONDS="0.05")
    tasks = len(set(started))
    manifest = job_of(workplace, tasks)
    for process in [start_task(manifest, task) for task in started]:
        _, error = process.communicate(timeout=60)
        assert process.returncode == 0
        assert all("waits for another" in line for line in error.splitlines())
    assert len(records(workplace)) == 7
    assert not list(workplace.results.rglob("xs/scenes")), "each has scenes of its own"
    assert all(is_record(json.loads(content)) for content in records(workplace).values())
    if tasks == len(started):
        assert sum("--tag" in call["words"] for call in workplace.calls()) == 16
        assert not list(workplace.results.rglob(".running/*"))


def test_the_signal_ahead_of_the_time_limit_keeps_what_is_finished(workplace: Workplace) -> None:
    workplace.behave(FAKE_SECONDS="0.3")
    process = start_task(job_of(workplace), 0)
    assert process.stdout is not None
    process.stdout.readline()
    process.send_signal(signal.SIGUSR1)
    _, error = process.communicate(timeout=60)
    assert process.returncode == 128 + signal.SIGUSR1
    assert error == "\nstopped: what is finished is kept; the same command goes on with the rest\n"
    assert 1 <= len(records(workplace)) < 7
    assert not list(workplace.results.rglob(".running/*"))


def test_a_failed_point_is_not_tried_again_by_its_task(workplace: Workplace) -> None:
    workplace.behave(FAKE_BENCH_CRASHES="nine")
    assert work(job_of(workplace), 0) == 2
    contenders = [one for content in records(workplace).values() for one in json.loads(content)["contenders"]]
    assert [one["axes"]["variant"] for one in contenders if "reason" in one] == ["nine"]
    assert len(contenders) == 15


def test_a_job_that_is_none_or_of_another_site_is_refused(workplace: Workplace) -> None:
    manifest = job_of(workplace)
    with pytest.raises(InputError, match="task 7: expected a number from 0 to 0"):
        work(manifest, 7)
    site(workplace.root, 'name = "xs"', 'name = "xl"')
    with pytest.raises(InputError, match=r'cluster.toml: has no partition "xs" any more'):
        work(manifest, 0)
    with pytest.raises(InputError, match="is not the list of blocks of a job"):
        work(workplace.root / "nothing.json", 0)


def test_the_control_is_spread_over_the_tasks(workplace: Workplace) -> None:
    assert [*missing(workplace)] == [
        *(("chunks", 0), ("control", 0), ("pair", 0)),
        *(("chunks", 1), ("control", 1), ("pair", 1)),
        ("control", 2),
    ]


def cut_off(workplace: Workplace, *lost: int) -> None:
    """Leave the blocks of the question `pair` as a task does that was killed after their first process."""
    for block in lost:
        paths = sorted(workplace.results.glob(f"slurm/cluster/xs/records/pair/*/*-b{block}.json"))
        for path in paths[1:]:
            path.unlink()


def standing(workplace: Workplace, folder: PartitionFolder | None = None, *, runs: bool = False) -> Standing:
    """What there is and is not, while all tasks of the last job run, or none of any."""
    folder = folder or folder_of(workplace)
    last = folder.known_jobs()[-1:] if runs else []
    return Standing(folder, folder.study(), {(one.name, 0): TaskState("RUNNING", "") for one in last})


def missing(workplace: Workplace, *, runs: bool = False) -> dict[Unit, int]:
    """How many processes are to be submitted, by block."""
    return standing(workplace, runs=runs).wanted


def test_a_block_that_was_cut_off_is_measured_anew(workplace: Workplace) -> None:
    workplace.question("pair", PAIR_APART)
    manifest = job_of(workplace)
    assert work(manifest, 0) == 0
    assert missing(workplace) == {}
    before = records(workplace)
    cut_off(workplace, 1)
    assert missing(workplace) == {("pair", 1): 2}
    assert missing(workplace, runs=True) == {}, "whoever measures it may go on with it"
    assert work(manifest, 0) == 0, "also by a task that was started again"
    assert missing(workplace) == {}
    assert records(workplace).keys() == before.keys()
    changed = [name for name, content in records(workplace).items() if before[name] != content]
    assert [name[-7:] for name in changed] == ["b1.json"] * 2


def test_blocks_that_do_not_fit_their_allocation_come_to_an_end(workplace: Workplace) -> None:
    workplace.question("pair", PAIR_APART)
    assert work(job_of(workplace), 0) == 0
    took(workplace, 40.0)
    settings = folder_of(workplace).settings
    site(workplace.root, "# own", "minutes = 1")
    (short,) = folders(settings)
    assert standing(workplace, short).too_long == [], "none was cut off"
    cut_off(workplace, 1)
    assert standing(workplace, short).too_long == ["pair"], "80 s, and a signal comes after 45"
    assert standing(workplace, short).wanted == {}
    site(workplace.root, "# own", "minutes = 90")
    assert standing(workplace, folders(settings)[0]).wanted == {("pair", 1): 2}


def test_a_point_that_failed_is_tried_again_before_its_partners_are(workplace: Workplace) -> None:
    workplace.behave(FAKE_BENCH_CRASHES="nine")
    assert work(job_of(workplace), 0) == 2
    assert missing(workplace) == {("pair", 0): 2}
    workplace.behave(FAKE_BENCH_CRASHES="none")
    assert work(job_of(workplace), 0) == 0
    assert missing(workplace) == {("pair", 1): 2}
    assert work(job_of(workplace), 0) == 0
    assert missing(workplace) == {}


def answers(workplace: Workplace, **programs: str) -> None:
    """Put stand-ins for Slurm's commands on the path."""
    folder = workplace.root / "tools"
    folder.mkdir()
    for name, text in programs.items():
        (folder / name).write_text(f"#!/bin/sh\n{text}\n")
        (folder / name).chmod(0o755)
    workplace.behave(PATH=f"{folder}:{os.environ['PATH']}")


def test_a_client_that_hangs_is_given_up(workplace: Workplace, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduler, "TIME_LIMIT_SECONDS", 0.2)
    answers(workplace, squeue="sleep 60", scontrol="echo slurm_load_ctl_conf error: no route >&2; exit 1")
    with pytest.raises(InputError, match=r"squeue: took longer than 0.2 s and was stopped"):
        scheduler.queue()
    with pytest.raises(InputError, match="scontrol: slurm_load_ctl_conf error: no route"):
        scheduler.max_array_size()


def test_variables_of_the_shell_do_not_overrule_the_script(workplace: Workplace) -> None:
    answers(workplace, sbatch='echo "${SBATCH_PARTITION:-7};cluster"')
    workplace.behave(SBATCH_PARTITION="another")
    assert scheduler.submit(Path("script")) == "7"
