"""The time that a program prints: what it is, and why it is none."""

import pytest

from experiments.side_by_side.printed_time import LONGEST_LINE, half_a_digit, printed_time
from support.errors import InputError


def seconds(text: str, pattern: str, unit: float | None = None) -> float:
    return printed_time([line.encode() + b"\n" for line in text.split("\n")], pattern, unit)


def said(text: str, pattern: str, unit: float | None = 1.0) -> str:
    with pytest.raises(InputError) as refused:
        seconds(text, pattern, unit)
    return str(refused.value)


UNITS = {
    "ns": 1e-9, " us": 1e-6, " \u00b5s": 1e-6, " \u03bcs": 1e-6, "\ufffds": 1e-6, "\tms": 1e-3, "s": 1,
    " sec": 1,
    " secs": 1, " second": 1, " Seconds": 1, " min": 60, " minute": 60, " minutes": 60, "h": 3600,
    " hour": 3600,
    " hours": 3600, " hr": 3600, " milliseconds": 1e-3, " microseconds": 1e-6, " nanoseconds": 1e-9,
    " msec": 1e-3, " usecs": 1e-6, "\u00a0ms": 1e-3, "\u202fms": 1e-3, "\u2009s": 1,
}  # fmt: skip


@pytest.mark.parametrize(("unit", "its_seconds"), UNITS.items())
def test_a_unit_stands_behind_the_number_or_with_it(unit: str, its_seconds: float) -> None:
    assert seconds(f"it took 2.5{unit}.", "took ([0-9.]+)", 7) == pytest.approx(2.5 * its_seconds)
    assert seconds(f"it took 2.5{unit}", "took (.*)") == pytest.approx(2.5 * its_seconds)


@pytest.mark.parametrize(
    "text", ["mean 12.51 min 10.22", "mean 12.51 min: 10", "mean 12.51 s=0.22 n=15", "mean 12.51 s 0.22"]
)
def test_the_name_of_the_next_number_is_no_unit(text: str) -> None:
    assert "'12.51', behind which " in said(text, "mean ([0-9.]+)", 1e-3)
    assert "expected a group that takes the unit" in said(text, "mean ([0-9.]+)", 1e-3)
    assert said(f"(us) {text}", "mean ([0-9.]+)", 60.0).startswith("time: found '12.51', behind which")
    taken = seconds(text, "mean ([0-9.]+ [a-z]+)", 1e-3)
    assert taken == (12.51 if " s" in text else 750.6)


