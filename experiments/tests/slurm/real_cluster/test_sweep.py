"""From a plan to job arrays, and from their records to one figure."""

import json

from experiments.tests.conftest import ROOT
from experiments.tests.slurm.real_cluster.cluster import PARTITIONS, node_of
from experiments.tests.slurm.real_cluster.conftest import ClusterWorkplace


def test_three_partitions_give_one_figure_with_three_machines(place: ClusterWorkplace) -> None:
    place.workplace.behave(FAKE_SECONDS="0.05")
    # No fewer give a verdict.
    said = place.say("submit", "--blocks", "6")
    assert [line.split(": ")[0] for line in said.splitlines()] == list(PARTITIONS)
    assert said.count("6 processes in 6 tasks") == 3
    place.cluster.wait_until_idle()
    assert len(place.records()) == 18
    for path in place.records():
        record = json.loads(path.read_text())
        partition = path.parents[3].name
        assert record["contenders"][0]["axes"]["threads"] == 16
        assert record["provenance"]["slurm"]["SLURMD_NODENAME"] == node_of(partition)
        assert record["provenance"]["slurm"]["SLURM_JOB_PARTITION"] == partition
        assert record["provenance"]["slurm"]["SLURM_CPUS_PER_TASK"] == str(PARTITIONS[partition])
        environment = record["provenance"]["openmp"]["environment"]
        assert environment["OMP_NUM_THREADS"] == "16"
        assert environment["OMP_PLACES"] == "cores"
    assert "18 of 18 files are new" in place.say("collect")
    assert "0 of 18 files are new" in place.say("collect")
    assert len(list(place.workplace.results.glob("records/collected/*/machine/*/*.json"))) == 18
    report = place.report()
    for partition in PARTITIONS:
        assert f"{partition}: none" in report
    assert report.count("(equivalent)") >= 2


def test_odd_folders_and_hostile_names_run_nothing(place: ClusterWorkplace) -> None:
    folder = place.workplace.root / "a  b $(touch owned) `touch owned` & touch owned; %a"
    place.site("w5-3423", common=f'results = "{folder}"\narguments = ["--comment=a b; touch owned"]')
    place.say("submit")
    place.cluster.wait_until_idle()
    assert len(list(folder.glob("w5-3423/records/machine/*/*.json"))) == 5
    assert len(list(folder.glob("w5-3423/jobs/0001-?.log"))) == 5
    place.site("x; touch owned")
    assert 'slurm.partitions[1].name: found "x; touch owned"' in place.say("submit", code=1)
    assert not list(place.workplace.root.rglob("owned"))
    assert not (ROOT / "owned").exists()
