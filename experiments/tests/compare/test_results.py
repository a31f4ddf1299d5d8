"""What `carom compare` makes of its measurements: tables, files, a page, and a file that it goes on with."""

import csv
import itertools
import json
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from experiments.compare.answer import Difference
from experiments.compare.texts import beside
from experiments.tests.compare.calls import (
    CAROM,
    TOOK,
    left_behind,
    needs_the_program,
    printed,
    run,
    script,
)
from experiments.tests.small_disk import run_on_small_disk

pytestmark = needs_the_program


def table_behind(words: str, said: str) -> list[str]:
    """The lines of the table, which remarks may follow."""
    rows = [line.strip() for line in said.split(words)[1].splitlines()[1:]]
    return list(itertools.takewhile(lambda row: "   " in row, rows))


def test_the_result_is_written_as_files(folder: Path) -> None:
    words = ["--export-json", "a.json", "--export-csv", "a.csv", "--export-markdown", "a.md"]
    done = run(folder, "compare", "-n", "a|b", "-n", "c", "./short", "./long", "--time", "20s", *words)
    assert done.returncode in (0, 5), done.stderr
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    assert [one["name"] for one in told["commands"]] == ["a|b", "c"]
    rows = list(csv.DictReader((folder / "a.csv").open(encoding="utf-8")))
    assert {row["command"] for row in rows} == {"a|b", "a|b again", "c"}
    seconds = [float(row["seconds"]) for row in rows if row["command"] == "c"]
    [runs] = [one for one in told["runs"] if one["command"] == "c"]
    assert seconds == runs["seconds"]
    assert "c against a\\|b" in (folder / "a.md").read_text(encoding="utf-8")


def test_products_of_lists_have_a_table_of_effects(folder: Path) -> None:
    printed(folder)
    lists = ("-L", "a", "100,200", "-L", "b", "1,3")
    done = run(folder, "compare", *lists, "./prints {a} {b}", *TOOK, "--time", "60s")
    assert done.returncode == 0, done.stderr
    told = table_behind("what each value changes", done.stdout)
    rows = [re.split(" {3,}", line) for line in told]
    more, none = "more time, by more than 2 %", "below 2 %"
    assert rows == [
        ["a 200 instead of 100", "+100.0 % [+100.0, +100.0]", more],
        ["b 3 instead of 1", "+200.0 % [+200.0, +200.0]", more],
        ["a 200 instead of 100 and b 3 instead of 1", "+0.0 % [+0.0, +0.0]", none],
    ]


def test_a_file_goes_on_with_what_is_in_it(folder: Path) -> None:
    printed(folder)
    (folder / "kept.json").touch()  # an empty one, as mktemp makes it, is one of no earlier call
    words = ("compare", "./prints 100 1", "./prints 50 1", *TOOK, "--append", "kept.json", "--time", "1ms")
    assert "1 block:" in run(folder, *words).stdout
    assert "2 blocks, 1 of them earlier" in run(folder, *words).stdout
    done = run(folder, *words[:-1], "60s")
    assert "settled after" in done.stdout
    assert "6 blocks, 2 of them earlier" in done.stdout
    assert "6 blocks, 6 of them earlier" in run(folder, *words).stdout, "all is known: nothing is measured"
    script(folder / "prints", 'echo took "$(($1 * $2))" ms # changed')
    done = run(folder, *words)
    assert "a new session begins" in done.stderr
    assert "other commands or options, or changed programs" in done.stderr
    assert "1 block:" in done.stdout
    sessions = json.loads((folder / "kept.json").read_text(encoding="utf-8"))["sessions"]
    assert [len(one["records"]) for one in sessions] == [6, 1], "one a block"


def test_a_file_does_not_go_on_with_another_library_or_layout(folder: Path) -> None:
    def build(body: str) -> None:
        line = f"echo 'int w(void) {{ {body} }}' | gcc -xc -shared -fPIC -o libw.so -"
        subprocess.run(line, shell=True, cwd=folder, check=True)

    build("return 0;")
    line = "echo 'int w(void); int main(void) { return w(); }' | gcc -xc - -L. -lw -Wl,-rpath,$PWD -o uses"
    subprocess.run(line, shell=True, cwd=folder, check=True)
    words = ("compare", "./uses", "true", "--append", "kept.json", "--time", "1ms")
    run(folder, *words)
    fixed = run(folder, *words, "--fixed-layout")
    assert "cannot go on: it was measured without --fixed-layout" in fixed.stderr
    assert "cannot go on" not in run(folder, *words, "--fixed-layout").stderr
    build("volatile int zero = 0; return zero;")
    done = run(folder, *words, "--fixed-layout")
    assert f"cannot go on: {folder}/libw.so is another library now" in done.stderr


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ('{"sessions": 1}', "is no file of an earlier call"),
        ('{"schema_version": 1, "sessions": 1}', "found schema version 1, expected 3"),
    ],
)
def test_a_file_of_something_else_is_no_earlier_call(folder: Path, content: str, told: str) -> None:
    (folder / "kept.json").write_text(content, encoding="utf-8")
    done = run(folder, "compare", "./short", "./long", "--append", "kept.json")
    assert done.returncode == 1
    assert f"--append: kept.json: {told}" in done.stderr
    assert (folder / "kept.json").read_text(encoding="utf-8") == content


