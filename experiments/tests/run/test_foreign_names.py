"""Files that are no programs, names of every kind, lists with other things in them: a line for each."""

import json
import os

import pytest

from experiments.run.session import run
from experiments.run.study import POINTS_FAILED, Study
from experiments.tests.conftest import SCENE, Workplace
from experiments.tests.foreign import BLOCKS, HEAD, script, series
from support.errors import InputError


def test_of_many_files_each_that_is_no_program_fails_by_itself(empty_workplace: Workplace) -> None:
    place = empty_workplace
    names = ["right", "empty", "a link", "pipe", "plain", "lost", "caf\udce9", "two\nlines", "{scene}", "dos"]
    for name in names:
        script(place, f"subs/{name}/sim", "exit 0")
    subs = place.root / "questions" / "subs"
    (subs / "empty" / "sim").write_bytes(b"")
    for name in ("a link", "pipe"):
        (subs / name / "sim").unlink()
    (subs / "a link" / "sim").symlink_to("nowhere")
    os.mkfifo(subs / "pipe" / "sim", 0o755)
    (subs / "plain" / "sim").chmod(0o644)
    (subs / "lost" / "sim").write_text("#!/no/such/python -x\n")
    (subs / "dos" / "sim").write_text("#!/bin/sh\r\nexit 0\r\n")
    lines = '[[series]]\ncommands = "subs/*/sim"\ncommand = ["{program}"]\n'
    place.question("asked", HEAD + lines + BLOCKS)
    assert run(place.settings) == POINTS_FAILED
    assert {record["tags"]["series"] for record in place.records("asked").values()} == {"right", "{scene}"}
    reasons = {one["tags"]["series"]: one["reason"] for one in place.failures()}
    absent = "which is not there; expected a program"
    no_text = "its path is no text in UTF-8 on one line; another name can be measured"
    assert reasons == {
        "empty": f"cannot be run in {place.root / 'questions'}: Exec format error",
        "a link": "is a link to nothing",
        "pipe": "is no file",
        "plain": f"{subs / 'plain' / 'sim'}: is not executable; `chmod +x` makes it so",
        "lost": f'{subs / "lost" / "sim"}: begins with #! and "/no/such/python", {absent}',
        "caf\\udce9": no_text,
        "two\\nlines": no_text,
        "dos": f'{subs / "dos" / "sim"}: begins with #! and "/bin/sh\\r", {absent}',
    }  # fmt: skip
    for one in place.failures():
        json.dumps(one, ensure_ascii=False).encode()


def test_words_that_name_no_plain_file_keep_nobody_waiting(empty_workplace: Workplace) -> None:
    place = empty_workplace
    folder = place.root / "questions"
    folder.mkdir(exist_ok=True)
    os.mkfifo(folder / "pipe")
    (folder / "link").symlink_to("nowhere")
    (folder / "inner").mkdir()
    long = "x" * 5000
    words = f'command = ["true", "pipe", "link", "inner", "/dev/zero", "{long}", "é", ""]'
    place.question("asked", HEAD + series("a", words) + BLOCKS)
    assert run(place.settings) == 0


LIST = """
filter=.*
for word; do case $word in --benchmark_filter=*) filter=${word#*=};; --benchmark_out=*) exit 0;; esac; done
echo "LD: warning $(date +%N)"; echo; echo "log: BM_a/8"
"""
NAMES = ["BM_a/8", "BM_b<int, 3>/{x}", 'BM "quoted"', "BM_ä", "BM_" + "long" * 1000]


def test_of_a_list_only_names_are_taken(empty_workplace: Workplace) -> None:
    place = empty_workplace
    (place.root / "questions").mkdir(exist_ok=True)
    (place.root / "questions" / "names").write_text("\n".join(NAMES) + "\n")
    script(place, "bench", f'cd "${{0%/*}}" {LIST} grep -E -e "$filter" names; true')
    text = '[[series]]\nbenchmark = {program = "./bench", filter = "."}\n'
    place.question("asked", HEAD + text + BLOCKS)
    [experiment] = Study(place.settings).experiments
    assert [point.series for point in experiment.points] == NAMES
    assert [point.command.benchmark for point in experiment.points if point.command] == NAMES
    place.question("asked", HEAD + text.replace('"."', '"BM_none"') + BLOCKS)
    with pytest.raises(
        InputError, match=r'filter: found "BM_none", which no case matches; it prints "LD: warn'
    ):
        Study(place.settings)


def test_of_one_that_knows_no_filter_lines_without_doubt_are_taken(empty_workplace: Workplace) -> None:
    place = empty_workplace
    script(place, "bench", "echo 'LD: warning: no /dev/x'; echo; echo BM_a/8; echo BM_b; echo other")
    place.question("asked", HEAD + '[[series]]\nbenchmark = {program = "./bench", filter = "BM_"}\n' + BLOCKS)
    [experiment] = Study(place.settings).experiments
    assert [point.series for point in experiment.points] == ["BM_a/8", "BM_b"]


def test_a_case_whose_name_is_no_text_is_refused(empty_workplace: Workplace) -> None:
    script(empty_workplace, "bench", r"printf 'BM_\351\n'")
    text = '[[series]]\nbenchmark = {program = "./bench", filter = "B"}\n'
    empty_workplace.question("asked", HEAD + text + BLOCKS)
    with pytest.raises(InputError, match="whose name is no UTF-8"):
        Study(empty_workplace.settings)


def test_braces_are_what_they_are(empty_workplace: Workplace) -> None:
    lines = 'command = ["echo", "{{scene}}", "{{out}}{scene}", "{{{x}}}"]'
    empty_workplace.question("asked", HEAD + SCENE + series("a", lines) + BLOCKS)
    assert run(empty_workplace.settings) == 0
    words = empty_workplace.contenders[0].words
    assert words[1] == "{scene}"
    assert words[2].startswith("{out}/")
    assert words[3] == "{0}"


def test_a_locale_without_letters_for_it_is_no_reason_to_fail(empty_workplace: Workplace) -> None:
    place = empty_workplace
    place.question("asked", HEAD + series("é–", 'command = ["false"]') + BLOCKS)
    place.behave(PYTHONIOENCODING="ascii")
    process = place.start("run", "--no-figures")
    output, error = process.communicate()
    assert process.returncode == POINTS_FAILED, error
    assert "\\xe9\\u2013" in output
    assert "Traceback" not in error


@pytest.mark.parametrize("name", ["caf\udce9", "two\nlines"])
def test_folders_whose_names_are_no_text_are_refused_in_a_line(empty_workplace: Workplace, name: str) -> None:
    place = empty_workplace
    place.question("asked", HEAD + series("a", 'command = ["true"]') + BLOCKS)
    (place.root / "questions").rename(place.root / name)
    for more in (("--questions", name), ("--results", name)):
        process = place.start("run", *more)
        output, error = process.communicate()
        assert process.returncode == 1, output
        assert "expected a path that is a line of text in UTF-8" in error
        assert error.count("\n") == 1
