"""What the words behind `carom compare` come to, and what is said of wrong ones."""

from pathlib import Path

import pytest

from experiments.compare.commands import words_of
from experiments.compare.options import parse
from experiments.compare.values import unit_of
from support.errors import InputError


def names(*arguments: str) -> list[str]:
    return [one.name for one in parse(arguments).commands]


def test_plain_words_have_no_shell() -> None:
    assert words_of("./sim  scene.in 4") == ("./sim", "scene.in", "4")


@pytest.mark.parametrize(
    "line", ["a | b", "a > b", "echo $HOME", "ls *.in", "A=1 ./sim", "'a b'", "a; b", "a\nb"]
)
def test_whatever_a_shell_acts_upon_has_one(line: str) -> None:
    assert words_of(line) == ("sh", "-c", line)


def test_an_option_with_a_value_is_a_plain_word() -> None:
    assert words_of("sort --parallel=2 a.txt") == ("sort", "--parallel=2", "a.txt")


def test_commands_are_called_by_what_differs() -> None:
    assert names("./sim-old scene.in 4", "./sim-new scene.in 4") == ["sim-old", "sim-new"]


def test_paths_are_called_by_their_last_parts() -> None:
    assert names("/a/b/old/sim x", "/a/b/new/sim x") == ["old/sim", "new/sim"]


def test_what_would_be_a_number_is_called_by_its_line() -> None:
    assert names("./sim 4", "./sim 8") == ["./sim 4", "./sim 8"]


def test_lines_with_a_shell_are_called_by_their_lines() -> None:
    assert names("a | b", "a | c") == ["a | b", "a | c"]


def test_words_behind_two_dashes_are_taken_as_they_are() -> None:
    first, second = parse(["-n", "old", "-n", "new", "--", "./a", "x y", "--vs", "./b", "$HOME"]).commands
    assert (first.name, first.words) == ("old", ("./a", "x y"))
    assert (second.name, second.words) == ("new", ("./b", "$HOME"))


def test_the_first_is_the_reference() -> None:
    assert parse(["a", "b"]).reference == "a"
    assert parse(["--reference", "b", "a", "b"]).reference == "b"


def test_shares_and_times_have_units() -> None:
    asked = parse(["--margin", "0.5%", "--error", "0.01", "--time", "2min", "a", "b"])
    assert (asked.margin, asked.error, asked.seconds, asked.most_seconds) == (0.005, 0.01, 120, 600)


def test_lists_make_a_command_of_each_combination() -> None:
    lines = [one.line for one in parse(["-L", "opt", "O2,O3", "-P", "n", "1", "2", "./a-{opt} {n}"]).commands]
    assert lines == ["./a-O2 1", "./a-O2 2", "./a-O3 1", "./a-O3 2"]


def test_a_variable_is_of_all_or_of_one() -> None:
    first, second = parse(["--env", "A=1", "--env", "b:B=x=y", "a", "b"]).commands
    assert (first.environment, second.environment) == ((("A", "1"),), (("A", "1"), ("B", "x=y")))


def test_one_line_is_prepared_for_all_or_one_for_each() -> None:
    first, second = parse(["--prepare", "rm x", "a", "b"]).commands
    assert first.prepare == second.prepare == ("rm", "x")
    first, second = parse(["--prepare", "rm x", "--prepare", "rm y", "a", "b"]).commands
    assert (first.prepare, second.prepare) == (("rm", "x"), ("rm", "y"))


def test_input_is_opened_by_a_shell_that_becomes_the_command(tmp_path: Path) -> None:
    file = tmp_path / "a b"
    file.touch()
    words = parse(["--input", str(file), "a x", "b"]).commands[0].words
    assert words[:2] == ("sh", "-c")
    assert f"< '{file}'" in words[2]
    assert words[3:] == ("sh", "a", "x")


@pytest.mark.parametrize(
    ("pattern", "unit"),
    [("took ([0-9.]+) ms", "ms"), ("took ([0-9.]+)s", "s"), (r"([0-9.]+)\s*us", "us"), ("([0-9]+)", "s")],
)
def test_the_unit_stands_behind_the_group(pattern: str, unit: str) -> None:
    assert unit_of(pattern) == unit


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["a"], "found 1 command, expected two or more"),
        ([], "found 0 commands, expected two or more"),
        (["-n", "x", "a", "b"], "found 1 names for 2 commands"),
        (["a", "a"], 'found "a" twice'),
        (["-n", "7", "-n", "8", "a", "b"], "expected a name that is no number"),
        (["--reference", "c", "a", "b"], '--reference: found "c", expected one of a, b'),
        (["a", " "], "found an empty line"),
        (["a", "--", "b"], "found commands as lines and as words behind --"),
        (["--", "a", "--vs"], "found --vs with no word of a command"),
        (["-L", "x", "1,2", "a", "b"], "found values for x, expected {x} in a command"),
        (["-P", "x", "2", "1", "a {x}"], "expected numbers that rise"),
        (["-P", "x", "a", "b", "a {x}"], "expected a name and two whole numbers"),
        (["--env", "1=2", "a", "b"], "expected VARIABLE=VALUE"),
        (["--prepare", "x", "--prepare", "y", "a", "b", "c"], "--prepare: found 2 for 3 commands"),
        (["-n", "a", "-n", "a again", "x", "y"], 'found "a again", which the control is called'),
        (
            ["--turns", "on", "--time-from", "took (.*)", "a", "b"],
            "--turns: found turns, of commands that time",
        ),
        (["--turns", "5ms", "--time-from", "took (.*)", "a", "b"], "--turns: found turns, of commands that"),
        (
            ["-P", "n", "1", "99999999999", "a {n}"],
            "found 101 commands, expected two or more to compare, 100",
        ),
        (["--input", "/not/there", "a", "b"], "--input: found /not/there, expected a file"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(arguments: list[str], told: str) -> None:
    with pytest.raises(InputError) as error:
        parse(arguments)
    assert told in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--margin", "60%"], ["--margin", "x"], ["--time", "0s"], ["--time", "1d"], ["--warmup", "-1"],
        ["--threads", "0"],
        ["--ignore-exit", "300"], ["--time-from", "took"], ["--time-from", "(a)(b)"], ["--turns", "maybe"],
    ],
)  # fmt: skip
def test_a_wrong_value_is_said_in_a_line(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as leaving:
        parse([*arguments, "a", "b"])
    assert leaving.value.code == 1
    said = capsys.readouterr().err
    assert said.startswith("carom: ")
    assert said.count("\n") == 1
