"""Calls of `carom compare` as a user makes them, and programs to compare."""

import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from experiments.compare.__main__ import main
from experiments.tests.conftest import ROOT, hear_every_signal
from experiments.tests.forks import Forking, forked

CAROM = ROOT / "build" / "gcc" / "carom"

needs_the_program = pytest.mark.skipif(
    not CAROM.is_file(), reason="build/gcc/carom is not built (`make build` builds it)"
)

LOOP = "i=0; while [ $i -lt {times} ]; do i=$((i+1)); done"
"""A loop of a shell, some 30 ms for ten thousand times on any machine of today."""


def start(folder: Path, words: Sequence[str], env: Mapping[str, str]) -> "subprocess.Popen[str]":
    """`carom` with these words, as a fork: `test_first_day.py` calls the real program as well."""
    return forked(
        _carom, ["carom", *words], cwd=folder, env={**os.environ, **env}, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=hear_every_signal,
    )  # fmt: skip


def _carom(_: object) -> int:
    vars(subprocess)["Popen"] = Forking
    return main()


def run(
    folder: Path, *words: str, env: Mapping[str, str] | None = None, tmp: Path | None = None
) -> subprocess.CompletedProcess[str]:
    """Call it, with a folder for temporary files; how it ended."""
    with start(folder, words, {"TMPDIR": str(tmp or folder / "tmp"), **(env or {})}) as child:
        output, error = child.communicate(timeout=300)
    return subprocess.CompletedProcess(words, child.returncode, output, error)


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
