"""Points of a block that take turns in one process, and what keeps a process of its own."""

import os

import pytest

from experiments.plan.point import Point
from experiments.run.processes import CROWDED
from experiments.run.session import run
from experiments.run.study import POINTS_FAILED, Study
from experiments.run.together import _bytes, together
from experiments.tests.conftest import CHUNKS, ERRORS, FOUR_AND_NINE, PAIR, SCENE, Workplace
from experiments.tests.foreign import BLOCKS, HEAD
from support.errors import InputError

THREADS = f"""
title = "Threads"
figure = "scaling"
{SCENE}
[sweep]
parameter = "threads"
values = [1, 2]

{FOUR_AND_NINE}"""


WAYS = f"""
title = "Both ways"
figure = "ways"
{SCENE}
[[series]]
name = "four"
variant = "published"
apart = true

[[series]]
name = "nine"
variant = "nine"
apart = true

{FOUR_AND_NINE}"""


def groups_of(workplace: Workplace, text: str, block: int = 0) -> list[list[Point]]:
    """The groups of one block of a question, none of it measured yet."""
    workplace.question("asked", text)
    [experiment] = [one for one in Study(workplace.settings).experiments if one.name == "asked"]
    groups = together(experiment, block, list(enumerate(experiment.block(block))))
    assert sorted(at for group in groups for at, _ in group) == list(range(len(experiment.points)))
    return [[point for _, point in group] for group in groups]


def sizes(groups: list[list[Point]]) -> list[int]:
    return sorted(map(len, groups))


def test_what_is_counted_is_in_one_process_scene_by_scene(empty_workplace: Workplace) -> None:
    text = f"""
title = "Counts"
kind = "counts"
figure = "comparison"
{SCENE}
[sweep]
parameter = "seed"
values = [3, 1, 2]
{FOUR_AND_NINE}"""
    (group,) = groups_of(empty_workplace, text)
    assert len(group) == 6
    scenes = [point.scene for point in group]
    assert all(one == other for one, other in zip(scenes[::2], scenes[1::2], strict=True))
    assert len(set(scenes)) == 3


def programs(count: int, more: str = "") -> str:
    """A question that compares so many programs."""
    one = '[[series]]\nname = "p{0}"\ncommand = ["true", "{0}"]\n{1}\n'
    return HEAD + "".join(one.format(number, more) for number in range(count))


def with_key(key: str) -> str:
    return PAIR.replace("[scene]", f"{key}\n[scene]", 1)


BY_CLANG = 'variant = "published"\nprogram = "clang"'
SIZES = {
    "two variants": (PAIR, 0, [2]),
    "three chunks": (CHUNKS, 0, [3]),
    "as many threads": (THREADS, 0, [2, 2]),
    "two programs": (PAIR.replace('variant = "nine"', BY_CLANG), 0, [1, 1]),
    "processes that hold as many": (
        PAIR.replace("[blocks]", f'[[series]]\nname = "by clang"\n{BY_CLANG}\n\n[blocks]'), 0, [1, 1, 1]
    ),
    "told not to": (with_key("turns = false"), 0, [1, 1]),
    "profiles": (with_key('verb = "profile"'), 0, [1, 1]),
    "several runs each": (with_key("repetitions = 3"), 0, [1, 1]),
    "told to be apart": (WAYS, 0, [1, 1, 2]),
    "whole processes that are": (WAYS.replace("[scene]", 'verb = "process"\n[scene]'), 0, [1, 1, 2]),
    "errors besides": (ERRORS, 0, [1] * 8),
    "the block after errors": (ERRORS, 1, [4, 4]),
    "as many programs as there is memory for": (programs(8), 0, [8]),
    "one more, each by itself": (programs(9), 0, [9]),
    "one more, as somebody said": (programs(9, "turns = true"), 0, [1, 8]),
}  # fmt: skip


@pytest.mark.parametrize(("text", "block", "expected"), SIZES.values(), ids=SIZES)
def test_what_is_compared_takes_turns_unless_they_would_distort_it(
    empty_workplace: Workplace, text: str, block: int, expected: list[int]
) -> None:
    empty_workplace.build("clang", "# another one")
    groups = groups_of(empty_workplace, text, block)
    assert sizes(groups) == expected
    assert all(len({(one.threads, one.apart, one.scene_name) for one in group}) == 1 for group in groups)


def test_a_figure_of_both_ways_needs_both(empty_workplace: Workplace) -> None:
    alone = '[[series]]\nname = "nine"\nvariant = "nine"\napart = true\n'
    assert alone in WAYS
    with pytest.raises(InputError, match=r'series\[3\]: found "nine" once, expected another one with apart'):
        groups_of(empty_workplace, WAYS.replace(alone, ""))


def test_no_more_than_memory_holds_take_turns(
    empty_workplace: Workplace, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = groups_of(empty_workplace, CHUNKS)[0][0]
    monkeypatch.setattr(os, "sysconf", lambda _: (2.5 * _bytes(one) * 4) ** 0.5)
    assert sizes(groups_of(empty_workplace, CHUNKS)) == [1, 2]
    monkeypatch.setattr(os, "sysconf", lambda _: 1)
    assert sizes(groups_of(empty_workplace, CHUNKS)) == [1, 1, 1]


def test_of_more_programs_than_memory_may_have_to_hold_none_is_stopped(empty_workplace: Workplace) -> None:
    empty_workplace.question("asked", programs(9) + BLOCKS)
    assert run(empty_workplace.settings) == 0
    reasons = [one["process"]["undisturbed"] for one in empty_workplace.records("asked").values()]
    assert reasons == [CROWDED] * 18


def test_one_that_fails_its_check_does_not_take_the_others_with_it(workplace: Workplace) -> None:
    workplace.behave(FAKE_RESULT_WRONG="nine")
    assert run(workplace.settings) == POINTS_FAILED
    assert len(workplace.records("pair")) == 2
    alone = [
        call["words"]
        for call in workplace.calls()
        if call["words"][0] == "bench" and "experiment=pair" in call["words"]
    ]
    assert len(alone) == 3, "two in the first block together, and the one that is left in the second"
