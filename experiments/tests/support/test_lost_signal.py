"""A signal whose exception Python has ignored is heard before the next block."""

import contextlib

import pytest

from experiments.support import interrupts
from support.errors import Interrupted


def test_a_signal_that_nobody_heard_is_raised_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(interrupts, "_asked", [])
    interrupts.stop_if_asked()
    with contextlib.suppress(Interrupted):
        interrupts._interrupt(15, None)
    with pytest.raises(Interrupted) as stopped:
        interrupts.stop_if_asked()
    assert stopped.value.signal_number == 15
