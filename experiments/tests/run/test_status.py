"""What a plan says of the machine that it was made on."""

import os

import pytest

from experiments.run.status import others_at_work


@pytest.mark.parametrize(("load", "said"), [(0.3, ""), (0.9, ""), (2.24, "load 2.2 on 2 processors")])
def test_where_other_programs_run_a_plan_says_so(
    monkeypatch: pytest.MonkeyPatch, load: float, said: str
) -> None:
    monkeypatch.setattr(os, "getloadavg", lambda: (load, 0.0, 0.0))
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1})
    assert said in others_at_work()
    assert bool(said) == bool(others_at_work())
