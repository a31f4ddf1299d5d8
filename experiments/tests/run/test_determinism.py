"""What `carom list` promises: the final state's bits are the same whichever compiler built the program."""

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from experiments.tests.conftest import ROOT

BUILDS = [ROOT / "build" / compiler / "carom" for compiler in ("gcc", "clang")]

pytestmark = pytest.mark.skipif(
    not all(path.is_file() for path in BUILDS),
    reason="not both programs are built (`make build`, `make build COMPILER=clang`)",
)

SCENES = {
    "sparse": ("300", "1000", "10", "20", "-5", "5", "--seed", "3"),
    "dense": ("400", "380", "10", "8", "2", "5", "--seed", "4"),
    "apart": ("400", "600", "10", "8", "2", "5", "--seed", "6", "--placement", "random"),
    "small numbers": ("200", "1e-20", "3e-22", "6", "-1e-20", "1e-20", "--seed", "5"),
}


def carom(program: Path, *words: str) -> str:
    return subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout


def promising(scene: str) -> Iterator[str]:
    """Names of the variants that promise it and can run the scene: a float ends at 1e-38, and only of discs
    apart is there an event-driven simulation.
    """
    for variant in json.loads(carom(BUILDS[0], "list", "--json")):
        holds = scene != "small numbers" or variant["policies"]["precision"] == "double"
        holds = holds and (scene == "apart" or variant["policies"]["impact"] != "event_driven")
        if variant["same_bits"]["compilers"] and holds:
            yield variant["name"]


@pytest.mark.parametrize("name", SCENES)
def test_both_compilers_end_in_the_same_state(tmp_path: Path, name: str) -> None:
    scene = tmp_path / "scene.in"
    carom(BUILDS[0], "generate", *SCENES[name], "--output", str(scene))
    assert scene.read_text() == carom(BUILDS[1], "generate", *SCENES[name])
    hashes = {
        variant: [
            json.loads(carom(program, "run", str(scene), "2", "--variant", variant, "--json"))["state_hash"]
            for program in BUILDS
        ]
        for variant in promising(name)
    }
    assert len(hashes) > 10
    assert {variant: pair for variant, pair in hashes.items() if pair[0] != pair[1]} == {}


def test_both_programs_have_the_same_variants_and_promise_the_same() -> None:
    assert carom(BUILDS[0], "list", "--json") == carom(BUILDS[1], "list", "--json")
