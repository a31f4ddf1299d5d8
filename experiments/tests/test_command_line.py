"""The command line as a user meets it: exit codes, one line for a mistake, the lock, Ctrl-C, figures."""

import re
import signal
from pathlib import Path

import pytest

from experiments.__main__ import main
from experiments.tests.conftest import PAIR, Workplace, finish, no_child_is_left, until


def test_a_run_and_a_status_tell_how_much_and_how_long(workplace: Workplace) -> None:
    code, output, error = finish(workplace.start("run", "--no-figures"))
    assert (code, error) == (0, "")
    lines = output.splitlines()
    told = r"3 experiments, 7 points, 16 processes; 16 of them to be run: about \d+ s, then more .*"
    assert re.fullmatch(told, lines[0])
    assert re.fullmatch(r"control, block 1 of 3: 2 of 16 processes done, about \d+ s left", lines[1])
    assert lines[-1] == "the study is complete: results/records"
    assert "\x1b" not in output, "no terminal, no escape sequences"
    _, output, _ = finish(workplace.start("status"))
    assert "in the clock" in output.splitlines()[0]
    assert re.search(r"^chunks +3 +2 +6 +0 +0 +0 +[\d.]+ +\d+ %$", output, re.MULTILINE)
    assert re.search(r"^all +7 +16 +0 +0 +0 +[\d.]+ +\d+ %$", output, re.MULTILINE)


def test_status_and_plan_write_nothing(workplace: Workplace) -> None:
    code, output, error = finish(workplace.start("status"))
    assert (code, error) == (0, "")
    assert not workplace.results.exists()
    assert re.search(r"^chunks +3 +2 or more +0 +0 +6 +0 +0\.0 +-$", output, re.MULTILINE)
    code, output, error = finish(workplace.start("plan"))
    assert (code, error) == (0, "")
    assert re.search(r"^pair +2 +2 +4 +comparison +four_boxes +Pair", output, re.MULTILINE)
    assert re.search(r"16 processes; 16 of them to be run: about \d+ (s|min)", output)
    assert not workplace.results.exists()


@pytest.mark.parametrize(
    ("study", "builds"), [("threads", "gcc\n"), ("threads,compiler", "gcc clang-in-gcc\n")]
)
def test_only_what_the_questions_ask_for_is_built(
    capsys: pytest.CaptureFixture[str], study: str, builds: str
) -> None:
    assert main(["builds", "--study", study]) == 0
    assert capsys.readouterr().out == builds


def test_a_new_question_needs_a_place_for_its_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    assert main(["new", "mine", "--questions", str(tmp_path / "file" / "questions")]) == 1
    told = f"carom: questions: found {tmp_path}/file, which is no folder, expected one or a place for one\n"
    assert capsys.readouterr().err == told