RIGHT = (
    ("reading 3.5 ms\nsteps took 12.25 ms of it\ndone", "steps took ([0-9.]+) ms", 0.01225),
    ("1e-3", r"^(\S+)$", 0.001), ("took 12. Done", "took ([0-9.]+)", 12), ("1.5e-3 s", "(.*)", 0.0015),
    ("took 5 ms\r", "took (.*)$", 0.005), ("TOOK 5 ms", "(?i)took (?P<time>.*)", 0.005),
    ("time: 1.1 ms", "time: ([0-9.]+) (?:ms|s)", 1.1e-3), ("12.5 ms/step", "([0-9.]+)", 0.0125),
    ("took 5ticks", "took ([0-9]+)ticks", 5), ("took 5tk", "took ([0-9]+)tk", 5),
    ("t 5 ms", "t(.*)ms", 0.005),
    ("run 1 234 ms", " ([0-9]+) ms", 0.234),
    ("took 1 234", "took ([0-9]+) [0-9]+", 1), ("run 1 23 ms", "([0-9]+) ms", 0.023),
    ("0.5 234 ms", "([0-9]+) ms", 0.234), ("real\t0m1.234s", r"real\s+(\S+)", 1.234),
    ("real\t2m1.5s", r"real\s+([0-9m.]+)s", 121.5), ("1h2m3s", r"(\S+)", 3723), ("1h30m", r"(\S+)", 5400),
    ("took 2 minutes, 1.5 seconds", "took (.*)", 121.5), ("took 1m 2 s 300 ms", "took (.*)", 62.3),
    ("took 2s300us", "took (.*)", 2.0003), ("real 0m1,234s", "real (.*)", 1.234),
    ("t 12\u00b13 ms", "t ([0-9]+)", 0.012), ("t 1.5 +/- 0.1 us", "t (.*)", 1.5e-6),
    ("t 12(ms)", "t ([0-9]+)", 0.012), ("t 12 [us]", "t (.*)", 12e-6), ("t 12 (slow)", "t ([0-9]+)", 12),
    ("t 12 ms  345 us", "t ([0-9]+)", 0.012), ("t 12 ms 1345 us", "t ([0-9]+)", 0.012),
    ("t 12 ns/op", "t ([0-9]+)", 12e-9), ("t \x1b[32m20.12\x1b[0m \x1b[1mms", "t (.*)", 0.02012),
    ("real 0m1.2s", "m([0-9.]+)s", 1.2), ("0:01.5 s elapsed", ":([0-9.]+)", 1.5),
    ("t 1,234.5 s", "t ([0-9.,]+)", 1234.5), ("t 1.234,5 s", "t ([0-9.,]+)", 1234.5),
    ("t 1,234,567 s", "t ([0-9.,]+)", 1234567), ("t 1.234.567 s", "t ([0-9.,]+)", 1234567),
    ("t 0,15 s", "t ([0-9.,]+)", 0.15), ("t 0,150 s", "t ([0-9.,]+)", 0.15),
    ("t 12,5 s", "t ([0-9.,]+)", 12.5),
    ("t 1234,567 s", "t ([0-9.,]+)", 1234.567), ("t 1.234 s", "t ([0-9.,]+)", 1.234),
    ("took 3. Done", "took ([0-9]+)", 3), ("took 3, which is 4 s", "took ([0-9]+)", 3),
    ("took 3.5 s", r"took ([0-9]+)\.[0-9] s", 3), ("7,3.5,8", "^[0-9]+,([0-9.]+),", 3.5),
    ("2 runs: 3elapsed", ": ([0-9]+)", 3), ("run-3 ms", "([0-9]+) ms", 0.003),
)  # fmt: skip


@pytest.mark.parametrize(("text", "pattern", "expected"), RIGHT)
def test_it_is_what_stands_there(text: str, pattern: str, expected: float) -> None:
    assert seconds(text, pattern, 1) == pytest.approx(expected)


@pytest.mark.parametrize("text", ["12 steps", "12", "12 s2", "12 hélices", "12 ms_total", "12, s"])
def test_what_has_no_unit_needs_one(text: str) -> None:
    told = "time: found '12' without a unit behind it, expected one such as ms, or --unit"
    assert said(text, "([0-9]+)(?: s2)?", None) == told
    assert seconds(text, "([0-9]+)(?: s2)?", 0.5) == 6


CUT = "within a longer number in '{}', expected a pattern that takes all of it"
PARTS = (
    ("took 1 234 ms", "([0-9]+) ms"), ("took 1 234 ms", "took ([0-9]+)"), ("real 1m1.2s", "m([0-9.]+)s"),
    ("real 1m1.2s", " ([0-9]+)m"), ("real 1m1.2s", "([0-9.]+)s"), ("1h0m3s", "m([0-9]+)s"),
    ("2 minutes and 3 seconds", "([0-9]+) seconds"), ("1:02.5 elapsed", ":([0-9.]+)"),
    ("1:00:02.5 elapsed", ":([0-9.]+) "), ("took 3,5 ms", "took ([0-9.]+)"), ("took 3.25 ms", "([0-9]+) ms"),
    ("took 13.25 ms", "([0-9]+) ms"), ("took 3,25 ms", "([0-9]+) ms"), ("took -3 ms", "([0-9]+) ms"),
    ("took \u22123 ms", "([0-9]+) ms"), ("took 1'234 ms", "([0-9]+) ms"),
    ("took 1\u2019234 ms", "([0-9]+) ms"),
    ("took 1\u202f234 ms", "([0-9]+) ms"), ("took 1_234 ms", "([0-9]+) ms"), ("took .5 ms", "([0-9]+) ms"),
    ("took 1e-5 ms", "([0-9]+) ms"), ("took 3-5 ms", "([0-9]+) ms"), ("took 13.25 ms", "took.*([0-9.]+) ms"),
    ("took 3e-5", "took ([0-9]+)"), ("took 3-5", "took ([0-9]+)"), ("took 31", "took ([0-9])"),
    ("took 1:02.5 s", "took ([0-9.]+)"), ("took 2 s 300 ms", "took ([0-9.]+)"),
    ("took 2 s 300 ms", "took ([0-9.]+) s"),
    ("took 2 s 300 ms", "([0-9]+) ms"), ("took 12 ms 345 us", "took ([0-9]+)"),
    ("took 3 s, 250 ms", "took ([0-9]+)"), ("took 3 s and 250 ms", "took (.*) and"),
)  # fmt: skip


