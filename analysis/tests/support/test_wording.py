"""Numbers as people read them."""

import math

import pytest

from analysis.support.wording import NO_BREAK, number


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.99999999, "1.00"),
        (0.9994, "0.999"),
        (9.996, "10.0"),
        (-0.0123456, "−0.0123"),
        (1234567.8, f"1{NO_BREAK}234{NO_BREAK}568"),
        (0.0, "0"),
        (math.inf, "∞"),
        (-math.inf, "−∞"),
        (math.nan, "unknown"),
    ],
)
def test_a_number_has_three_digits_also_where_it_is_rounded_up(value: float, text: str) -> None:
    assert number(value) == text
