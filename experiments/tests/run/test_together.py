"""Points of a block that take turns in one process, and what keeps a process of its own."""

import os
from collections.abc import Callable

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


def test_what_a_question_compares_takes_turns(empty_workplace: Workplace) -> None:
    assert sizes(groups_of(empty_workplace, PAIR)) == [2]
    assert sizes(groups_of(empty_workplace, CHUNKS)) == [3]


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


def test_only_as_many_threads_take_turns(empty_workplace: Workplace) -> None:
    groups = groups_of(empty_workplace, THREADS)
    assert sizes(groups) == [2, 2]
    assert all(len({point.threads for point in group}) == 1 for group in groups)


def test_two_programs_cannot_be_in_one_process(empty_workplace: Workplace) -> None:
    empty_workplace.build("clang", "# another one")
    text = PAIR.replace('variant = "nine"', 'variant = "published"\nprogram = "clang"')
    assert sizes(groups_of(empty_workplace, text)) == [1, 1]


def test_processes_that_are_compared_hold_as_many(empty_workplace: Workplace) -> None:
    empty_workplace.build("clang", "# another one")
    third = '[[series]]\nname = "by clang"\nvariant = "published"\nprogram = "clang"\n\n[blocks]'
    assert sizes(groups_of(empty_workplace, PAIR.replace("[blocks]", third))) == [1, 1, 1]


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("[scene]", "turns = false\n[scene]", 1),
        lambda text: text.replace("[scene]", 'verb = "profile"\n[scene]', 1),
        lambda text: text.replace("[scene]", "repetitions = 3\n[scene]", 1),
    ],
    ids=["told so", "profiles", "several runs each"],
)
def test_what_turns_would_distort_is_measured_alone(
    empty_workplace: Workplace, change: Callable[[str], str]
) -> None:
    assert sizes(groups_of(empty_workplace, change(PAIR))) == [1, 1]


def test_what_is_to_be_apart_is_and_the_others_still_take_turns(empty_workplace: Workplace) -> None:
    groups = groups_of(empty_workplace, WAYS)
    assert sizes(groups) == [1, 1, 2]
    assert all(point.apart == (len(group) == 1) for group in groups for point in group)


def test_of_whole_processes_too(empty_workplace: Workplace) -> None:
    text = WAYS.replace("[scene]", 'verb = "process"\n[scene]')
    assert sizes(groups_of(empty_workplace, text)) == [1, 1, 2]


def test_a_figure_of_both_ways_needs_both(empty_workplace: Workplace) -> None:
    alone = '[[series]]\nname = "nine"\nvariant = "nine"\napart = true\n'
    assert alone in WAYS
    with pytest.raises(InputError, match=r'series\[3\]: found "nine" once, expected another one with apart'):
        groups_of(empty_workplace, WAYS.replace(alone, ""))


def test_a_block_that_measures_errors_besides_is_measured_alone(empty_workplace: Workplace) -> None:
    assert sizes(groups_of(empty_workplace, ERRORS, block=0)) == [1] * 8
    assert sizes(groups_of(empty_workplace, ERRORS, block=1)) == [4, 4], "one for each scene"


def test_no_more_than_memory_holds_take_turns(
    empty_workplace: Workplace, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = groups_of(empty_workplace, CHUNKS)[0][0]
    monkeypatch.setattr(os, "sysconf", lambda _: (2.5 * _bytes(one) * 4) ** 0.5)
    assert sizes(groups_of(empty_workplace, CHUNKS)) == [1, 2]
    monkeypatch.setattr(os, "sysconf", lambda _: 1)
    assert sizes(groups_of(empty_workplace, CHUNKS)) == [1, 1, 1]


def programs(count: int, more: str = "") -> str:
    """A question that compares so many programs."""
    one = '[[series]]\nname = "p{0}"\ncommand = ["true", "{0}"]\n{1}\n'
    return HEAD + "".join(one.format(number, more) for number in range(count))


def test_of_more_programs_than_memory_may_have_to_hold_none_is_stopped(empty_workplace: Workplace) -> None:
    assert sizes(groups_of(empty_workplace, programs(8))) == [8]
    assert sizes(groups_of(empty_workplace, programs(9))) == [9], "one after the other"
    assert sizes(groups_of(empty_workplace, programs(9, "turns = true"))) == [1, 8], "as somebody said"
    empty_workplace.question("asked", programs(9) + BLOCKS)
    assert run(empty_workplace.settings) == 0
    reasons = [one["process"]["undisturbed"] for one in empty_workplace.records("asked").values()]
    assert reasons == [CROWDED] * 18


def test_each_of_a_group_has_its_record(workplace: Workplace) -> None:
    assert run(workplace.settings) == 0

    def processes() -> int:
        return sum(call["words"][0] == "turns" and "--seed" in call["words"] for call in workplace.calls())

    assert processes() == 3 + 2 + 2, "one process a block"
    assert len(workplace.records()) == 16
    assert run(workplace.settings) == 0
    assert processes() == 7, "nothing is measured twice"


def test_where_one_of_a_group_crashes_each_is_measured_alone(workplace: Workplace) -> None:
    workplace.behave(FAKE_BENCH_CRASHES="nine")
    assert run(workplace.settings) == POINTS_FAILED
    assert [one["reason"] for one in workplace.failures()] == ["killed by SIGABRT: out of memory"]
    assert {one["axes"]["variant"] for one in workplace.records("pair").values()} == {"published"}
    assert len(workplace.records("pair")) == 2


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
