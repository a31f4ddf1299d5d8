"""What docs/start.md says is to be seen is to be seen."""

import json
from bisect import bisect_left
from math import isqrt
from pathlib import Path

import pytest
from documents import BUILT, ROOT, output_of, shell

ATTEMPTS = 40
"""Of the guided schedule, which gives less to a thread that the system has put aside for another program:
beside other work many attempts are uneven, and one that is not shows what the schedule does."""


@pytest.mark.skipif(not BUILT, reason="build/gcc/carom is not built (`make build` builds it)")
def test_the_schedules_of_step_4_share_out_the_discs_unlike(tmp_path: Path) -> None:
    (block,) = (block for block in shell("docs/start.md", "") if "find_static" in block.text)
    *preparation, static, guided = block.text.splitlines()
    (tmp_path / "build").symlink_to(ROOT / "build")
    output_of("\n".join(preparation), tmp_path)
    assert imbalance(static, "static.json", tmp_path) > 1.9
    assert any(imbalance(guided, "guided.json", tmp_path) < 1.3 for _ in range(ATTEMPTS))


def imbalance(command: str, timeline: str, folder: Path) -> float:
    """Run the command; of the discs in the boxes that it searched, the most of a thread over the mean."""
    assert "uneven.in 2 " in command
    assert "imbalance" in output_of(command, folder)
    events = json.loads((folder / timeline).read_text(encoding="utf-8"))["traceEvents"]
    chunks = [event for event in events if event["name"] == "find chunk"]
    columns = isqrt(max(chunk["args"]["first"] + chunk["args"]["count"] for chunk in chunks))
    boxes = boxes_of_discs(folder / "uneven.in", columns)
    discs = [0, 0]
    for chunk in chunks:
        first = chunk["args"]["first"]
        discs[chunk["tid"]] += bisect_left(boxes, first + chunk["args"]["count"]) - bisect_left(boxes, first)
    return max(discs) / (sum(discs) / 2)


def boxes_of_discs(scene: Path, columns: int) -> list[int]:
    """The number of the box that each disc begins in, in rising order; boxes are numbered row by row."""
    lines = scene.read_text(encoding="utf-8").splitlines()
    side = 4 * float(lines[2]) + 1
    places = (line.split() for line in lines[4:])
    index = [[min(max(int(float(at) // side), 0), columns - 1) for at in words[1:3]] for words in places]
    return sorted(row * columns + column for column, row in index)
