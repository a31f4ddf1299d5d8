"""Whatever lies in a results folder is counted or named: nothing stops the reader."""

import copy
import json
import math
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from analysis.records.reading import load
from analysis.records.studies import split
from analysis.tests.fuzzing import for_a_while
from analysis.tests.synthetic import whole
from analysis.tests.synthetic_study import failures, study
from support.record_schema import definition, is_record

VALID = [whole(one) for one in (*study(["neighbourhood", "phases"], blocks=1), *failures())]

numbers = st.one_of(st.integers(), st.floats(), st.sampled_from([0, -1, 10**30, 1e308, 2**63]))
leaves = st.one_of(
    st.none(),
    st.booleans(),
    numbers,
    st.text(max_size=8),
    st.sampled_from(["bench", "profile", "failure", ""]),
)
junk = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=8), inner, max_size=3)
    ),
    max_leaves=6,
)


@st.composite
def damaged_records(draw: st.DrawFn) -> bytes:
    """A valid record in which up to three values are others or gone."""
    record = copy.deepcopy(draw(st.sampled_from(VALID)))
    for _ in range(draw(st.integers(0, 3))):
        parent: Any = record
        while parent:
            keys = list(parent) if isinstance(parent, dict) else list(range(len(parent)))
            key = draw(st.sampled_from(keys))
            if isinstance(parent[key], dict | list) and parent[key] and draw(st.integers(0, 3)):
                parent = parent[key]
                continue
            if draw(st.booleans()):
                parent[key] = draw(junk)
            else:
                del parent[key]
            break
    return json.dumps(record).encode()


@st.composite
def torn_records(draw: st.DrawFn) -> bytes:
    """A valid record with some bytes cut out and others put in."""
    content = json.dumps(draw(st.sampled_from(VALID))).encode()
    begin = draw(st.integers(0, len(content)))
    return content[:begin] + draw(st.binary(max_size=4)) + content[begin + draw(st.integers(0, 40)) :]


anything = st.one_of(damaged_records(), torn_records(), st.binary(), junk.map(json.dumps).map(str.encode))


def is_counted_or_named(content: bytes) -> None:
    with tempfile.TemporaryDirectory() as results:
        path = Path(results, "records", "neighbourhood", "any.json")
        path.parent.mkdir(parents=True)
        path.write_bytes(content)
        lines: list[str] = []
        records = load(Path(results), lines.append)
        split(records)
        assert len(lines) + len(records.runs) + len(records.failures) + len(records.limits) == 1
        for line in lines:
            assert line.startswith(f"{path}: skipped: ")
            assert "\n" not in line
            line.encode()


quick = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@given(anything)
@quick
def test_whatever_lies_there_is_counted_or_named(content: bytes) -> None:
    is_counted_or_named(content)


def is_judged_as_the_schema_says(content: bytes) -> None:
    record = json.loads(content)
    assume(finite(record))
    assert is_record(record) == definition().is_valid(record)


def finite(value: object) -> bool:
    """Whether the reader lets its numbers pass."""
    if isinstance(value, float):
        return math.isfinite(value)
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return all(map(finite, inner))


@given(st.one_of(damaged_records(), junk.map(json.dumps).map(str.encode)))
@quick
def test_the_quick_validator_says_what_the_schema_says(content: bytes) -> None:
    is_judged_as_the_schema_says(content)


@pytest.mark.fuzz
def test_the_quick_validator_says_what_the_schema_says_for_a_while() -> None:
    for_a_while(given(damaged_records())(is_judged_as_the_schema_says))


@pytest.mark.fuzz
def test_whatever_lies_there_for_a_while() -> None:
    for_a_while(given(anything)(is_counted_or_named))


def test_a_record_that_cannot_be_opened_is_named(tmp_path: Path) -> None:
    (tmp_path / "records" / "folder.json").mkdir(parents=True)
    (tmp_path / "records" / "a.json").write_text(json.dumps(VALID[0]))
    (tmp_path / "records" / "gone.json").symlink_to(tmp_path / "absent")
    (tmp_path / "records" / "round.json").symlink_to(tmp_path / "records" / "round.json")
    lines: list[str] = []
    assert len(load(tmp_path, lines.append).runs) == 1
    assert [line.split(": skipped: ")[0].rsplit("/", 1)[1] for line in lines] == [
        "folder.json", "gone.json", "round.json",
    ]  # fmt: skip
