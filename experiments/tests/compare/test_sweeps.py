"""Values for placeholders: the commands that come of them, and what each value changes."""

import itertools

import pytest

from experiments.compare.options import parse
from experiments.compare.sweeps import Levels, contrasts


def commands(*arguments: str) -> list[tuple[str, Levels]]:
    return [(one.line, one.levels) for one in parse(arguments).commands]


def test_each_combination_is_a_command_with_its_levels() -> None:
    assert commands("-L", "opt", "O2,O3", "-P", "n", "1", "2", "./{opt} {n}") == [
        (f"./{opt} {n}", (("opt", opt), ("n", n))) for opt in ("O2", "O3") for n in ("1", "2")
    ]


def test_a_line_that_lacks_a_list_is_there_once() -> None:
    lines = [line for line, _ in commands("-L", "n", "1,2", "./old", "./new {n}")]
    assert lines == ["./old", "./new 1", "./new 2"]


def named(*lists: tuple[str, str]) -> dict[str, Levels]:
    """A command for each combination, called by its values."""
    names = [name for name, _ in lists]
    found = itertools.product(*(values.split(",") for _, values in lists))
    return {" ".join(values): tuple(zip(names, values, strict=True)) for values in found}


def test_effects_of_two_values_each() -> None:
    opt, native, both = contrasts(named(("opt", "O2,O3"), ("march", "none,native")))
    assert opt.name == "opt O3 instead of O2"
    assert opt.weights == {"O2 none": -0.5, "O2 native": -0.5, "O3 none": 0.5, "O3 native": 0.5}
    assert native.weights == {"O2 none": -0.5, "O2 native": 0.5, "O3 none": -0.5, "O3 native": 0.5}
    assert both.name == "opt O3 instead of O2 and march native instead of none"
    assert both.weights == {"O2 none": 1.0, "O2 native": -1.0, "O3 none": -1.0, "O3 native": 1.0}


def test_effects_are_those_of_a_sum_of_logarithms() -> None:
    """Whatever each value and each pair of values adds, its contrast gives back."""
    a, b, pairs = {"1": 0.0, "2": 0.3, "3": -0.2}, {"x": 0.0, "y": 0.1}, {("3", "y"): 0.05}
    levels = named(("a", "1,2,3"), ("b", "x,y"))
    logs = {
        name: a[first] + b[second] + pairs.get((first, second), 0.0)
        for name, ((_, first), (_, second)) in levels.items()
    }
    sums = {
        one.name: sum(weight * logs[name] for name, weight in one.weights.items())
        for one in contrasts(levels)
    }
    assert sums["a 2 instead of 1"] == pytest.approx(0.3)
    assert sums["a 3 instead of 1"] == pytest.approx(-0.2 + 0.025)
    assert sums["b y instead of x"] == pytest.approx(0.1 + 0.05 / 3)
    assert sums["a 2 instead of 1 and b y instead of x"] == pytest.approx(0)
    assert sums["a 3 instead of 1 and b y instead of x"] == pytest.approx(0.05)


def test_no_effects_of_one_list_or_of_some_combinations() -> None:
    assert contrasts(named(("a", "1,2"))) == []
    some = named(("a", "1,2"), ("b", "x,y"))
    del some["1 x"]
    assert contrasts(some) == []
    assert contrasts({"old": (), "new": ()}) == []
