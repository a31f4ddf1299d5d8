"""What the report of a Google Benchmark, as JSON, says of one case."""

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NoReturn

from experiments.side_by_side.stated_time import StatedTime, in_quotes, on_one_line
from support.errors import InputError

Run = Mapping[str, Any]
"""A row of the report: a run of a case, or an aggregate over all of its runs."""

_NO_COUNTERS = frozenset((
    "family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads", "iterations",
    "real_time", "cpu_time",
))  # fmt: skip
_UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
_MOST_TOLD, _SHOWN = 8, 40
_OF_A_LOCALE = re.compile(
    ": *-?[0-9.]+(?:[,'\N{RIGHT SINGLE QUOTATION MARK}\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}"
    "\N{REPLACEMENT CHARACTER}]|\\.[0-9]+\\.)[0-9]"
)
"""A number as locales write it: with a comma, or with something between groups of digits."""


def benchmark_time(report: bytes, name: str) -> StatedTime:
    """The time and CPU time of an iteration of the case of that name, the mean over its repetitions, and its
    counters. Where the report has only aggregates, their mean is taken.

    Raises InputError, in one line that says what stands there, if it is no such report, has no such case or
    several (two registrations of one name among them), or the case failed, was skipped or has no positive
    time.
    """
    document = _parsed(report.decode(errors="replace"))
    full_name, case = _case_of(document["benchmarks"], name)
    runs = case.counted(full_name)
    units = [_unit_of(run, full_name) for run in runs]
    context = document["context"] if isinstance(document.get("context"), dict) else {}
    keys = dict.fromkeys(key for run in runs for key in run if _number(run, key) is not None)
    return StatedTime(
        _mean(runs, "real_time", units) or 0.0,
        _mean(runs, "cpu_time", units, missing=0.0) or 0.0,
        {key: _mean(runs, key) for key in keys if key not in _NO_COUNTERS},
        _text(context, "library_version") if "library_version" in context else None,
        _threads(runs[0]),
    )


def unlike_times(one: StatedTime, other: StatedTime) -> str:
    """Why two times of Google Benchmarks cannot be compared; empty if they can.

    Up to 1.8.5 the library divides `real_time` by the number of threads, from 1.9.1 on it does not (its pull
    request 1836). Of a case on several threads two unlike versions mean the same only where both are known to
    stand on one side.
    """
    meanings = {_is_divided(time.library_version) for time in (one, other)}
    is_alike = one.library_version == other.library_version or (len(meanings) == 1 and None not in meanings)
    if max(one.threads, other.threads) == 1 or is_alike:
        return ""
    first, second = (
        "without a version" if time.library_version is None else in_quotes(time.library_version)
        for time in (one, other)
    )
    return (
        f"Google Benchmark {first} beside {second}: of a case on several threads they do not mean the same "
        "by real_time (before 1.9 it is divided by the number of threads); build both with one version"
    )


def _is_divided(version: str | None) -> bool | None:
    """Whether `real_time` of several threads is divided by their number; None where nobody knows.

    Reports did not name a version before some 1.8. Not known is what was made between 1.8.5 and 1.9.1, and
    what was built from a source without its history, which calls itself v0.0.0.
    """
    if version is None:
        return True
    found = re.match(r"v?(\d+).(\d+).(\d+)", version, re.ASCII)
    numbers = tuple(map(int, found.groups())) if found else (0, 0, 0)
    if numbers >= (1, 9, 1):
        return False
    is_beyond = numbers == (1, 8, 5) and "-" in version
    return True if (0, 0, 0) < numbers <= (1, 8, 5) and not is_beyond else None


def _parsed(text: str) -> dict[str, Any]:
    """The library writes more than JSON has: NaN, Infinity and control characters as they come; and a counter
    that has the name of a field of the report comes behind that, so that the first of two counts.
    """
    try:
        document = json.loads(
            text, strict=False, object_pairs_hook=lambda pairs: dict(reversed(pairs)), parse_float=_finite
        )
    except json.JSONDecodeError as error:
        _refuse_report(_found_at(text, error))
    except (ValueError, RecursionError):
        _refuse_report("a number that is too large")
    if not isinstance(document, dict) or not isinstance(document.get("benchmarks"), list):
        _refuse_report("JSON without a list `benchmarks`")
    if not all(isinstance(run, dict) for run in document["benchmarks"]):
        _refuse_report("something in the list `benchmarks` that is no object")
    return document


def _finite(text: str) -> float:
    if not math.isfinite(number := float(text)):
        raise ValueError(text)
    return number


def _found_at(text: str, error: json.JSONDecodeError) -> str:
    """What stands where the parser stopped."""
    content = text.rstrip(" \t\r\n")
    begin = len(text) - len(text.lstrip(" \t\r\n"))
    if not content:
        return "nothing but blanks" if text else "an empty file"
    if text[begin] != "{":
        return f"no JSON of Google Benchmark but {_line_from(text[begin:])}"
    if error.pos >= len(content) or error.msg.startswith("Unterminated string"):
        return f"JSON that breaks off after {in_quotes(content[-_SHOWN:])}"
    around = text[max(0, error.pos - _SHOWN) : error.pos + _SHOWN]
    hint = " (numbers in the form of a locale; with LC_ALL=C in its environment they are plain)"
    locale = hint if _OF_A_LOCALE.search(around) else ""
    return f"no JSON in line {error.lineno}: {_line_from(text[error.pos :])}{locale}"


def _line_from(text: str) -> str:
    return in_quotes(re.split(r"[\r\n]", text, maxsplit=1)[0])