def test_an_export_is_written_although_the_file_to_go_on_with_has_no_room(folder: Path) -> None:
    words = [str(CAROM), "compare", "-q", "--time", "1ms", "./short", "./long", "--export-json", "a.json"]
    line = 'TMPDIR=tmp "$@" --append full/kept.json; test $? = 1'
    said = run_on_small_disk(folder / "full", "4k", folder, f"shift; {line}", *words)
    assert "full/kept.json: No space left on device" in said
    assert json.loads((folder / "a.json").read_text(encoding="utf-8"))["blocks"] == 1


def test_a_temporary_folder_that_is_full_is_named(folder: Path) -> None:
    words = [str(CAROM), "compare", "-q", "--time", "1ms", "./short", "./long"]
    said = run_on_small_disk(folder / "full", "16k", folder, 'shift; TMPDIR=full "$@"; test $? = 1', *words)
    assert f"carom: {folder}/full: No space left on device" in said


def test_a_page_has_the_verdict_and_its_picture(folder: Path) -> None:
    printed(folder)
    words = ("./prints 100 1", "./prints 50 1", "-n", "<old>", "-n", "new", *TOOK, "--time", "60s")
    assert run(folder, "compare", *words, "--html", "a.html").returncode == 0
    page = (folder / "a.html").read_text(encoding="utf-8")
    assert "<h1>new against &lt;old&gt;: faster by more than 2 %</h1>" in page
    assert "<svg" in page
    assert not re.search(r"(href|src)=.http|url\(http|@import", page), "it asks nothing of any other place"
    assert left_behind(folder) == []


def test_what_is_counted_stands_beside_the_times(folder: Path) -> None:
    done = run(folder, "compare", "./short", "./long", "--time", "1ms", "--export-json", "a.json")
    assert "counted of each run, short → long:" in done.stdout
    assert "page faults" in done.stdout
    told = json.loads((folder / "a.json").read_text(encoding="utf-8"))
    for one in told["runs"]:
        assert len(one["counts"]["minor_page_faults"]) == told["blocks"]


def test_all_time_stands_beside_the_difference(folder: Path) -> None:
    counting = "echo x >>$0.n; n=$(wc -l <$0.n); echo took $((n % 6 ? 200 : 260)) ms"
    script(folder / "lumps", counting)
    script(folder / "steady", "echo took 100 ms")
    words = ("-n", "steady", "-n", "lumps", "./steady", "./lumps", *TOOK, "--time", "60s")
    done = run(folder, "compare", *words, "--export-json", "a.json")
    [told] = json.loads((folder / "a.json").read_text(encoding="utf-8"))["differences"]
    assert told["totals"] > told["ratio"]
    assert f"all time together: +{100 * told['totals'] - 100:.1f} %\n" in done.stdout


def test_what_blocks_and_runs_differ_by_is_said_where_it_is_known() -> None:
    one = Difference("b", 1.05, 1.04, 1.06, "slower", 6, differs=True, totals=0.99)
    assert beside(one) == "all time together: \u22121.0 %"
    told = "; one block differs from the next by 1.2 %, one run by 4.0 %"
    assert beside(replace(one, start=0.012, round=0.04)).endswith(told)


def test_three_commands_are_a_league(folder: Path) -> None:
    for name, time_taken in (("a", 100), ("b", 50), ("c", 50)):
        script(folder / name, f"echo took {time_taken} ms")
    done = run(folder, "compare", "./a", "./b", "./c", "--time", "60s", "--time-from", "took ([0-9]+) ms")
    assert "c against a   −50.0 %" in done.stdout
    places = [line.split() for line in table_behind("told apart:", done.stdout)]
    assert [place[-2:] for place in places] == [["b", "a"], ["c", "a"], ["a", "b"]]


def test_a_range_of_numbers_is_a_league(folder: Path) -> None:
    printed(folder)
    done = run(folder, "compare", "-P", "n", "1", "3", "./prints {n} 100", "--time", "60s", *TOOK)
    assert "./prints 2 100 against ./prints 1 100   +100.0 %" in done.stdout
    assert "./prints 3 100 against ./prints 1 100   +200.0 %" in done.stdout
    assert "those with a letter in common cannot be told apart" in done.stdout
