"""The tables that `analysis performance` prints."""

import re
from pathlib import Path

import pytest

from analysis.cli import main
from analysis.derived.unavoidable import PHASES
from analysis.tests.synthetic import write
from analysis.tests.synthetic_noise import QUIET
from analysis.tests.synthetic_points import LADDER
from analysis.tests.synthetic_study import study


def printed(folder: Path, capsys: pytest.CaptureFixture[str]) -> list[str]:
    assert main(["performance", "--results", str(folder)]) == 0
    return capsys.readouterr().out.replace("\u00a0", " ").splitlines()


def test_every_rung_rate_and_phase_is_a_row(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, study(["ladder", "limits"], blocks=4, noise=QUIET))
    lines = printed(tmp_path, capsys)
    rows = [line for line in lines if line.startswith("| ") and not line.startswith("| ---")]
    assert sum(line.startswith("- ") and "faster than the published best" in line for line in lines) == 2
    assert sum("6 of 6" in row or "4 of 4" in row for row in rows) == 2 * len(LADDER)
    assert sum(row.startswith("| copy within 4.00 MiB (L3)") for row in rows) == 2
    assert sum(row.startswith("| arithmetic, 2 at once") for row in rows) == 2
    assert [sum(f"| {phase} |" in row for row in rows) for phase in PHASES] == [4] * len(PHASES)
    assert all(line.count("|") > 2 for line in rows)


def test_collisions_a_second_are_told_by_scene_and_threads(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    records = []
    for scene in ("all threads", "two threads"):
        for record in study(["threads"], blocks=6, noise=QUIET):
            of_scene = {"experiment": "exact_threads", "scene_name": scene}
            of_scene["point"] = f"{record['tags']['point']}, {scene}"
            if scene == "all threads" or record["tags"]["x"] < 3:
                records.append(record | {"tags": record["tags"] | of_scene})
    write(tmp_path, records)
    head, _, more, two = [line for line in printed(tmp_path, capsys) if line.startswith("| ")]
    assert head.startswith(
        "| scene | million collisions a second, 1 thread | million collisions a second, 2 thr"
    )
    assert more.startswith("| all threads | 1.9 | 3.5 | 3.6 |")
    assert re.search(r"\| 1\.8[0-9] \[1\.[78][0-9]*, 1\.[89][0-9]*\] \|", more)
    assert two.startswith("| two threads | 1.9 | 3.5 | – | – |")


def test_what_was_not_measured_is_left_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, study(["ladder"], blocks=2, noise=QUIET))
    assert not any("| phase |" in line or "copy within" in line for line in printed(tmp_path, capsys))


def test_without_any_record_it_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, study(["steps"], blocks=2))
    assert main(["performance", "--results", str(tmp_path)]) == 1
    assert "no records of the ladder, the limits or exact_threads yet" in capsys.readouterr().err
