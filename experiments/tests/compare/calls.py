"""Calls of `carom compare` as a user makes them, and programs to compare."""

import os
import subprocess
from pathlib import Path

import pytest

from experiments.tests.conftest import ROOT

CAROM = ROOT / "build" / "gcc" / "carom"


needs_the_program = pytest.mark.skipif(
    not CAROM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)

LOOP = "i=0; while [ $i -lt {times} ]; do i=$((i+1)); done"
"""A loop of a shell, some 30 ms for ten thousand times on any machine of today."""


def run(folder: Path, *words: str, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [CAROM, *words],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder / "tmp"), **(env or {})},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def script(path: Path, text: str) -> None:
    path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
    path.chmod(0o755)


def left_behind(folder: Path) -> list[str]:
    """What a call has left in its temporary folder."""
    return [one.name for one in (folder / "tmp").iterdir()]


def printed(folder: Path) -> None:
    """Programs that say how long they took: `prints A B` took A times B ms."""
    script(folder / "prints", 'echo took "$(($1 * $2))" ms')


TOOK = ("--time-from", "took ([0-9]+) ms")


BENCHMARK = """
list= filter=. output=
for word; do
    case $word in
        --benchmark_list_tests=*) list=yes ;;
        --benchmark_filter=*) filter=${{word#*=}} ;;
        --benchmark_out=*) output=${{word#*=}} ;;
    esac
done
names=$(printf '%s\\n' {names} | grep -E -- "$filter")
[ -z "$list" ] || {{ printf '%s\\n' "$names"; exit; }}
case="{{\\"name\\": \\"$names\\", \\"real_time\\": {time}, \\"time_unit\\": \\"ms\\"}}"
echo "{{\\"benchmarks\\": [$case]}}" > "$output"
"""
"""Says of each case that it takes so long."""
