"""Give the same pairs of programs to `carom compare` and to what people use today; print what each said.

`.venv/bin/python docs/notebook/usual_ways.py ROUNDS` needs c++, hyperfine, perf and build/gcc/carom.
"""

import json
import math
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from scipy import stats

SOURCE = """#include <cstdlib>
int main(int, char** words) {
    volatile double sum = 0;
    for (long left = std::atol(words[1]); left > 0; --left) sum = sum + 1.0 / static_cast<double>(left);
    return sum > 0 ? 0 : 1;
}
"""
TURNS = 40_000_000
CAROM = Path(__file__).parents[2] / "build/gcc/carom"
FOLDER = Path(tempfile.mkdtemp())
LOOP, FOUND = str(FOLDER / "loop"), FOLDER / "found.json"


def _run(*words: object) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)


def _seconds(words: list[str]) -> float:
    began = time.monotonic()
    _run(*words)
    return time.monotonic() - began


def _direction(ratio: float, *, differs: bool) -> tuple[str, float]:
    return ("slower" if ratio > 1 else "faster") if differs else "nothing", ratio


def _carom(first: list[str], second: list[str]) -> tuple[str, float]:
    _run(CAROM, "compare", "-n", "a", "-n", "b", "--export-json", FOUND, "-q", "--", *first, "--vs", *second)
    found = json.loads(FOUND.read_text())
    [one] = found["differences"]
    is_open = found["withdrawn"] or one["verdict"] == "inconclusive"
    return "nothing" if is_open else one["verdict"], one["ratio"]


def _hyperfine(first: list[str], second: list[str]) -> tuple[str, float]:
    lines = [" ".join(words) for words in (first, second)]
    _run("hyperfine", "-N", "--warmup", 1, "--runs", 10, "--export-json", FOUND, *lines)
    one, other = json.loads(FOUND.read_text())["results"]
    ratio = other["mean"] / one["mean"]
    spread = ratio * math.hypot(*(side["stddev"] / side["mean"] for side in (one, other)))
    return _direction(ratio, differs=abs(ratio - 1) > spread)


def _perf_stat(first: list[str], second: list[str]) -> tuple[str, float]:
    told = [_run("perf", "stat", "-e", "task-clock", "-r", 10, *words).stderr for words in (first, second)]
    found = [re.findall(r"([0-9.]+)\s+\+-\s+([0-9.]+)\s+seconds time elapsed", one)[0] for one in told]
    (one, of_one), (other, of_other) = [(float(mean), float(error)) for mean, error in found]
    ratio = other / one
    return _direction(ratio, differs=abs(ratio - 1) > 2 * ratio * math.hypot(of_one / one, of_other / other))


def _u_test(first: list[str], second: list[str]) -> tuple[str, float]:
    one, other = ([_seconds(words) for _ in range(10)] for words in (first, second))
    ratio = statistics.mean(other) / statistics.mean(one)
    return _direction(ratio, differs=stats.mannwhitneyu(one, other).pvalue < 0.05)


def _pairs(first: list[str], second: list[str]) -> tuple[str, float]:
    logs = [-math.log(_seconds(first) / _seconds(second)) for _ in range(10)]
    return _direction(math.exp(statistics.mean(logs)), differs=stats.ttest_1samp(logs, 0).pvalue < 0.05)


subprocess.run(["c++", "-O2", "-x", "c++", "-", "-o", LOOP], input=SOURCE, text=True, check=True)
asked = [(more, way) for more in (0, 1, 2, 5) for way in (_carom, _hyperfine, _u_test, _perf_stat, _pairs)]
for _ in range(int(sys.argv[1])):
    for more, way in random.sample(asked, len(asked)):
        began = time.monotonic()
        said, ratio = way([LOOP, str(TURNS)], [LOOP, str(TURNS * (100 + more) // 100)])
        took = time.monotonic() - began
        print(f"{more} % more work, {way.__name__[1:]}: {said}, ratio {ratio:.4f}, {took:.0f} s", flush=True)
