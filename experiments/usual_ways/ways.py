"""Ways to find out whether one program is slower than another, each as its users read it."""

import json
import math
import re
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from scipy import stats

Words = Sequence[str]

RUNS = 10
"""Of each program, as all of these ways are used."""

ERROR = 0.05

SLOWER, FASTER, EQUIVALENT, NOTHING = "slower", "faster", "equivalent", "nothing"
"""What a way may say of the second program; only `carom compare` says that two are equivalent."""


@dataclass(frozen=True)
class Answer:
    """What was said, the ratio of times that was told, and the seconds until then."""

    said: str
    ratio: float
    seconds: float


def carom_compare(carom: str, first: Words, second: Words) -> Answer:
    """A minute at the most."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "found.json"
        command = [carom, "compare", "-n", "first", "-n", "second", "--export-json", str(file), "-q", "--"]
        began = time.monotonic()
        _run([*command, *first, "--vs", *second], (0, 5))
        took = time.monotonic() - began
        found = json.loads(file.read_text(encoding="utf-8"))
    [one] = found["differences"]
    open_one = found["withdrawn"] or one["verdict"] == "inconclusive"
    return Answer(NOTHING if open_one else one["verdict"], one["ratio"], took)


def hyperfine(_: str, first: Words, second: Words) -> Answer:
    """Ten runs, then ten runs. It tells a ratio with its standard deviation: read as a difference where the
    ratio is further from 1 than that.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "found.json"
        lines = [" ".join(words) for words in (first, second)]
        began = time.monotonic()
        _run(["hyperfine", "-N", "--warmup", "1", "--runs", str(RUNS), "--export-json", str(file), *lines])
        took = time.monotonic() - began
        one, other = json.loads(file.read_text(encoding="utf-8"))["results"]
    ratio = other["mean"] / one["mean"]
    spread = ratio * math.hypot(*(side["stddev"] / side["mean"] for side in (one, other)))
    return Answer(_direction(ratio) if abs(ratio - 1) > spread else NOTHING, ratio, took)


def u_test(_: str, first: Words, second: Words) -> Answer:
    """Ten runs, then ten runs, and Mann and Whitney's U test at 5 %, as Google Benchmark's compare.py."""
    began = time.monotonic()
    one, other = ([_seconds(words) for _ in range(RUNS)] for words in (first, second))
    p = float(stats.mannwhitneyu(one, other, alternative="two-sided").pvalue)
    ratio = statistics.mean(other) / statistics.mean(one)
    return Answer(_direction(ratio) if p < ERROR else NOTHING, ratio, time.monotonic() - began)


def perf_stat(_: str, first: Words, second: Words) -> Answer:
    """Ten runs, then ten runs. Of each it tells the mean with its standard error: read as a difference where
    the two are further apart than twice the standard error of that.
    """
    began = time.monotonic()
    (one, of_one), (other, of_other) = (_perf(words) for words in (first, second))
    ratio = other / one
    spread = 2 * ratio * math.hypot(of_one / one, of_other / other)
    said = _direction(ratio) if abs(ratio - 1) > spread else NOTHING
    return Answer(said, ratio, time.monotonic() - began)


def pairs_by_hand(_: str, first: Words, second: Words) -> Answer:
    """Ten times the one and then the other, and a t test of the differences at 5 %."""
    began = time.monotonic()
    times = [(_seconds(first), _seconds(second)) for _ in range(RUNS)]
    logs = [math.log(other / one) for one, other in times]
    p = float(stats.ttest_1samp(logs, 0.0).pvalue)
    ratio = math.exp(statistics.mean(logs))
    return Answer(_direction(ratio) if p < ERROR else NOTHING, ratio, time.monotonic() - began)


WAYS: dict[str, Callable[[str, Words, Words], Answer]] = {
    "carom compare": carom_compare,
    "hyperfine": hyperfine,
    "U test (compare.py)": u_test,
    "perf stat -r 10": perf_stat,
    "ten pairs by hand, t test": pairs_by_hand,
}
"""By name."""


def _direction(ratio: float) -> str:
    return SLOWER if ratio > 1 else FASTER


def _seconds(words: Words) -> float:
    began = time.monotonic()
    _run(words)
    return time.monotonic() - began


def _perf(words: Words) -> tuple[float, float]:
    """The mean and its standard error, in seconds."""
    said = _run(["perf", "stat", "-e", "task-clock", "-r", str(RUNS), *words]).stderr
    found = re.search(r"([0-9.]+)\s+\+-\s+([0-9.]+)\s+seconds time elapsed", said)
    if found is None:
        raise RuntimeError(f"perf stat: found no time elapsed in: {said}")
    return float(found[1]), float(found[2])


def _run(words: Words, fine: Sequence[int] = (0,)) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode not in fine:
        raise RuntimeError(f"{words[0]}: exit code {done.returncode}: {done.stderr.strip()}")
    return done
