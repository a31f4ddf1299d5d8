"""What the report of a Google Benchmark says of one case, and why it says nothing."""

import json
from typing import Any

import pytest

from experiments.side_by_side.benchmark_time import benchmark_time, unlike_times
from experiments.side_by_side.stated_time import StatedTime
from support.errors import InputError

Row = dict[str, Any]


def report(*rows: Row | str) -> str:
    """A report of rows; a text is the further fields of a run of BM_x."""
    head = '{"name": "BM_x", "run_name": "BM_x", "run_type": "iteration", '
    texts = [f"{head}{row}}}" if isinstance(row, str) else json.dumps(row) for row in rows]
    return f'{{"benchmarks": [{", ".join(texts)}]}}'


def time_of(text: str | bytes, name: str = "BM_x") -> StatedTime:
    return benchmark_time(text if isinstance(text, bytes) else text.encode(), name)


def said(text: str | bytes, name: str = "BM_x") -> str:
    with pytest.raises(InputError) as refused:
        time_of(text, name)
    return str(refused.value).removeprefix("benchmark: ")


def repetition(number: int, time: float, family: int = 0, **more: object) -> Row:
    numbers = {"family_index": family, "repetition_index": number, "per_family_instance_index": 0}
    return {"name": "BM_x", "run_type": "iteration", "real_time": time, **numbers, **more}


def aggregate(name: str, time: float, family: int = 0) -> Row:
    names = {"name": f"BM_x_{name}", "run_name": "BM_x", "run_type": "aggregate", "aggregate_name": name}
    return {**names, "family_index": family, "iterations": 3, "real_time": time, "rate": 7.0}


def plain(name: str) -> Row:
    return {"name": name, "real_time": 1.0}


def test_it_is_that_of_the_case_in_its_unit_over_its_repetitions() -> None:
    us: Row = {"time_unit": "us", "iterations": 10}
    first = repetition(0, 2.0, cpu_time=1.0, items_per_second=5.0, **us)
    second = repetition(1, 4.0, cpu_time=3.0, items_per_second=7.0, **us)
    found = time_of(report(first, second, aggregate("mean", 99), {"name": "BM_x0", "real_time": 77.0}))
    assert [found.seconds, found.cpu_seconds] == pytest.approx([3e-6, 2e-6])
    assert (found.counters, found.threads, found.library_version) == ({"items_per_second": 6.0}, 1, None)


@pytest.mark.parametrize(("unit", "seconds"), {"ns": 2e-9, "us": 2e-6, "ms": 2e-3, "s": 2.0}.items())
def test_every_unit_is_known(unit: str, seconds: float) -> None:
    assert time_of(report(f'"real_time": 2, "time_unit": "{unit}"')).seconds == pytest.approx(seconds)


RIGHT: tuple[tuple[str | bytes, float, dict[str, float | None]], ...] = (
    (report({"name": "BM_x/8/real_time", "real_time": 2}), 2e-9, {}),
    (report(plain("BM_x/8"), plain("BM_x")), 1e-9, {}),
    (
        report('"real_time": 5, "a": NaN, "b": Infinity, "c":-Infinity, "f": 1.5, "label": "NaN, \\" NaN"'),
        5e-9, {"a": None, "b": None, "c": None, "f": 1.5},
    ),
    (
        report('"repetition_index": 0, "real_time": 1, "a": NaN, "b": 1, "c": 1',
               '"repetition_index": 1, "real_time": 3, "a": 1, "b": 2'),
        2e-9, {"a": None, "b": 1.5, "c": None},
    ),
    (
        report('"real_time": 5, "time_unit": "us", "skipped": 3, "real_time": 9, "time_unit": 2'),
        5e-6, {"skipped": 3.0},
    ),
    (report(aggregate("mean", 5), aggregate("median", 4), aggregate("stddev", 1)), 5e-9, {"rate": 7.0}),
    (report('"real_time": 1, "error_occurred": false, "skipped": false'), 1e-9, {}),
    (b'{"benchmarks": [{"name": "BM_x", "real_time": 2, "label": "\xf0\x28\x8c\x28 \xed\xa0\x80\t"}]}',
    2e-9, {}),
)  # fmt: skip


