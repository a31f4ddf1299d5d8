"""Batch scripts and site files: whatever a site says, no shell takes it for more than a word."""

import os
import shlex
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.plan.cluster import Partition
from experiments.plan.site import load_site
from experiments.run.study import Study
from experiments.slurm.submit import pack, render
from experiments.tests.conftest import SLURM_SITE, Workplace
from support.errors import InputError

OWNED = "x; touch owned"
PARTITION = Partition(name="xs", cpus=2, hardware_threads=4)
PROGRAMS = {"gcc": "gcc/carom", "clang": "clang/carom"}
SITE = f"""{SLURM_SITE}# common
[[slurm.partitions]]
name = "xs"
cpus = 2
# own
"""
STUB = '#!/bin/sh\nprintf "%s\\n" "$(basename "$0")" "$@" >>"$CALLS"\n'


def site(folder: Path, old: str = "", new: str = "") -> str:
    path = folder / "cluster.toml"
    path.write_text(SITE.replace(old, new) if old else SITE, encoding="utf-8")
    return os.fspath(path)


def calls(script: str, folder: Path) -> list[str]:
    """Run a script with stand-ins for the commands that it calls; the words that they were given."""
    for name in ("srun", "cmake", "module"):
        (folder / name).write_text(STUB)
        (folder / name).chmod(0o755)
    log = folder / "calls"
    environment = {"PATH": f"{folder}:{os.environ['PATH']}", "CALLS": str(log)}
    environment |= {"SLURM_CPUS_PER_TASK": "2", "SLURM_ARRAY_TASK_ID": "1"}
    subprocess.run(["bash", "-c", script], cwd=folder, env=environment, check=True, timeout=60)
    return log.read_text().splitlines()


def test_a_script_asks_for_what_the_site_says() -> None:
    partition = replace(PARTITION, account="physics", qos="long", constraint="a&b", arguments=("--mem=2G",))
    script = render("job", partition, Path("/results/xs/jobs/0001.json"), 3, PROGRAMS)
    options = [shlex.split(line)[1] for line in script.splitlines() if line.startswith("#SBATCH")]
    asked = (
        "--job-name=job --partition=xs --account=physics --qos=long --constraint=a&b --nodes=1 --ntasks=1 "
        "--cpus-per-task=2 --exclusive --hint=nomultithread --time=60 --signal=USR1@60 --array=0-2%4 "
        "--requeue --output=/results/xs/jobs/0001-%a.log --mem=2G"
    )
    assert {*asked.split()} <= {*options}
    assert 'srun --nodes=1 --ntasks=1 --cpus-per-task="$SLURM_CPUS_PER_TASK"' in script
    assert script.startswith("#!/bin/bash\n")
    assert "cmake" not in script
    assert "module" not in script


@pytest.mark.parametrize("named", [(), ("--mem=2G",), ("--mem-per-cpu=1G",), ("--memory-of-mine",)])
def test_all_of_a_nodes_memory_is_asked_for_unless_the_site_names_some(named: tuple[str, ...]) -> None:
    script = render("job", replace(PARTITION, arguments=named), Path("/r/jobs/1.json"), 1, PROGRAMS)
    options = [shlex.split(line)[1] for line in script.splitlines() if line.startswith("#SBATCH")]
    asked = [option for option in options if option.split("=")[0] in ("--mem", "--mem-per-cpu")]
    assert asked == ([one for one in named if "=" in one] or ["--mem=0"])


def test_no_value_reaches_a_shell_as_more_than_a_word(tmp_path: Path) -> None:
    folder = tmp_path / "it $(touch owned) `touch owned` & touch owned"
    folder.mkdir()
    partition = replace(
        PARTITION,
        name=OWNED,
        account=OWNED,
        constraint=OWNED,
        build=True,
        modules=(OWNED,),
        arguments=(OWNED,),
    )
    manifest = folder / "jobs" / "1.json"
    words = calls(render(OWNED, partition, manifest, 1, PROGRAMS), tmp_path)
    assert not list(tmp_path.rglob("owned"))
    assert words[:3] == ["module", "load", OWNED]
    assert words[words.index("srun") :][-2:] == [str(manifest), "1"]
    # The program's folder is one word of cmake's, whatever is in its name.
    assert str(tmp_path / folder.name / "build" / "gcc") in words


@pytest.mark.parametrize("text", ["--a\ntouch owned", "--a'", '--a"', "--a\\", "--a\x00", "--a # b"])
def test_what_would_leave_its_line_is_refused(text: str) -> None:
    told = "cannot be said in a batch script"
    with pytest.raises(InputError, match=told):
        render("job", replace(PARTITION, arguments=(text,)), Path("/r/jobs/1.json"), 1, PROGRAMS)
    with pytest.raises(InputError, match=told):
        render("job", PARTITION, Path(f"/{text}/jobs/1.json"), 1, PROGRAMS)


