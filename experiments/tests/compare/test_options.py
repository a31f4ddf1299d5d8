"""What the words behind `carom compare` come to, and what is said of wrong ones."""

from pathlib import Path

import pytest

from experiments.compare.commands import words_of
from experiments.compare.options import parse
from support.errors import InputError


def names(*arguments: str) -> list[str]:
    return [one.name for one in parse(arguments).commands]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("./sim  scene.in 4", ("./sim", "scene.in", "4")),
        ("sort --parallel=2 a.txt", ("sort", "--parallel=2", "a.txt")),
        ("dd if=a of=b", ("dd", "if=a", "of=b")),
        ("awk '{print $1}' a", ("awk", "{print $1}", "a")),
        ('grep "a b" c', ("grep", "a b", "c")),
    ],
)
def test_words_in_which_a_shell_has_nothing_to_do_have_none(line: str, words: tuple[str, ...]) -> None:
    assert words_of(line) == ({}, words)


def test_variables_in_front_of_words_need_no_shell() -> None:
    assert (
        words_of("A=1 B='x y' ./sim 4") == ({"A": "1", "B": "x y"}, ("./sim", "4"))
        or not Path("sim").exists()
    )
    assert words_of("A=1 sort 4") == ({"A": "1"}, ("sort", "4"))


@pytest.mark.parametrize(
    "line",
    ["a | b", "a > b", "echo $HOME", "ls *.in", "A=1", "'a b'", "a; b", "a\nb", 'echo "$HOME"', "eval 'a'"],
)
def test_whatever_a_shell_acts_upon_has_one(line: str) -> None:
    assert words_of(line) == ({}, ("sh", "-c", line))


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


def filled(*arguments: str) -> list[tuple[object, ...]]:
    """Of each command its line, what is run before it, its variables and its name."""
    return [(one.line, one.prepare, one.environment, one.name) for one in parse(arguments).commands]


@pytest.mark.parametrize(
    ("arguments", "commands"),
    [
        (
            ["-L", "v", "a,b", "--prepare", "touch p_{v}", "ls p_{v}"],
            [("ls p_a", ("touch", "p_a"), (), "p_a"), ("ls p_b", ("touch", "p_b"), (), "p_b")],
        ),
        (
            ["-L", "v", "x,y", "--prepare", "git switch {v}", "make"],
            [
                ("make", ("git", "switch", "x"), (), "make (v x)"),
                ("make", ("git", "switch", "y"), (), "make (v y)"),
            ],
        ),
        (
            ["-L", "v", "1,2", "-n", "run {v}", "--env", "A={v}", "true"],
            [("true", (), (("A", "1"),), "run 1"), ("true", (), (("A", "2"),), "run 2")],
        ),
        (
            ["-L", "f", "--sort=none,-l", "ls {f}"],
            [("ls --sort=none", (), (), "--sort=none"), ("ls -l", (), (), "-l")],
        ),
        (
            ["-L", "v", r"a\,b,c", "echo {v}"],
            [("echo a,b", (), (), "a,b"), ("echo c", (), (), "c")],
        ),
        (
            ["-L", "v", "a,b", "awk '{print $1}' {v}"],
            [("awk '{print $1}' a", (), (), "a"), ("awk '{print $1}' b", (), (), "b")],
        ),
        (["-L", "v", "a,b", "--", "ls", "{v}"], [("ls a", (), (), "a"), ("ls b", (), (), "b")]),
    ],
)  # fmt: skip
def test_a_list_is_filled_in_wherever_it_stands(
    arguments: list[str], commands: list[tuple[object, ...]]
) -> None:
    assert filled(*arguments) == commands


@pytest.mark.parametrize(
    ("words", "values"),
    [
        (["1", "10", "4"], ["1", "5", "9"]),
        (["0.1", "0.5", "0.2"], ["0.1", "0.3", "0.5"]),
        (["-2", "-1"], ["-2", "-1"]),
        (["3", "1", "-1"], ["3", "2", "1"]),
    ],
)
def test_ranges_have_steps(words: list[str], values: list[str]) -> None:
    lines = [one.line for one in parse(["-P", "i", *words, "echo {i}"]).commands]
    assert lines == [f"echo {value}" for value in values]


def test_what_comes_once_has_the_values_of_all() -> None:
    asked = parse(["-L", "v", "a,b", "--setup", "make {v}", "--cleanup", "true", "./{v}"])
    assert (asked.setup, asked.cleanup) == (("make a", "make b"), ("true",))


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
        (["-P", "x", "a", "b", "a {x}"], "-P x: found a b, expected numbers"),
        (["-P", "x", "1"], "-P: found 2 words behind it, expected NAME FIRST LAST [STEP]"),
        (["-L", "x", "1,2", "-L", "x", "1", "a {x}"], "-L: found x twice"),
        (["-L", "v", "1,2", "a {v} {w}"], "found {w}, expected a list or range of that name: -L w A,B"),
        (["a {t}", "b"], "a {t}: found {t}, expected a list or range of that name"),
        (["--prepare", "touch {t}", "a", "b"], "--prepare: found {t}, expected a list"),
        (["--unit", "ms", "a", "b"], "--unit: found without a time that is printed"),
        (["--time-from", "took", "a", "b"], '--time-from: found "took" with 0 groups, expected one'),
        (["1", "2"], 'found "1", expected a name that is no number: -n gives it'),
        (["--env", "N={q}", "a", "b"], "--env: found {q}, expected a list or range of that name"),
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
            "-P n: found 1 99999999999, which makes 99999999999 commands; expected 100 at most",
        ),
        (["--input", "/not/there", "a", "b"], "--input: found /not/there, expected a file"),
        (["--input", ".", "a", "b"], "--input: found ., expected a file that is there, no folder"),
        (["-L", "x", "1,2,1", "a {x}"], '-L x: found "1" twice, expected values between commas'),
        (["-L", "x", "", "a {x}"], "-L x: found no value, expected values between commas"),
        (["-L", "x", "1,2", "a {y}"], "found values for x and no values for {y}, expected {x}"),
        (["--env", "c:V=1", "a", "b"], 'found "c:V=1", expected one of a, b before the colon'),
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
        ["--ignore-exit", "300"], ["--turns", "maybe"], ["--unit", "weeks"],
    ],
)  # fmt: skip
def test_a_wrong_value_is_said_in_a_line(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as leaving:
        parse([*arguments, "a", "b"])
    assert leaving.value.code == 1
    said = capsys.readouterr().err
    assert said.startswith("carom: ")
    assert said.count("\n") == 1
