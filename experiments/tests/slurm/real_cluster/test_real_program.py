"""The real program on a real Slurm: a small study, and the command lines of the published study."""

import html
import json
import re
import shutil
import subprocess

import pytest

from experiments.support.schema import validator
from experiments.tests.conftest import ROOT
from experiments.tests.slurm.real_cluster.cluster import PARTITIONS, node_of
from experiments.tests.slurm.real_cluster.conftest import MACHINE, ClusterWorkplace
from support.record_schema import SCHEMA_FILE

PROGRAM = ROOT / "build" / "gcc" / "carom"

# The noisier the machine, the more blocks it takes until the verdict is more than `inconclusive`.
BLOCKS = (60, 240, 720)
# Each run is far shorter than a time slice of the kernel: the median of many is one that nothing cut into.
MANY_SHORT_RUNS = MACHINE.replace("particles = 100", "particles = 200").replace(
    "threads = 16", "threads = 1\nrepetitions = 301"
)

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
        assert validator(SCHEMA_FILE).is_valid(record)
        assert record["check"]["verdict"] == "passed"
        assert record["axes"]["threads"] == 16
        slurm = record["provenance"]["slurm"]
        assert slurm["SLURMD_NODENAME"] == node_of(slurm["SLURM_JOB_PARTITION"])
        assert record["provenance"]["openmp"]["environment"]["OMP_NUM_THREADS"] == "16"


@pytest.mark.slow
def test_three_kinds_of_node_with_one_processor_are_no_different(place: ClusterWorkplace) -> None:
    place.workplace.question("machine", MANY_SHORT_RUNS)
    place.site(common="blocks_per_task = 10")
    for blocks in BLOCKS:
        place.say("submit", "--build", str(ROOT / "build"), "--blocks", str(blocks))
        place.cluster.wait_until_idle(1800)
        assert len(place.records()) == blocks * len(PARTITIONS)
        place.say("collect")
        caption = caption_of_machines(place.report())
        verdicts = re.findall(r"\((equivalent|inconclusive|faster|slower)\)", caption)
        assert len(verdicts) == len(PARTITIONS) - 1
        if "inconclusive" not in verdicts:
            break
    assert not {"faster", "slower"} & set(verdicts), caption
    for path in place.records():
        provenance = json.loads(path.read_text(encoding="utf-8"))["provenance"]
        partition = provenance["slurm"]["SLURM_JOB_PARTITION"]
        assert f"{partition}: {provenance['cpu_model']} on {node_of(partition)}" in caption
    assert (place.workplace.results / "figures" / "machine.svg").is_file()
    if "inconclusive" in verdicts:
        pytest.skip(f"too noisy here for the verdict `equivalent`: {caption}")


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
    found = re.search(r"<figcaption>One scene on every machine .*?</figcaption>", report)
    assert found is not None
    return html.unescape(found.group(0))