def _refuse_report(found: str) -> NoReturn:
    raise InputError(f"benchmark: found {found}, expected what --benchmark_out_format=json writes")


@dataclass
class _Case:
    """What of the report is about one case, or several of one name."""

    runs: list[Run] = field(default_factory=list)
    aggregates: list[Run] = field(default_factory=list)
    is_in_pieces: bool = False
    """The library reports the repetitions of a case in one piece."""

    @property
    def is_several(self) -> bool:
        """Whether several were registered with one name. Their families or instances differ (since version
        1.5.5), or else a number of a repetition, or an aggregate, comes twice.
        """
        every = [*self.runs, *self.aggregates]
        families = {
            tuple(_number(one, key) or 0.0 for key in ("family_index", "per_family_instance_index"))
            for one in every
        }
        repetitions = [one for run in self.runs if (one := _number(run, "repetition_index")) is not None]
        names = [_text(one, "aggregate_name") for one in self.aggregates]
        is_numbered = bool(repetitions) or any(_number(one, "family_index") is not None for one in every)
        return (
            self.is_in_pieces
            or len(families) > 1
            or any(len(set(one)) < len(one) for one in (repetitions, names))
            or (not is_numbered and len(self.runs) > 1)
        )

    def counted(self, name: str) -> Sequence[Run]:
        """The runs that count: all repetitions, or the mean of them where the report has only aggregates."""
        counted = self.runs or [one for one in self.aggregates if one["aggregate_name"] == "mean"]
        if not counted:
            found = ", ".join(on_one_line(one["aggregate_name"]) for one in self.aggregates)
            _refuse_case(name, f"found only aggregates ({found}), expected runs or their mean")
        for run in counted:
            _require_time(run, name)
        return counted


def _case_of(benchmarks: Sequence[Run], name: str) -> tuple[str, _Case]:
    """The one case of that name, or of one that goes on after it (BM_sort/8/real_time); its full name."""
    cases = dict(_cases_of(benchmarks, name))
    if name in cases:
        cases = {name: cases[name]}
    if len(cases) != 1:
        told = [*map(on_one_line, sorted(cases)[:_MOST_TOLD]), *["..."][: len(cases) - _MOST_TOLD]]
        found = f": {', '.join(told)}" if cases else ""
        told_name = on_one_line(name)
        raise InputError(f"benchmark: '{told_name}' is the name of {len(cases)} cases{found}; expected one")
    [(full_name, case)] = cases.items()
    if case.is_several:
        several = "is the name of several cases; expected one, each registered by a name of its own"
        raise InputError(f"benchmark: '{on_one_line(full_name)}' {several}")
    return full_name, case


def _cases_of(benchmarks: Sequence[Run], name: str) -> Iterator[tuple[str, _Case]]:
    cases: dict[str, _Case] = {}
    last = ""
    for run in benchmarks:
        own = _text(run, "run_name") or _text(run, "name")
        aggregate = _text(run, "aggregate_name") if _text(run, "run_type") == "aggregate" else ""
        # These two are over several cases.
        if aggregate not in ("BigO", "RMS") and (own == name or own.startswith(f"{name}/")):
            case = cases.setdefault(own, _Case())
            if aggregate:
                case.aggregates.append(run)
            else:
                case.is_in_pieces |= bool(case.runs) and last != own
                case.runs.append(run)
        last = own
    yield from cases.items()


def _require_time(run: Run, name: str) -> None:
    for key, how, message in (
        ("error_occurred", "failed", "error_message"), ("skipped", "was skipped", "skip_message")
    ):  # fmt: skip
        if run.get(key) is True:
            said = _text(run, "error_message") or _text(run, message)
            _refuse_case(name, f"{how}: {on_one_line(said)}" if said else f"{how} without a word")
    iterations = _number(run, "iterations")
    if iterations is not None and iterations < 1:
        _refuse_case(name, "found iterations 0, expected one at least")
    time = _number(run, "real_time")
    if time is None or not 0 < time < math.inf:
        _refuse_case(name, f"found {_shown(run, 'real_time')}, expected a positive number")


def _unit_of(run: Run, name: str) -> float:
    unit = _text(run, "time_unit") or "ns"
    if unit not in _UNITS:
        _refuse_case(name, f"found time_unit {in_quotes(unit)}, expected ns, us, ms or s")
    return _UNITS[unit]


def _mean(
    runs: Sequence[Run], key: str, units: Sequence[float] | None = None, missing: float = math.nan
) -> float | None:
    """The mean of a number over the runs; None unless each has a finite one."""
    total = 0.0
    for run, unit in zip(runs, units or [1.0] * len(runs), strict=True):
        number = _number(run, key)
        total += unit * (missing if number is None else number)
    return total / len(runs) if math.isfinite(total) else None


def _threads(run: Run) -> int:
    threads = _number(run, "threads") or 1.0
    return int(threads) if 1 < threads < 1e9 else 1


def _text(run: Run, key: str) -> str:
    value = run.get(key)
    return value if isinstance(value, str) else ""


def _number(run: Run, key: str) -> float | None:
    """A number as it is, NaN and infinity among them; None if there is no such field."""
    value = run.get(key)
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def _shown(run: Run, key: str) -> str:
    """What a field holds, to stand in a message."""
    if key not in run:
        return f"no {key}"
    value = run[key]
    is_none = isinstance(value, float) and not math.isfinite(value)
    text = json.dumps(value)
    return f"{key} {text if is_none else in_quotes(text)}"


def _refuse_case(name: str, found: str) -> NoReturn:
    raise InputError(f"benchmark: {on_one_line(name)}: {found}")