@pytest.mark.parametrize(("text", "seconds", "counters"), RIGHT)
def test_it_is_read_as_the_library_writes_it(
    text: str | bytes, seconds: float, counters: dict[str, float | None]
) -> None:
    found = time_of(text)
    assert found.seconds == pytest.approx(seconds)
    assert found.counters == counters


def test_names_are_of_any_characters() -> None:
    name = 'BM_<"a\\b">/größe/ 7'
    assert time_of(report({"name": name, "real_time": 2.0}), name).seconds == pytest.approx(2e-9)
    raw = b'{"benchmarks": [{"name": "BM_\xff\xc3\x1b\t", "real_time": 2}]}'
    assert time_of(raw, "BM_\ufffd\ufffd\x1b\t").seconds == pytest.approx(2e-9)
    assert said(raw, "BM\n") == "'BM?' is the name of 0 cases; expected one"


SEVERAL = "'BM_x' is the name of several cases; expected one, each registered by a name of its own"
EXPECTED = ", expected what --benchmark_out_format=json writes"
NO_TIME = "BM_x: found {}, expected a positive number"
REFUSED = (
    *((report(*rows), SEVERAL) for rows in (
        (repetition(0, 1, 0), repetition(0, 9, 1)), (repetition(0, 1, 0), repetition(1, 9, 1)),
        (repetition(0, 1), repetition(0, 9)), (repetition(0, 1),
        repetition(1, 9, per_family_instance_index=1)),
        (aggregate("mean", 1, 0), aggregate("mean", 9, 1)), (aggregate("mean", 1), aggregate("mean", 9)),
        (repetition(0, 1), plain("BM_y"), repetition(1, 9)), (plain("BM_x"), plain("BM_x")),
        (plain("BM_x"), plain("BM_y"), plain("BM_x")),
    )),
    *((report(fields), NO_TIME.format(found)) for fields, found in (
        ('"iterations": 5', "no real_time"), ('"real_time": NaN', "real_time NaN"),
        ('"real_time": Infinity', "real_time Infinity"), ('"real_time": 0', "real_time '0'"),
        ('"real_time": -1', "real_time '-1'"), ('"real_time": "5"', "real_time '\"5\"'"),
        ('"real_time": null', "real_time 'null'"), ('"real_time": true', "real_time 'true'"),
    )),
    (report('"iterations": 0, "real_time": 5'), "BM_x: found iterations 0, expected one at least"),
    (report('"real_time": 2, "time_unit": "h"'), "BM_x: found time_unit 'h', expected ns, us, ms or s"),
    (
        report(aggregate("median", 4), aggregate("cv", 1)),
        "BM_x: found only aggregates (median, cv), expected runs or their mean",
    ),
    (report(aggregate("BigO", 4), aggregate("RMS", 1)), "'BM_x' is the name of 0 cases; expected one"),
    (report('"error_occurred": true, "error_message": "no\\nroom", "real_time": 1'), "BM_x: failed: no?room"),
    (report('"skipped": true, "skip_message": "no GPU", "iterations": 0'), "BM_x: was skipped: no GPU"),
    (report('"skipped": true, "skip_message": "", "real_time": 0'), "BM_x: was skipped without a word"),
    (report('"error_occurred": true, "error_message": 5'), "BM_x: failed without a word"),
    (report(repetition(0, 1), repetition(1, 0, error_occurred=True)), "BM_x: failed without a word"),
    (report(), "'BM_x' is the name of 0 cases; expected one"),
    (report(plain("BM_x/1"), plain("BM_x/2")), "'BM_x' is the name of 2 cases: BM_x/1, BM_x/2; expected one"),
    (
        report(*(plain(f"BM_x/{k}") for k in range(100, 120))),
        f"'BM_x' is the name of 20 cases: {', '.join(f'BM_x/{k}' for k in range(100, 108))}, ..."
        "; expected one",
    ),
    *((text, f"found {found}{EXPECTED}") for text, found in (
        ("", "an empty file"), (" \n\t\n", "nothing but blanks"),
        ("Segmentation fault\n", "no JSON of Google Benchmark but 'Segmentation fault'"),
        ("loading\n" + report(plain("BM_x")), "no JSON of Google Benchmark but 'loading'"),
        (report(plain("BM_x")) + "\ndone\n", "no JSON in line 2: 'done'"),
        ('{"a": "b', "JSON that breaks off after '{\"a\": \"b'"), ("{}", "JSON without a list `benchmarks`"),
        ('{"benchmarks": 5}', "JSON without a list `benchmarks`"),
        ('{"benchmarks": [5]}', "something in the list `benchmarks` that is no object"),
        ('{"benchmarks": [{"real_time": 1e999}]}', "a number that is too large"),
    )),
)  # fmt: skip


