"""Programs built in the job, for the node's own processor."""

import json
import os
from pathlib import Path

import pytest

from experiments.tests.conftest import ROOT
from experiments.tests.slurm.real_cluster.conftest import ClusterWorkplace

CMAKE = """#!/bin/sh
# Stands in for cmake: `--preset release -B FOLDER` makes the folder, `--build FOLDER` puts a program there.
test "$1" = --build || exec mkdir -p "$4"
test -e "$2/carom" && exit
echo "$SLURM_ARRAY_TASK_ID" >>"$BUILDS"
{ cat "$PROGRAM"; echo "# built on $SLURMD_NODENAME"; } >"$2/scratch"
chmod +x "$2/scratch"
mv "$2/scratch" "$2/carom"
"""


def test_each_kind_of_node_builds_once_for_itself(place: ClusterWorkplace, tmp_path: Path) -> None:
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "cmake").write_text(CMAKE)
    (tools / "cmake").chmod(0o755)
    builds = tmp_path / "builds"
    place.workplace.behave(
        PATH=f"{tools}:{os.environ['PATH']}", BUILDS=str(builds), PROGRAM=str(place.workplace.program)
    )
    place.site("xs-4114", "i7-13700", common="build = true")
    place.say("submit")
    place.cluster.wait_until_idle()
    assert len(builds.read_text().splitlines()) == 2
    programs = {
        path.parents[3].name: json.loads(path.read_text())["provenance"]["binary_sha256"]
        for path in place.records()
    }
    assert len(place.records()) == 10
    assert len(set(programs.values())) == 2, "every kind of node has a program of its own"
    assert place.say("resume").count("nothing to submit; all is measured") == 2


@pytest.mark.slow
@pytest.mark.skipif(
    not (ROOT / "build" / "gcc" / "carom").is_file(),
    reason="build/gcc/carom is not built (`make build` builds it)",
)
def test_a_job_builds_the_real_program_for_its_own_processor(place: ClusterWorkplace) -> None:
    place.site("w5-3423", common="build = true")
    site = place.workplace.root / "cluster.toml"
    site.write_text(site.read_text(encoding="utf-8").replace("minutes = 5", "minutes = 30"), encoding="utf-8")
    place.say("submit", "--build", str(ROOT / "build"))
    place.cluster.wait_until_idle(1500)
    records = [json.loads(path.read_text(encoding="utf-8")) for path in place.records()]
    assert len(records) == 5
    for record in records:
        assert record["contenders"][0]["check"]["verdict"] == "passed"
        assert "-march=native" in record["provenance"]["compiler_flags"]
