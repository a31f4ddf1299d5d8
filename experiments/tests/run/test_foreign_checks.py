"""What is checked of programs of others, and what a record says of it."""

import pytest

from experiments.run.session import run
from experiments.run.study import POINTS_FAILED
from experiments.tests.conftest import SCENE, Workplace
from experiments.tests.foreign import BLOCKS, HEAD, script, series

OWN = "trajectory of its own program, steps 0 to 10"
CHECKED = {
    "its own program": ('["./sim", "/dev/null"]', '["./sim", "{out}"]', OWN),
    "another": ('["true"]', '["./sim", "{out}"]', "trajectory of another command: sim"),
    "another script": (
        '["sh", "other", "/dev/null"]', '["sh", "sim", "{out}"]', "trajectory of another command: sh sim",
    ),
    "the same script": ('["sh", "sim", "/dev/null"]', '["sh", "sim", "{out}"]', OWN),
}  # fmt: skip


@pytest.mark.parametrize(("command", "trajectory", "scope"), CHECKED.values(), ids=CHECKED.keys())
def test_a_record_says_what_was_checked(
    empty_workplace: Workplace, command: str, trajectory: str, scope: str
) -> None:
    place = empty_workplace
    for name in ("sim", "other"):
        script(place, name, 'echo right > "$1"')
    text = series("a", f"command = {command}", f"trajectory = {trajectory}") + series(
        "b", 'command = ["true", "b"]'
    )
    place.question("asked", HEAD + SCENE + text + BLOCKS)
    assert run(place.settings) == 0
    checks = {record["tags"]["series"]: record["check"] for record in place.records("asked").values()}
    assert (checks["a"]["verdict"], checks["a"]["scope"]) == ("passed", scope)
    assert (checks["b"]["verdict"], checks["b"]["scope"]) == ("unchecked", "nothing")


def test_a_trajectory_program_that_is_built_anew_is_checked_again(empty_workplace: Workplace) -> None:
    place = empty_workplace
    script(place, "with-output", 'echo right > "$1"')
    text = series("a", 'command = ["true"]', 'trajectory = ["./with-output", "{out}"]')
    place.question("asked", HEAD + SCENE + text + BLOCKS)
    assert run(place.settings) == 0
    script(place, "with-output", 'echo wrong > "$1"')
    place.question("asked", HEAD + SCENE + text + BLOCKS.replace("2", "3"))
    assert run(place.settings) == POINTS_FAILED
    assert "disc 0 is elsewhere" in place.failures()[0]["reason"]


def test_what_was_timed_can_be_checked_itself(empty_workplace: Workplace) -> None:
    place = empty_workplace
    script(place, "sim", 'echo "$2" > "$1"')
    text = "".join(series(name, f'command = ["./sim", "{{out}}", "{name}"]') for name in ("right", "wrong"))
    place.question("asked", HEAD + SCENE + text + BLOCKS)
    assert run(place.settings) == POINTS_FAILED
    records = list(place.records("asked").values())
    assert {record["tags"]["series"] for record in records} == {"right"}
    assert {record["check"]["scope"] for record in records} == {"its own output"}
    [failure] = place.failures()
    assert failure["reason"] == "check of its own output: step 1: disc 0 is elsewhere"
    checks = [call["words"] for call in place.calls() if call["words"][0] == "check"]
    assert len(checks) == 2, "once a session"


def test_one_that_leaves_no_trajectory_fails(empty_workplace: Workplace) -> None:
    place = empty_workplace
    script(place, "empty", "").write_bytes(b"")
    text = series("a", 'command = ["true", "{out}"]')
    for name, command in (("b", "true"), ("c", "./empty")):
        text += series(name, 'command = ["true"]', f'trajectory = ["{command}"]')
    place.question("asked", HEAD + SCENE + text + BLOCKS)
    assert run(place.settings) == POINTS_FAILED
    reasons = {one["tags"]["series"]: one["reason"] for one in place.failures()}
    no_program = f"check of each step: cannot be run in {place.root / 'questions'}: Exec format error"
    assert reasons.pop("c") == no_program, "no shell runs it"
    assert ["left no trajectory in" in reason for reason in reasons.values()] == [True, True]