@pytest.mark.parametrize(("text", "told"), REFUSED)
def test_what_is_no_time_is_refused_with_what_stands_there(text: str, told: str) -> None:
    assert said(text) == told


@pytest.mark.parametrize(
    ("number", "is_of_a_locale"),
    [
        *((one, True) for one in ("2,5", "2,000", "1,2345678901234567e+02", "1.234,5", "1.234.567", "1'234")),
        *((one, True) for one in ("1\u2019234", "1\u00a0234", "1\u202f234", "1\ufffd234")),
        *((one, False) for one in ("2 5", "x", "2.5e", "[1,2")),
    ],
)
def test_a_locale_whose_numbers_are_no_json_is_named(number: str, *, is_of_a_locale: bool) -> None:
    told = said(f'{{"context": {{"num_cpus": 4,\n"mhz_per_cpu": {number},\n"x": 1}}}}')
    hint = "' (numbers in the form of a locale; with LC_ALL=C in its environment they are plain), expected "
    assert ("no JSON in line 2: '" in told and hint in told) == is_of_a_locale


def test_it_is_said_where_a_report_breaks_off() -> None:
    text = report('"real_time": 5.25, "rate": NaN, "label": "half"')
    assert time_of(text).seconds
    for length in range(1, len(text)):
        told = said(text[:length])
        assert told.startswith(("found JSON that breaks off after '", "found no JSON in line 1: '"))
        assert told.endswith(EXPECTED)
        assert "\n" not in told


@pytest.mark.parametrize(
    ("context", "more", "version", "threads"),
    [
        ('{"library_version": "v1.8.3"}', ', "threads": 4', "v1.8.3", 4), ("{}", "", None, 1),
        ("[]", "", None, 1), ('{"library_version": ""}', "", "", 1),
    ],
)  # fmt: skip
def test_threads_and_version_are_told(context: str, more: str, version: str | None, threads: int) -> None:
    found = time_of(f'{{"context": {context}, "benchmarks": [{{"name": "BM_x", "real_time": 5{more}}}]}}')
    assert (found.library_version, found.threads) == (version, threads)


UNKNOWN = ("", "v0.0.0", "main", "v1.9.0", "v1.9.0-12-gabcdef0", "v1.8.5-30-gabcdef0", "v1.9")


@pytest.mark.parametrize(
    ("one", "other", "threads", "are_unlike"),
    [
        ("v1.8.3", "v1.9.1", 4, True), (None, "v1.9.5", 2, True), ("v1.9.4", "v1.7.1", 2, True),
        ("v2.0.0", "v1.8.5", 2, True), ("v1.8.3", "v1.9.1", 1, False), ("v1.8.3", "v1.7.1", 4, False),
        ("v1.8.3", None, 4, False), ("v1.9.1", "v1.9.4-2-gabcdef0", 4, False), ("v1.9.1", "1.10.0", 4, False),
        *((one, other, 2, True) for one in UNKNOWN for other in ("v1.9.1", "v1.8.3")),
        *((one, one, 2, False) for one in UNKNOWN),
    ],
)  # fmt: skip
def test_times_of_versions_that_mean_other_things_are_unlike(
    one: str | None, other: str | None, threads: int, *, are_unlike: bool
) -> None:
    told = unlike_times(
        StatedTime(1, library_version=one), StatedTime(1, library_version=other, threads=threads)
    )
    assert bool(told) == are_unlike


def test_why_they_are_unlike() -> None:
    told = unlike_times(
        StatedTime(1, library_version="v1.8.3", threads=4), StatedTime(1, library_version="v1.9.1", threads=4)
    )
    assert told == (
        "Google Benchmark 'v1.8.3' beside 'v1.9.1': of a case on several threads they do not mean the same "
        "by real_time (before 1.9 it is divided by the number of threads); build both with one version"
    )