def test_a_new_question_tells_a_command_that_a_shell_understands(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "my questions"
    assert main(["new", "mine", "--questions", str(folder)]) == 0
    assert f"`carom study run --questions '{folder}' --results '{folder}/results'`" in capsys.readouterr().out
    assert f"--questions '{folder}' --results '{folder}'/results\n" in (folder / "mine.toml").read_text()


MISTAKES = {
    "verb": (["walk"], r"argument VERB: invalid choice: 'walk' .*\(see `carom study --help`\)"),
    "scale": (["run", "--scale", "pape"], r'scale: found "pape", expected one of .*; did you mean "paper"\?'),
    "study": (["run", "--study", "pears"], r'study: found "pears", expected the name of a question; did .*'),
    "no study": (["run", "--study", "x"], r'study: found "x", expected names out of chunks, control, pair'),
    "site": (
        ["plan", "--site", "lokal"],
        r'site: found "lokal", expected one of example-slurm, local, a file .*; did you mean "local"\?',
    ),
    "blocks": (["run", "--blocks", "0"], r"argument --blocks: found 0, expected a whole number of at .*"),
    "budget": (["run", "--budget", "-1"], r"argument --budget: found -1, expected a number of minutes .*"),
    "results": (
        ["status", "--results", "nowhere"],
        r"results: found nowhere, expected a folder that is there",
    ),
    "no names": (["run", "--study", ","], r"argument --study: found ',', expected names between commas .*"),
    "a file above results": (
        ["builds", "--results", "questions/pair.toml/results"],
        r"results: found \S+/questions/pair\.toml, which is no folder, expected one or a place for one",
    ),
    "builds for a cluster": (
        ["builds", "--site", "example-slurm"],
        r"site example-slurm: is a cluster; use `carom study submit --site example-slurm`",
    ),
    "build": (
        ["status", "--build", "nowhere"],
        r".*nowhere/gcc/carom: is not built; build it with `make build`",
    ),
}


@pytest.mark.parametrize(("words", "line"), MISTAKES.values(), ids=MISTAKES.keys())
def test_wrong_usage_is_one_line_and_exit_code_one(workplace: Workplace, words: list[str], line: str) -> None:
    code, output, error = finish(workplace.start(*words))
    assert code == 1
    assert re.fullmatch(f"carom: {line}\n", error)
    assert output == ""
    assert not workplace.results.exists()


def test_check_reads_every_file(workplace: Workplace) -> None:
    code, output, _ = finish(workplace.start("check"))
    assert (code, output) == (0, "3 questions and 2 sites are valid\n")
    workplace.question("pair", "title = 3")
    code, _, error = finish(workplace.start("check"))
    assert code == 1
    assert error.count("\n") == 1


def test_check_sees_a_variant_that_there_is_not_where_the_program_is_built(workplace: Workplace) -> None:
    workplace.question("pair", PAIR.replace('variant = "nine"', 'variant = "nin"'))
    code, output, error = finish(workplace.start("check"))
    assert (code, output) == (1, "")
    assert re.fullmatch(
        r'.*pair\.toml: series\[2\]\.variant: found "nin", .*; did you mean "nine"\?\n', error
    )
    workplace.program.unlink()
    code, output, error = finish(workplace.start("check"))
    assert (code, error) == (0, "")
    assert "whether its variants exist could not be looked up" in output
    assert "build it with `make build`" in output


def test_two_runners_in_one_folder_are_refused(workplace: Workplace) -> None:
    workplace.behave(FAKE_SECONDS="0.3")
    first = workplace.start("run", "--no-figures")
    until(workplace.files, "no record comes", 20)
    code, _, error = finish(workplace.start("run", "--no-figures"))
    assert code == 1
    assert re.fullmatch(
        rf"carom: results: is in use by process {first.pid} on \S+; wait for it, or give --results FOLDER\n",
        error,
    )
    first.send_signal(signal.SIGTERM)
    assert finish(first)[0] == 128 + signal.SIGTERM


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_stops_cleanly(workplace: Workplace, number: signal.Signals) -> None:
    workplace.behave(FAKE_SECONDS="0.3")
    process = workplace.start("run", "--no-figures")
    until(workplace.files, "no record comes", 20)
    process.send_signal(number)
    code, _, error = finish(process)
    assert code == 128 + number
    assert error == "\nstopped: what is finished is kept; the same command goes on with the rest\n"
    no_child_is_left(workplace)
    assert not (workplace.results / ".running").exists()
    assert not workplace.failures()
    kept = workplace.records()
    assert kept
    workplace.behave(FAKE_SECONDS="0")
    assert finish(workplace.start("run", "--no-figures"))[0] == 0
    assert workplace.is_whole()
    assert kept.items() <= workplace.records().items()


NO_ROOM = "report.html: No space left on device, expected a writable place with room"


def test_the_report_comes_last_and_of_everything(needing: Workplace) -> None:
    (needing.root / "needed").write_text("{}")
    told = needing.root / "reports"
    assert (finish(needing.start("run", "--builds", "gcc"))[0], told.exists()) == (0, False), "a part follows"
    code, output, error = finish(needing.start())
    assert (code, error) == (0, "no ink\n")
    assert told.stat().st_mtime_ns > max(path.stat().st_mtime_ns for path in needing.files())
    assert output.splitlines()[-2:] == ["the study is complete: results/records", "results/report.html"]
    (needing.root / "broken").touch()
    code, _, error = finish(needing.start())
    assert (code, error.splitlines()[-1]) == (1, f"the report could not be written: {NO_ROOM}")
    assert len(needing.records()) == 16