MISTAKES = {
    "partition": ('name = "xs"', f'name = "{OWNED}"', "slurm.partitions[1].name: found"),
    "line end": ('name = "xs"', 'name = "xs\\n"', "slurm.partitions[1].name: found"),
    "account": ("# common", f'account = "{OWNED}"', "slurm.account: found"),
    "qos": ("# own", 'qos = "$(touch owned)"', "slurm.partitions[1].qos: found"),
    "constraint": ("# own", f'constraint = "{OWNED}"', "slurm.partitions[1].constraint: found"),
    "module": ("# own", f'modules = ["{OWNED}"]', "slurm.partitions[1].modules[1]: found"),
    "argument": ("# own", 'arguments = ["--a\\ntouch owned"]', "slurm.partitions[1].arguments[1]: found"),
    "results": ("# common", 'results = "results"', "slurm.results: found"),
    "no program": ("gcc =", "icc =", "programs.gcc: missing; expected a text"),
    "binding": (
        '"close"',
        '"closed"',
        'openmp.proc_bind: found "closed", expected one of false, true, close',
    ),
    "no cluster": ('kind = "slurm"', 'kind = "local"', "kind: found"),
    "no time": ("# own", "minutes = 0", "slurm.partitions[1].minutes: found 0, expected a whole number"),
    "twice": ("# own", '[[slurm.partitions]]\nname = "xs"\ncpus = 2', 'slurm.partitions: found "xs" twice'),
}


@pytest.mark.parametrize(("old", "new", "line"), MISTAKES.values(), ids=MISTAKES.keys())
def test_a_wrong_site_submits_nothing(workplace: Workplace, old: str, new: str, line: str) -> None:
    process = workplace.start("submit", "--dry-run", "--site", site(workplace.root, old, new))
    output, error = process.communicate(timeout=60)
    assert process.returncode == 1
    assert line in error
    assert error.count("\n") == 1
    assert output == ""
    assert not list(workplace.root.rglob("owned"))


def test_what_holds_for_all_partitions_may_be_said_once(tmp_path: Path) -> None:
    text = 'minutes = 5\naccount = "physics"\nmodules = ["gcc"]\narguments = ["--mem=2G"]'
    cluster = load_site(site(tmp_path, "# common", text)).cluster
    assert cluster is not None
    (partition,) = cluster.partitions
    assert (partition.minutes, partition.account, partition.modules) == (5, "physics", ("gcc",))
    assert partition.hardware_threads == 2, "as many as cpus"


def test_only_known_programs_are_built_in_the_job() -> None:
    with pytest.raises(InputError, match=r'programs.icx: found "icx/carom"; a job can build gcc = '):
        render("job", replace(PARTITION, build=True), Path("/r/jobs/1.json"), 1, {"icx": "icx/carom"})


def test_a_dry_run_writes_nothing_and_needs_no_cluster(workplace: Workplace) -> None:
    workplace.behave(PATH="/usr/bin:/bin")
    process = workplace.start("submit", "--dry-run", "--site", site(workplace.root))
    output, error = process.communicate(timeout=60)
    assert process.returncode == 0, error
    assert "# xs: 16 processes in 7 tasks" in output
    assert "#SBATCH --array=0-6%4" in output
    assert not workplace.results.exists()


def test_a_cluster_is_not_measured_from_here(workplace: Workplace) -> None:
    with pytest.raises(
        InputError, match=r"site cluster: is a cluster; use `carom study submit --site \S+cluster.toml`"
    ):
        Study(replace(workplace.settings, site=site(workplace.root)))


def test_blocks_are_packed_as_the_site_wishes_unless_the_array_grows_too_long() -> None:
    wanted = [("a", number) for number in range(10)]
    assert [len(task) for task in pack(wanted, 1, 100)] == [1] * 10
    assert [len(task) for task in pack(wanted, 4, 100)] == [4, 4, 2]
    assert [len(task) for task in pack(wanted, 1, 3)] == [4, 4, 2]
    assert [unit for task in pack(wanted, 1, 3) for unit in task] == wanted


def test_signals_come_a_minute_ahead_or_less_where_there_are_few() -> None:
    ahead = {minutes: replace(PARTITION, minutes=minutes).signal_seconds for minutes in (1, 3, 4, 600)}
    assert ahead == {1: 15, 3: 45, 4: 60, 600: 60}
