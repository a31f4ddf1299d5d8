"""The real program on a real Slurm: a small study, and the command lines of the published study."""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from experiments.tests.conftest import ROOT
from experiments.tests.slurm.real_cluster.cluster import PARTITIONS, node_of
from experiments.tests.slurm.real_cluster.conftest import ClusterWorkplace
from support.record_schema import is_record

PROGRAM = ROOT / "build" / "gcc" / "carom"

pytestmark = pytest.mark.skipif(
    not PROGRAM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)


def test_a_small_study_comes_back_from_two_partitions(place: ClusterWorkplace) -> None:
    place.site("xs-4114", "i7-13700", common="blocks_per_task = 3")
    place.say("submit", "--build", str(ROOT / "build"))
    place.cluster.wait_until_idle()
    records = [json.loads(path.read_text(encoding="utf-8")) for path in place.records()]
    assert len(records) == 10
    for record in records:
        assert is_record(record)
        assert record["contenders"][0]["check"]["verdict"] == "passed"
        assert record["contenders"][0]["axes"]["threads"] == 16
        slurm = record["provenance"]["slurm"]
        assert slurm["SLURMD_NODENAME"] == node_of(slurm["SLURM_JOB_PARTITION"])
        assert record["provenance"]["openmp"]["environment"]["OMP_NUM_THREADS"] == "16"


def test_three_kinds_of_node_with_one_processor_do_the_same(place: ClusterWorkplace) -> None:
    place.site(common="blocks_per_task = 6")
    # No fewer blocks give a verdict.
    place.say("submit", "--build", str(ROOT / "build"), "--blocks", "6")
    place.cluster.wait_until_idle()
    records = {path: json.loads(path.read_text(encoding="utf-8")) for path in place.records()}
    assert len(records) == 6 * len(PARTITIONS)
    contenders = [record["contenders"][0] for record in records.values()]
    assert len({one["state_hash"] for one in contenders}) == 1
    assert len({json.dumps(one["work"]) for one in contenders}) == 1
    # How fast three nodes are that share two cores with each other is chance, so that the times are made up:
    # first as if the nodes were alike, then as if one were half as slow again.
    assert verdicts_of_machines(place, records, {}) == ["equivalent", "equivalent"]
    shown = verdicts_of_machines(place, records, {"w5-3423": 1.5})
    assert sorted(shown) in (["equivalent", "slower"], ["faster", "faster"])
    caption = caption_of_machines(place.report())
    for record in records.values():
        provenance = record["provenance"]
        partition = provenance["slurm"]["SLURM_JOB_PARTITION"]
        assert f"{partition}: {provenance['cpu_model']} on {node_of(partition)}" in caption
    assert (place.workplace.results / "figures" / "machine.svg").is_file()


def verdicts_of_machines(
    place: ClusterWorkplace, records: dict[Path, Any], slower: dict[str, float]
) -> list[str]:
    """What the report says of the machines if all blocks took equally long but where it is `slower`."""
    for path, record in records.items():
        factor = slower.get(record["provenance"]["slurm"]["SLURM_JOB_PARTITION"], 1.0)
        [own] = record["contenders"]
        seconds = factor * (1 + 0.001 * own["tags"]["block"])
        runs = [one | {"steps_seconds": seconds} for one in own["repetitions"]]
        changed = record | {"contenders": [own | {"repetitions": runs}]}
        path.write_text(json.dumps(changed), encoding="utf-8")
    shutil.rmtree(place.workplace.results / "records", ignore_errors=True)
    place.say("collect")
    return re.findall(r"\((equivalent|inconclusive|faster|slower)\)", caption_of_machines(place.report()))


def test_the_published_command_lines_work(place: ClusterWorkplace) -> None:
    if shutil.which("perf") is None:
        pytest.skip("perf is not here (on Debian the package linux-perf)")
    if subprocess.run(["perf", "stat", "true"], capture_output=True, check=False).returncode != 0:
        pytest.skip("perf may not count here (kernel.perf_event_paranoid)")
    scene = place.workplace.root / "scene.in"
    arguments = ["100", "1000", "5", "10", "1", "2"]
    subprocess.run([PROGRAM, "generate", *arguments, "--output", scene], check=True)
    for partition in PARTITIONS:
        command = ["srun", f"--partition={partition}", "perf", "stat", "-e", "task-clock", "-r", "3"]
        command += [str(PROGRAM), "run", str(scene), "2"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == 0, done.stderr
        assert re.search(r"task-clock .*\( \+-", done.stderr), done.stderr
        assert "(3 runs)" in done.stderr


def caption_of_machines(report: str) -> str:
    """What stands below the figure of the machines."""
    found = re.search(r"</summary>One scene on every machine .*?</figcaption>", report)
    assert found is not None
    return html.unescape(found.group(0))