@pytest.mark.parametrize(("text", "pattern"), PARTS)
def test_it_is_never_a_part_of_a_longer_number_or_time(text: str, pattern: str) -> None:
    shown = "".join(letter if letter.isascii() else "?" for letter in text)
    assert said(text, pattern).endswith(CUT.format(shown))


POSITIVE, AMBIGUOUS = "expected a positive number", "which is ambiguous (thousands, or decimals?)"
REFUSED = (
    *((f"t {number}", "t (.*)", f"found '{number}', {POSITIVE}") for number in (
        "1'234", "1_234", "1 234", "1,23.4", "1,2,3", "1..5", "0x10", "+5", "0", "-1", "nan", "inf", "1e999",
        "1e307 h", "0m0.0s", "x",
    )),
    *((f"t {number} s", "t ([0-9.,]+)", f"found '{number}', {AMBIGUOUS}") for number in (
        "1,234", "12,345", "123,456",
    )),
    *((f"12 {unit}", "([0-9]+)", f"found '12' with the unit '{unit}', expected a time") for unit in (
        "MB/s", "GB", "B", "%", "KiB", "Hz", "ks", "m", "MS", "S", "days", "ps", "cycles",
    )),
    ("", "(.*)", f"found '', {POSITIVE}"),
    ("t 12 \u00b1 3 MB", "t ([0-9]+)", "found '12' with the unit 'MB', expected a time"),
    ("12.5 ns/day", "([0-9.]+)", "found '12.5' with '/day' behind its unit, expected a time"),
    ("12 s^-1", "([0-9]+) s", "found '12' with '^-1' behind its unit, expected a time"),
    ("12 ms\u207b\u00b9", "([0-9]+)", "found '12' with '??' behind its unit, expected a time"),
    ("t 12(MB)", "t ([0-9]+)", "found '12' with the unit 'MB', expected a time"),
    ("took 5m", "took ([0-9]+)", "found '5' with the unit 'm', expected a time"),
    ("took 5kms", "took ([0-9]+)", "found '5' with the unit 'kms', expected a time"),
    ("took 12.5 ms total", "took (.*)", "found '12.5 ms total', expected a number, and behind"),
    ("a 1", "b ([0-9]+)", "'b ([0-9]+)' matches 0 lines of standard output, expected one"),
    ("a 1" + LONGEST_LINE * "x", "a ([0-9]+)", "matches 0 lines"),
    ("a 1\na 2", "a ([0-9]+)", "matches 2 times in standard output, first 'a 1' and last 'a 2', expected"),
    ("a 1 ms, b 2 ms, c 3 ms", "([0-9]+) ms", "3 times in standard output, first '1 ms' and last '3 ms'"),
)  # fmt: skip


@pytest.mark.parametrize(("text", "pattern", "told"), REFUSED)
def test_what_is_none_is_refused_with_what_stands_there(text: str, pattern: str, told: str) -> None:
    assert said(text, pattern).startswith("time: ")
    assert told in said(text, pattern)


@pytest.mark.parametrize(
    ("text", "half"),
    [("0.1 s", 0.5), ("\x1b[1m0.1\x1b[0m s", 0.5), ("200 ms", 0.0025), ("1.5e-3 s", 1 / 30), ("0.0 s", 0)],
)
def test_half_of_the_last_digit_is_a_share_of_the_time(text: str, half: float) -> None:
    lines = [b"begun 12 s\n", f"took {text}\n".encode()]
    assert half_a_digit(lines, "^took ([^ ]+)") == pytest.approx(half)
    assert half_a_digit(lines[:1], "^took ([^ ]+)") == 0
