"""Calls spread over processes: all of them, in order, with what they raise."""

import os

import pytest

from analysis.parallel import in_parallel


@pytest.fixture(autouse=True)
def _four_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2, 3})


@pytest.mark.parametrize("count", [0, 1, 2, 9])
def test_results_come_in_order(count: int) -> None:
    offset = 5
    assert list(in_parallel(lambda number: number + offset, count)) == [n + 5 for n in range(count)]


def test_they_come_from_other_processes() -> None:
    assert os.getpid() not in in_parallel(lambda _: os.getpid(), 4)


def test_one_processor_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {3})
    assert list(in_parallel(lambda _: os.getpid(), 3)) == [os.getpid()] * 3


def test_what_is_raised_there_is_raised_here() -> None:
    def fail(number: int) -> int:
        raise OSError(28, "No space left on device", f"file {number}")

    with pytest.raises(OSError, match="No space left on device: 'file 0'") as raised:
        list(in_parallel(fail, 3))
    assert raised.value.filename == "file 0"
